"""Recordings of several trials gathered into one case."""
