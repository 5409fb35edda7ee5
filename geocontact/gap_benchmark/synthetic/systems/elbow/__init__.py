"""The elbow exoskeleton of synthetic cases."""
