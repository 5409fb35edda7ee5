"""A recording of several movements cut into them."""
