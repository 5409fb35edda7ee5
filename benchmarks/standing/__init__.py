"""Standing up with a leg exoskeleton."""
