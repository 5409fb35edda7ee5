"""Pressure-mat frames put on a body surface."""
