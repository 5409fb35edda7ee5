"""Both sides of a contact met by one law at once: their curves laid end to end on one clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.data.tilted_areas import TiltedAreas
from geocontact.elastic_modulus.area_force import AreaForce

PAUSE = 3.0  # durations between one side's end and the next one's start: a residual forgets in less


def end_to_end(
    models: Sequence[AreaForce], measured: Sequence[Float[np.ndarray, " n"]]
) -> tuple[AreaForce, Float[np.ndarray, " m"]]:
    """One model, and its forces, of sides that share motion, reading, lag and threshold; one after another.

    The sides' residuals are taken for independent of each other: a pause parts them.
    """
    parts = [m.evolution for m in models]
    first = models[0]
    span = float(parts[0].time[-1] - parts[0].time[0])
    shifts = [k * (1.0 + PAUSE) * span for k in range(len(models))]
    tilts = [each.tilts for each in parts]
    flexions = [each.flexion for each in parts]
    evolution = replace(
        parts[0],
        time=np.concatenate([each.time + shift for each, shift in zip(parts, shifts, strict=True)]),
        area=np.concatenate([each.area for each in parts]),
        radius=np.concatenate([each.radius for each in parts]),
        tilts=_tilts([each for each in tilts if each is not None], len(parts)),
        flexion=None if any(f is None for f in flexions) else np.concatenate([f for f in flexions if f is not None]),
    )
    frames = np.concatenate([m.frames + shift for m, shift in zip(models, shifts, strict=True)])
    return replace(first, evolution=evolution, frames=frames), np.concatenate(measured)


def _tilts(known: Sequence[TiltedAreas], count: int) -> TiltedAreas | None:
    if len(known) < count:
        return None
    return TiltedAreas(known[0].offsets, np.concatenate([each.area for each in known]))
