"""The prosthetic leg: segments, bodies and joints, equations of one stance."""
