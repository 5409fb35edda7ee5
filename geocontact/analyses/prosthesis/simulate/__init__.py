"""A stance of the prosthetic side along a recorded walk."""
