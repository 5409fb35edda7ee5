"""The elbow exoskeleton."""
