"""Effects of the vocabulary, each in an equation of its own: one effect, one file."""
