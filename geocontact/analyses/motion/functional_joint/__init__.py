"""Centre or axis of a joint from the markers of two segments that move against each other."""
