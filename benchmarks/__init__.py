"""Measured speed, memory and accuracy, rerunnable: `python -m benchmarks.area.peers`, `python -m
benchmarks.area.accuracy`."""
