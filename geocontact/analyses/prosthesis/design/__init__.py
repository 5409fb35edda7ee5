"""Which fulcrum, alignment or stiffness of a prosthetic foot suits a person."""
