"""Numbers of a prosthetic foot's sole from a recorded stance."""
