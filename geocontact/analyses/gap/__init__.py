"""Jobs around the gap between a model and a measurement."""
