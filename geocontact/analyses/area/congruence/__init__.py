"""Congruence of the two surfaces where they are in contact."""
