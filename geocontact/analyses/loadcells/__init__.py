"""Contact forces from the load cells of an instrumented implant."""
