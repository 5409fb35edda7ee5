"""Loads of a mat beside the forces of a model."""
