"""Keel of a prosthetic foot, identified from static compressions."""
