"""Synthetic walking trials of persons who were not there."""
