"""How thick an elastic layer is, as an option. Light to import."""

from __future__ import annotations

from typing import Annotated, Literal

from geocontact.analyses.options import Typed
from geocontact.data.plausible import LAYER

BodyPair = Annotated[tuple[str, str], Typed("-", "body_pair", '("femur_r", "tibia_r")')]
"""Names in an OpenSim model of MOVING's body and FIXED's."""

RAYS = "rays"
"""Said of a thickness that is measured along the normal."""

Thickness = Annotated[float | Literal["rays"], Typed("m", "thickness", "gc.mm(8)"), LAYER]
