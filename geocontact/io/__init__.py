"""Files in, files out: everything inside is in SI units, whatever the file was written in."""
