"""Contact equilibrium: where a loaded body comes to rest on an elastic foundation."""
