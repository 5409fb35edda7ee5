"""Force laws: what a depth, a rate or an area is worth in newtons."""
