"""What things are: meshes, motion, results and the errors that name a file, a place and a remedy."""
