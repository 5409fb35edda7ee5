"""Markers of a model along a motion."""
