"""Effects of sensors, filters and clocks."""
