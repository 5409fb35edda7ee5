"""What a law of deflection may have beside its spring: one term, one file; numbers in, numbers out, memory explicit."""
