"""Where a mat lies: on the scan by landmarks or a second scan, and on a body model that the scan is registered to."""
