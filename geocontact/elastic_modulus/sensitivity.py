"""What a modulus of elasticity depends on besides the force: reading, threshold, numbers that are free beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from geocontact.contact.area_hertz import READINGS
from geocontact.elastic_modulus.area_force import MODULUS, THRESHOLD, AreaForce
from geocontact.elastic_modulus.identify import STRONGEST, WEAKEST, Identification, agreement

FLAT = 1e-6  # of a force by the law; one that varies less does not vary


@dataclass(frozen=True)
class SensitivityRow:
    """E* [Pa] of one side, reading and threshold [m], all else equal; infinite where the reading sees no contact."""

    side: str
    reading: str
    threshold: float
    modulus: float
    rmse: float
    r2: float


def sensitivity(sides: Mapping[str, Identification]) -> list[SensitivityRow]:
    """E* of each side by every reading, at every threshold that was evaluated and at the one used, all else equal.

    The reading "strip" is left out where no length is known. Adhesion counts in the reading that it was identified in.
    """
    return [row for side, each in sides.items() for row in _rows(side, each)]


def _rows(side: str, each: Identification) -> list[SensitivityRow]:
    used = each.fit.values.get(THRESHOLD, each.model.threshold)
    levels = sorted({*map(float, each.model.evolution.thresholds), used})
    rows = []
    for reading in READINGS:
        if reading.name == "strip" and not np.isfinite(each.model.evolution.length):
            continue
        sticks = each.model.adhesion if reading.name == each.model.reading.name else None
        for level in levels:
            model = replace(each.model, reading=reading, threshold=level, adhesion=sticks)
            rows.append(_row(side, model, each, level))
    return rows


def _row(side: str, model: AreaForce, each: Identification, level: float) -> SensitivityRow:
    held = {name: value for name, value in each.fit.values.items() if name not in (MODULUS, THRESHOLD)}
    if not model.per_modulus(held).any():
        return SensitivityRow(side, model.reading.name, level, np.inf, np.nan, np.nan)
    modulus = float(model.refit(each.measured[None, :], held, (WEAKEST, STRONGEST))[0, 0])
    rmse, r2 = agreement(each.measured, model.force({**held, MODULUS: modulus}))
    return SensitivityRow(side, model.reading.name, level, modulus, rmse, r2)


def confounded(each: Identification) -> list[str]:
    """Free numbers that change nothing, or nothing that E* does not change alike."""
    groups = {name: each.told_apart.get(f"E*, {name}") for name in each.fit.names if name != MODULUS}
    return [name for name, group in groups.items() if group is None or group.verdict == "one number"]


def constant(each: Identification) -> bool:
    """Whether the force by the law is the same in every frame, as of a constant area."""
    return bool(np.ptp(each.predicted) <= FLAT * each.predicted.max())
