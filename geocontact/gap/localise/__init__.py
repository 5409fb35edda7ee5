"""Where the gap lies: in which channel, phase, frequency, place."""
