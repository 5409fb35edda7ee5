"""Commands of `geocontact sit-to-stand`."""
