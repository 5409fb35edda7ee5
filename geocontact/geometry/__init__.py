"""Shapes and how far apart they are; no forces here."""
