"""The knee implant: areas, modulus, equilibrium, and its chain in the diagnosis."""
