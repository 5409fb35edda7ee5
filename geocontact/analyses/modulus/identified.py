"""Everything that an identification finds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geocontact.analyses.modulus.figure import ForcePair
from geocontact.analyses.modulus.prediction import Prediction
from geocontact.analyses.modulus.read import BOTH, HALVES
from geocontact.analyses.modulus.sensitivity import SensitivityRow
from geocontact.elastic_modulus.area_force import MODULUS, SLOPE
from geocontact.elastic_modulus.identify import Identification
from geocontact.elastic_modulus.threshold_calibration import Calibration

ONE_NUMBER = "E and nu are one number here: area and force tell E* = E/(1 - nu^2) only, and E for a stated nu"
RADIUS = "E* and a constant R are one number as well, E*/R: the radius is an input, not a result"
RADII = "of R the forces tell only how it changes with flexion (slope): its size at 0 degrees is one number with E*"
FLAT = 1e-6  # of a force by the law; one that varies less does not vary


@dataclass(frozen=True, eq=False)
class Identified:
    """What was found, by side; the first side is the headline.

    Parameters
    ----------
    sides
        "total", "medial", "lateral", as far as areas and forces have them, or "both" halves met at once.
    sensitivity
        E* by every reading at every threshold.
    calibration
        The threshold that measured areas ask for, where they were given.
    predictions
        Of a trial that was not used.
    poisson
        Ratios that E is told for.
    """

    sides: dict[str, Identification]
    sensitivity: list[SensitivityRow]
    calibration: Calibration | None
    predictions: list[Prediction]
    poisson: tuple[float, ...]

    @property
    def first(self) -> Identification:
        """The side of the headline."""
        return next(iter(self.sides.values()))

    def frames_once(self, side: str) -> int:
        """Frames of the motion that were used; both halves have the same."""
        return len(self.sides[side].model.frames) // (len(HALVES) if side == BOTH else 1)

    def curves(self) -> dict[str, ForcePair]:
        """Measured and predicted force by side; both halves, where they were met at once, each for itself."""
        shown = {}
        for side, each in self.sides.items():
            count = self.frames_once(side)
            time = each.model.frames[:count]
            for k, name in enumerate(HALVES if side == BOTH else (side,)):
                part = slice(k * count, (k + 1) * count)
                shown[name] = ForcePair(time, each.measured[part], each.predicted[part])
        return shown

    def not_identifiable(self) -> list[str]:
        """What the data cannot tell; (E*, R) depends on the reading, the free numbers on the data."""
        each = self.first
        lines = [f"E* and {name} are one number here: {name} is not identifiable" for name in confounded(each)]
        if each.told_apart["E*, R"].verdict != "one number":
            return [ONE_NUMBER, *lines]
        return [ONE_NUMBER, RADIUS, *([RADII] if SLOPE in each.fit.names else []), *lines]


def confounded(each: Identification) -> list[str]:
    """Free numbers that change nothing, or nothing that E* does not change alike."""
    groups = {name: each.told_apart.get(f"E*, {name}") for name in each.fit.names if name != MODULUS}
    return [name for name, group in groups.items() if group is None or group.verdict == "one number"]


def constant(each: Identification) -> bool:
    """Whether the force by the law is the same in every frame, as of a constant area."""
    return bool(np.ptp(each.predicted) <= FLAT * each.predicted.max())
