"""Models of the user: in Python, or any program."""
