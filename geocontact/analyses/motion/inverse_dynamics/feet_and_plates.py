"""Whether each load acts on the body that its centre of pressure is under."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from geocontact.analyses.motion.skeleton import upwards
from geocontact.analyses.run_record import Record
from geocontact.data.multibody.model import Multibody
from geocontact.data.wrench import Wrench

LOADED = 50.0  # N, from which a centre of pressure is exact to centimetres


def warn_of_other_feet(
    record: Record, model: Multibody, values: Float[np.ndarray, "t c"], loads: Mapping[str, Wrench]
) -> None:
    """A reservation where a load passes nearer another loaded body than its own, in most of the frames.

    Plates that are exchanged leave no residual at the ground: the sum of all loads is the same.
    """
    up, poses = upwards(model), model.poses(values)
    for body, load in loads.items():
        centre = load.centre_of_pressure(np.zeros(3), up, LOADED)
        away = {name: _across(poses[name].translation - centre, up) for name in loads if name in poses}
        there = np.isfinite(centre).all(axis=1)
        if body not in away or not there.any():
            continue
        typical = {name: float(np.median(distance[there])) for name, distance in away.items()}
        nearest = min(typical, key=lambda name: typical[name])
        if nearest != body:
            record.warn(
                f"the load on {body} acts {typical[body]:.2f} m from it and {typical[nearest]:.2f} m from {nearest} "
                "(median over its frames): are the loads of the two exchanged?"
            )


def _across(offset: Float[np.ndarray, "t 3"], up: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " t"]:
    return np.asarray(np.linalg.norm(offset - (offset @ up)[:, None] * up, axis=1))
