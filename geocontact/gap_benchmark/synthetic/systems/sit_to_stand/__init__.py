"""The sit-to-stand exoskeleton of synthetic cases."""
