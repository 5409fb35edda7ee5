"""Misalignment of an exoskeleton and a joint: law, identification, design, population (elbow paper)."""
