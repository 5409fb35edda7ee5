"""The human arm: what its shoulder has to do to hold, move and push."""
