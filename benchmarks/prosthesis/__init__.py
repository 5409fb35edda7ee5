"""The below-knee prosthesis."""
