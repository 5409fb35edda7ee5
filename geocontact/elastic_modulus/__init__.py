"""Elastic modulus of a contact from its area and its force (knee-implant paper)."""
