"""The shoulder exoskeleton of synthetic cases."""
