"""Error of poses or markers carried into the contact area."""
