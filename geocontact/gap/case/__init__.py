"""A case made ready: what is admitted, the problem that is solved, its refit and its whitening."""
