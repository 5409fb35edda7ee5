"""Constraint forces of an exoskeleton whose axis is not the axis of the joint."""
