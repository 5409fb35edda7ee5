"""What the trials can and cannot tell apart, and from which size."""
