"""Coordinates of the planar chain from the motion of a whole body, and a study made of them."""
