"""Contact laws, pressure mats, and the foot on spheres."""
