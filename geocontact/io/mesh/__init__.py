"""Mesh files: STL, PLY, OBJ, OFF, VTP."""
