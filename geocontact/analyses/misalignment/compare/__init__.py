"""An identified law or a simulation beside recordings."""
