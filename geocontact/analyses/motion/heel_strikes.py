"""When a foot comes to the ground: as typed, as the force plates show it, as a .c3d file marks it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.quantities import number
from geocontact.analyses.motion.sides import LEFT, RIGHT, stem_and_side
from geocontact.data.errors import InputError
from geocontact.data.wrench import Wrench
from geocontact.identify.signals.cycles import strides
from geocontact.io.mocap.c3d_events import read_c3d_strikes

Strikes = dict[str, Float[np.ndarray, " k"]]
"""Times [s], increasing, by side: "right", "left"."""

ONSET = 20.0
"""N at which a foot is on the ground; gait laboratories use 10 to 30 N."""
EXAMPLE = "right=0.63,1.86"


def strikes_typed(texts: tuple[str, ...]) -> Strikes:
    """`right=0.63,1.86`, a text for each side."""
    found: Strikes = {}
    for text in texts:
        side, equals, times = text.partition("=")
        side = side.strip().lower()
        if not equals or side not in (RIGHT, LEFT) or side in found:
            raise InputError(
                "", "`events`", f"'{text}' is not a side and its times", f"write {EXAMPLE}, each side once"
            )
        found[side] = np.array([number(part, "`events`", EXAMPLE) for part in times.split(",")])
        if len(found[side]) < 2 or not (np.diff(found[side]) > 0.0).all():
            raise InputError("", "`events`", f"'{text}' are not two or more increasing times", f"write {EXAMPLE}")
    return found


def strikes_marked(file: Path) -> Strikes:
    """Those that a .c3d file holds; none in other files."""
    return read_c3d_strikes(file) if file.suffix.lower() == ".c3d" else {}


def strikes_on_plates(
    time: Float[np.ndarray, " t"], loads: Mapping[str, Wrench], up: Float[np.ndarray, " 3"]
) -> Strikes:
    """Where the load of the bodies of one side sets in; a foot that stands on a plate at the start has no strike."""
    pressing: dict[str, Float[np.ndarray, " t"]] = {}
    for body, wrench in loads.items():
        side = stem_and_side(body)[1]
        if side:
            pressing[side] = pressing.get(side, np.zeros(len(time))) + wrench.force @ up
    return {side: _onsets(time, load) for side, load in pressing.items()}


def _onsets(time: Float[np.ndarray, " t"], load: Float[np.ndarray, " t"]) -> Float[np.ndarray, " k"]:
    """Onsets where there are two or more, the ends of strides; else none."""
    spans = strides(time, load, ONSET)
    return np.array([*(span.start for span in spans), *(span.end for span in spans[-1:])])
