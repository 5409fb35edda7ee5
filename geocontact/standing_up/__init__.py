"""Standing up from a chair: a planar leg chain on spheres, and what recordings say about the spheres."""
