"""Tables of measurements and of earlier results."""
