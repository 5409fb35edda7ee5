"""A known effect put into measured trials, and whether the diagnosis finds it."""
