"""Curves and maps of a diagnosis."""
