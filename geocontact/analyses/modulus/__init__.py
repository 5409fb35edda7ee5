"""Elastic modulus from contact areas and measured forces."""
