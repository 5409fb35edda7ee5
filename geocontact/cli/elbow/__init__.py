"""Commands of `geocontact elbow`."""
