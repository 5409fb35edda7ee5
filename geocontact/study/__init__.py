"""Studies: one analysis of many subjects, trials, conditions and settings, on one machine or a cluster."""
