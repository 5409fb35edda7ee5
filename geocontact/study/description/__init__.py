"""What a study says of itself: analysis, options, trials, what is compared."""
