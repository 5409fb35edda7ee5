"""Folders of gap cases, read and written."""
