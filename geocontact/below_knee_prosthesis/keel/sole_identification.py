"""EI and stiffness of a sole from static compressions on its spheres (`compression.calibrated_on_sole`).

Its interval is from the standard deviation of each stiffness and of each fulcrum that was sought.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.special import ndtri

from geocontact.below_knee_prosthesis.keel.compression import Compressed, calibrated_on_sole, pressed_sole
from geocontact.below_knee_prosthesis.keel.foam import foam_numbers
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.identification import (
    IdentifiedKeel,
    IdentifiedNumber,
    MeasuredCompression,
    by_logarithm,
)
from geocontact.below_knee_prosthesis.keel.sole import KeelSole, zone_number
from geocontact.identify.noise.autocorrelation import spread
from geocontact.loads.sphere_set import SoleLaw


@dataclass(frozen=True, eq=False)
class IdentifiedSole:
    """The foot whose sole, compressed by a tilted plate, is nearest to measured stiffnesses.

    Parameters
    ----------
    foot
        With EI and the stiffness of the foremost zone that were identified.
    numbers
        EI and that stiffness.
    stiffnesses
        Of each compression on the sole [N/m].
    deviations
        Standard deviations of the measured ones, with those of fulcrums that were sought [N/m].
    """

    foot: VariableStiffnessFoot
    zone: str
    numbers: tuple[IdentifiedNumber, ...]
    stiffnesses: tuple[float, ...]
    deviations: tuple[float, ...]


def _pressed(sole: KeelSole, law: SoleLaw, zone: str) -> tuple[str, str, float]:
    """Name, unit and value of what is identified of the sole: stiffness of a sphere, or modulus of the foam."""
    if sole.foam is not None:
        return f"modulus of the foam, {zone}", "Pa", foam_numbers(sole, law)[zone].modulus
    return f"stiffness of a sphere, {zone}", "N/m", zone_number(law, "stiffness", sole.spheres.zones[zone])


STEP = 1e-4
"""Step of logarithms for derivatives; a fulcrum is moved by the same share of the keel's length."""


def identified_sole(
    foot: VariableStiffnessFoot,
    beam: IdentifiedKeel,
    measured: Sequence[MeasuredCompression],
    *,
    tilt: float,
    travel: float,
    level: float = 0.95,
) -> IdentifiedSole:
    """EI and the stiffness of the foremost zone with which the sole has the measured stiffnesses.

    ArithmeticError where the keel finds no equilibrium.
    """
    zone = foot.sole.spheres.zone[int(np.argmax(foot.sole.spheres.centre[:, 0]))]
    slopes = [one.slope() for one in measured]
    wanted = [Compressed(at, stiffness) for at, (stiffness, _) in zip(beam.fulcrums, slopes, strict=True)]
    keel, law = calibrated_on_sole(beam.keel, foot.sole, foot.law, wanted, travel=travel, tilt=tilt, zone=zone)
    of = foot.sole.spheres.zones[zone]

    def logarithms(bent: float, pressed: float, shift: float) -> Float[np.ndarray, " n"]:
        changed = replace(keel, bending=keel.bending * np.exp(bent))
        stiffer = replace(law, stiffness=np.where(of, np.exp(pressed) * law.stiffness, law.stiffness))
        low, high = keel.range
        places = [float(np.clip(each + shift, low, high)) for each in beam.fulcrums]
        forces = [pressed_sole(changed, at, foot.sole, stiffer, np.array([travel]), tilt=tilt)[0] for at in places]
        return np.log(np.array(forces) / travel)

    here = logarithms(0.0, 0.0, 0.0)
    slope = np.column_stack([logarithms(STEP, 0.0, 0.0) - here, logarithms(0.0, STEP, 0.0) - here]) / STEP
    moved = STEP * keel.length
    by_place = (logarithms(0.0, 0.0, moved) - logarithms(0.0, 0.0, -moved)) / (2.0 * moved)
    sd = np.array([error / stiffness for stiffness, error in slopes])
    variance = sd**2 + (by_place * np.array(beam.fulcrum_sd)) ** 2
    bread = spread(slope)
    covariance = bread @ (slope.T * variance) @ slope @ bread
    half = np.sqrt(np.diag(covariance)) * float(ndtri(0.5 + 0.5 * level))
    numbers = (
        by_logarithm("EI, plate on the sole", "N m^2", float(keel.bending), float(half[0])),
        by_logarithm(*_pressed(foot.sole, law, zone), float(half[1])),
    )
    keel = replace(keel, bending=float(keel.bending), torsional=float(keel.torsional))
    deviations = np.sqrt(variance) * [stiffness for stiffness, _ in slopes]
    return IdentifiedSole(
        replace(foot, keel=keel, law=law), zone, numbers, tuple(map(float, np.exp(here))), tuple(map(float, deviations))
    )
