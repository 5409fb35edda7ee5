"""Effects of sensors, filters and clocks in synthetic cases."""
