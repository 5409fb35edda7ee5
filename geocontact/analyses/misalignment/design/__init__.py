"""Offsets and strokes of a compensation joint that keep the force under a limit."""
