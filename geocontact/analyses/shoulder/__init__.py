"""Shoulder exoskeleton that a recorded arm moves."""
