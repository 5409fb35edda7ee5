"""Commands of `geocontact gap`."""
