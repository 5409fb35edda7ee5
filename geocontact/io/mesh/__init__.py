"""Mesh files: STL, PLY, OBJ, VTP."""
