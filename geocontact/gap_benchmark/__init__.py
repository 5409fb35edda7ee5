"""Labelled synthetic cases, and what a diagnosis of them scores."""
