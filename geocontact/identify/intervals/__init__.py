"""Intervals and tests that hold when residuals are correlated in time."""
