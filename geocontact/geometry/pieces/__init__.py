"""Several closed surfaces in one mesh: how many, which lie inside others, and the surface of their union."""
