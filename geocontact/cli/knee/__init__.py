"""Commands of `geocontact knee`."""
