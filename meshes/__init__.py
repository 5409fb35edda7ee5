"""Synthetic samples, surfaces, recordings and trials, and the scripts that make them (`python meshes/make.py`)."""
