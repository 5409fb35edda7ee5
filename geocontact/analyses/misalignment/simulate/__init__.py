"""Synthetic recordings, or ideal forces along recorded angles."""
