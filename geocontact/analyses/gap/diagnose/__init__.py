"""Diagnosis of one case or of several."""
