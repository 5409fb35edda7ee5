"""Publication figures: arrays in SI units in, axes in the field's units, vector files out."""
