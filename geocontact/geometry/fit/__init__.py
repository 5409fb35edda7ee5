"""Shapes that fit points best, by distance and robustly: cylinder, sphere, plane, circle; and how well."""
