"""Trials of standing up that were not used, predicted with calibrated contacts."""
