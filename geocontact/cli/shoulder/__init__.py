"""Commands of `geocontact shoulder`."""
