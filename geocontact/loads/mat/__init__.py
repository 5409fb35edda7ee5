"""Loads of pressure mats."""
