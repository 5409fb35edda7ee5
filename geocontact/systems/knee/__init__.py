"""Base models of a knee implant: lumped, posed, and from pose over meshes to load cells."""
