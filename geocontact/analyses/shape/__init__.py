"""Cylinder, sphere or plane fitted to a surface."""
