"""Base model of a shoulder exoskeleton that a recorded arm moves."""
