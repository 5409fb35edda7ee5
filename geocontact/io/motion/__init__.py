"""Motion files turned into poses of one body in the frame of another."""
