"""Recordings made ready: cycles, even times, filters, bins of angle."""
