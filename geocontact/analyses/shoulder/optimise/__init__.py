"""Support profiles of a shoulder exoskeleton."""
