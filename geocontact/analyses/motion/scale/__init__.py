"""A generic model scaled to one person."""
