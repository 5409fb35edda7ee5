"""Pelvis and both legs: the prosthetic one as in `model`, the intact one down to its toes."""
