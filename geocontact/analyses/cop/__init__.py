"""Centre of pressure of a foot that stands on spheres."""
