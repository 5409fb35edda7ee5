"""The strap, its place and the help of an exoskeleton, chosen so that the strap presses least."""
