"""Text files: tables, columns, units, TOML."""
