"""Stiffness, link and offsets identified from force and angle."""
