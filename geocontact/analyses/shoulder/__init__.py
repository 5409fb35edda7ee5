"""A shoulder exoskeleton driven by human motion: `gc.shoulder.simulate(...)` and more."""

from __future__ import annotations

from geocontact.analyses.catalogue import make_room

make_room(__name__)
