"""How far outcomes of a foot's map are from forward dynamics.

The map is quasi-static and bears the recorded load. Along the same turns of pelvis, hip and knee a simulated foot has
inertia and dampers: that is the map's own error, on the present foot, and every draw has it. On another foot than the
present one the load differs as well, since the pelvis is free: that grows with the logarithm of the keel's stiffness
over that of the present one. Bands of outcomes have both. What is best is sought with the recorded load, as the
responses of a person say, and has the first. Both were measured (`benchmarks/prosthesis_forward.py`); of the rate of
loading and of another alignment they were not.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.knob import AIMS, Knob
from geocontact.below_knee_prosthesis.design.outcomes import Aim
from geocontact.below_knee_prosthesis.keel.beam import tip_compliance
from geocontact.below_knee_prosthesis.keel.keel import Keel


@dataclass(frozen=True)
class MapError:
    """Standard deviations of the logarithm of an outcome by the map over that by forward dynamics.

    Parameters
    ----------
    here
        On the present foot, by aim.
    away
        What the load of a keel that is e times as stiff adds, by aim; in proportion to the logarithm of the stiffness.
    """

    here: Mapping[Aim, float]
    away: Mapping[Aim, float]

    def factors(
        self, stiffness: Float[np.ndarray, " n"], rng: np.random.Generator
    ) -> tuple[Float[np.ndarray, " aims"], Float[np.ndarray, "n aims"]]:
        """A draw: of the map itself, and of the load at values with those logarithms of stiffness over the present one.

        Each is one error for all values.
        """
        here, away = (np.array([of.get(aim, 0.0) for aim in AIMS]) for of in (self.here, self.away))
        one, other = rng.standard_normal((2, len(AIMS)))
        return np.exp(here * one), np.exp(stiffness[:, None] * away * other)


MEASURED = MapError(
    here={"ankle_moment": 0.017, "socket_moment": 0.18, "energy": 0.028, "radius": 0.025},
    away={"ankle_moment": 0.058, "socket_moment": 0.355, "energy": 0.126, "radius": 0.084},
)
"""Root mean squares of nine present feet, three persons at three settings, and of sixteen others they walk on.

The socket's peak is that of a foot that slaps down, whose dampers shift the load forwards: the map has none.
"""
NONE = MapError({}, {})


def stiffer(knob: Knob, keel: Keel) -> Float[np.ndarray, " n"]:
    """Logarithm of the stiffness at the keel's tip of each value over that of the present one."""
    if knob.vary == "stiffness":
        return np.log(knob.settings / knob.present)
    if knob.vary == "alignment":
        return np.zeros(len(knob.settings))
    soft = np.array([_compliance(keel, float(fulcrum)) for fulcrum in (knob.present, *knob.settings)])
    return np.asarray(np.log(soft[0] / soft[1:]))


def _compliance(keel: Keel, fulcrum: float) -> float:
    return float(tip_compliance(fulcrum, keel.length, keel.bending, keel.support))
