"""A below-knee prosthesis with a variable-stiffness foot: `gc.prosthesis.simulate(...)` and more."""

from __future__ import annotations

from geocontact.analyses.catalogue import make_room

make_room(__name__)
