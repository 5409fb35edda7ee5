"""Public recordings of other devices, with models of their own."""
