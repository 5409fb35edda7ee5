"""Contact area of two surfaces: how it is counted, bounded and followed over a motion."""
