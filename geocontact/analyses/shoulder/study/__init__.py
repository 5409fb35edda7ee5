"""Many trials of a shoulder exoskeleton, with the motion recorded in it and with that recorded without it."""
