"""Commands of `geocontact prosthesis`."""
