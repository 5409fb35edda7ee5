"""Measured inputs: their filter, their noise, their resolution, and what the outputs owe to them."""
