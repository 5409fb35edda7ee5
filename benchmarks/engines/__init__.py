"""One module per engine; each offers `engines()`, the ways of using it that are measured.

A module imports its library only when an engine is prepared, so that a library that is missing costs one row.
"""
