"""Where a scan, a mat or a body lies in the frame of another: by landmarks, then by shape."""
