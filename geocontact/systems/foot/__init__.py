"""Base model of a prosthetic foot on spheres."""
