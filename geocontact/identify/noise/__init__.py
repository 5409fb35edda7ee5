"""Models of noise: spectra, covariances, and the search for their levels."""
