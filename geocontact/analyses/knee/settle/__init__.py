"""Contact equilibrium of a knee implant."""
