"""Pressures of the contact area analysis."""
