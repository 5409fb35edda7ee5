"""Joint coordinates from markers."""
