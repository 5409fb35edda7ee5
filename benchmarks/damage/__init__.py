"""Files that are damaged at random, and what becomes of them in the readers."""
