"""Contact of several pairs of bodies that move together."""
