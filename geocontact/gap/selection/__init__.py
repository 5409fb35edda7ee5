"""Which candidate explains the gap: evidence, comparison, verdict."""
