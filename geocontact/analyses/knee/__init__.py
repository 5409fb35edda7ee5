"""A knee implant under load: `gc.knee.settle(...)`."""

from __future__ import annotations

from geocontact.analyses.catalogue import make_room

make_room(__name__)
