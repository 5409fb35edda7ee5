"""Every command run on shipped and made samples in two checkouts, and every number compared."""
