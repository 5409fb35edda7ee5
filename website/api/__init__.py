"""Reference of the functions, made from their docstrings: one page for each public name."""
