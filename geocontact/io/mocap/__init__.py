"""Files of motion laboratories: markers and force plates."""
