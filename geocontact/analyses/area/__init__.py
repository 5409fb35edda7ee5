"""Contact area, and pressure, of two bodies over a motion."""
