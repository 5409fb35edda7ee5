"""Joint moments from motion and external loads."""
