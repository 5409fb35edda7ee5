"""Checks of a recorded trial against itself: what two of its inputs say of the same thing."""
