"""Many stances of a prosthetic foot beside their plates."""
