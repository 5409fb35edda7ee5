"""Mistakes in the data: found, corrected, or hidden by base parameters."""
