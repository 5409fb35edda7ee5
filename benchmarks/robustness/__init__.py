"""Damaged files, machines where something is wrong, and the first result."""
