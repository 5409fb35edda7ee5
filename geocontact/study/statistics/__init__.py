"""Differences, agreement and reliability over subjects: arrays in, numbers out."""
