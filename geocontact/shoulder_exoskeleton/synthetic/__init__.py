"""Synthetic participants and trials of overhead work, after the design of the exoskeleton's study."""
