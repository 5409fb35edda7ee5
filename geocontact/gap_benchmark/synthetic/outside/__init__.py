"""Effects that no row of the vocabulary describes."""
