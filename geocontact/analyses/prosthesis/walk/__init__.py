"""Both legs of a person with a below-knee prosthesis in motion."""
