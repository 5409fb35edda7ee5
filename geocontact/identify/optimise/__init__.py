"""Searches for parameters, one method a file."""
