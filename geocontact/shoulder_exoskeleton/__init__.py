"""Shoulder exoskeleton with passive joints that a recorded arm moves through its cuff."""
