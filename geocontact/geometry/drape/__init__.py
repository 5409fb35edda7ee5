"""A mat laid onto a surface: along geodesics with its pitch kept, or straight down by nearest points."""
