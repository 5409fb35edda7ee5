"""Help of an exoskeleton in standing up: what it does to the strap, and how it is chosen."""
