"""Which effects the trials of a case can tell apart."""
