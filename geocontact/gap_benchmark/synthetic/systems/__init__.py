"""Systems whose trials are synthesised."""
