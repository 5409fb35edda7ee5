"""Synthetic sample surfaces, a synthetic gait cycle and the scripts that make them (`python meshes/make.py`)."""
