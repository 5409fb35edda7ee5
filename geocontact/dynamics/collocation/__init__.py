"""Direct collocation: motions, controls and parameters as one sparse problem, and what its answer is worth."""
