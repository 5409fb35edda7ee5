"""Simulated stances of a study beside their plates, and beside predictors without a model."""
