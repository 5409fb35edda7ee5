"""Where a model misses the measurement, which effect it lacks, how far the gap shrinks with it."""
