"""Base models of the source systems, each a chain of replaceable links."""
