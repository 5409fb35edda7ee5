"""Constraint forces of an exoskeleton whose axis is not the joint's: `gc.misalignment.identify(...)` and four more."""

from __future__ import annotations

from geocontact.analyses.catalogue import make_room

make_room(__name__)
