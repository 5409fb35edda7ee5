"""Measured speed, memory and accuracy, rerunnable: `python -m benchmarks.peers`, `python -m benchmarks.accuracy`."""
