"""Discrete mistakes in the data: exchanged channels, turned signs, wrong units."""
