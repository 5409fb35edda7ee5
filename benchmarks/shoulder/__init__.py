"""The shoulder exoskeleton."""
