"""The prosthetic foot of synthetic cases."""
