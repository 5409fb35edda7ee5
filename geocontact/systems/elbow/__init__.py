"""Base model of an elbow exoskeleton."""
