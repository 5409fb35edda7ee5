"""An exoskeleton's arms along recorded human ones."""
