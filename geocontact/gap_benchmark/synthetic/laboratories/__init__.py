"""Kinds of laboratories: what each draws of its own for a case, whatever the system."""
