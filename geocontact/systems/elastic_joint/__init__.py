"""Base model of an elastic joint."""
