"""Base model of an exoskeleton strapped to pelvis, thigh and shank."""
