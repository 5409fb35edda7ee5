"""Predicted trials of standing up beside what was recorded, and beside predictors without a model."""
