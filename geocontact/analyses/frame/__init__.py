"""The frame of all analyses: options, job, record, result, and what writes results."""
