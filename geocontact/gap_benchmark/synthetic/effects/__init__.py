"""Injected effects by stage, each in an equation of its own."""
