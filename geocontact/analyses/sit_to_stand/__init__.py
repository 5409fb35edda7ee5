"""Standing up from a chair: `gc.sit_to_stand.calibrate(...)` and more."""

from __future__ import annotations

from geocontact.analyses.catalogue import make_room

make_room(__name__)
