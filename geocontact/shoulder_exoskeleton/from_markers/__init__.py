"""Upper arms in the device's frame, from markers."""
