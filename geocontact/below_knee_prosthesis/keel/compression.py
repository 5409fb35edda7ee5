"""Static compression of the forefoot: simulated, and bending stiffness identified from a measured one.

1/K(l) = C(l) EI / EI + 1/k is linear in the unknowns 1/EI and 1/k, so that two settings give both, and a third one of
known stiffness its fulcrum. With three stiffnesses and one fulcrum unknown nothing remains to test the theory, and
how the posterior end is held is not identified either: that choice moves EI by 5 %, the series stiffness by 20 %.

The study of the variable-stiffness foot fits its model to such tests without saying where the plate presses, how it is
tilted and how far it goes. Here it is tilted by 20 degrees, toes first, as the forefoot plate of ISO 10328, and
travels 5 mm along y. Without friction and damping.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import cos, radians, sin

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq, least_squares
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.keel import Keel, compression_stiffness, tip_compliance
from geocontact.below_knee_prosthesis.keel.quasi_static import QuasiStaticKeel
from geocontact.below_knee_prosthesis.keel.sections import SHARE, Support
from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.geometry.shapes import HalfSpace
from geocontact.identify.identifiability import Identifiability, identifiability
from geocontact.loads.sphere_set import SoleLaw, SphereSet


@dataclass(frozen=True)
class Compressed:
    """A static compression: fulcrum [m] and the stiffness that was measured there [N/m]."""

    fulcrum: float
    stiffness: float


@dataclass(frozen=True)
class CompressionFit:
    """What two compressions say.

    Parameters
    ----------
    length
        Of the keel [m].
    support
        How its posterior end is held, which was assumed.
    bending
        EI [N m²].
    series
        Stiffness of all that gives besides the keel [N/m]; infinite where nothing does.
    """

    length: float
    support: Support
    bending: float
    series: float

    def stiffness(self, fulcrum: float) -> float:
        """Stiffness of a compression [N/m]."""
        return compression_stiffness(fulcrum, self.length, self.bending, self.series, self.support)

    def fulcrum(self, stiffness: float, lowest: float, highest: float) -> float:
        """Where a stiffness [N/m] is reached [m]; ValueError where it is not within the range."""
        if not self.stiffness(lowest) <= stiffness <= self.stiffness(highest):
            raise ValueError(f"{stiffness:g} N/m is not reached between {lowest:g} and {highest:g} m")
        return float(brentq(lambda at: self.stiffness(at) - stiffness, lowest, highest, xtol=1e-12))


def fitted(low: Compressed, high: Compressed, length: float, support: Support) -> CompressionFit:
    """EI and series stiffness from two settings; ValueError where beam theory cannot span them."""
    unit = [tip_compliance(each.fulcrum, length, 1.0, support) for each in (low, high)]
    measured = [1.0 / each.stiffness for each in (low, high)]
    softness = (measured[0] - measured[1]) / (unit[0] - unit[1])
    rest = measured[1] - softness * unit[1]
    if not softness > 0.0 or rest < 0.0:
        raise ValueError(
            f"stiffnesses {low.stiffness:g} and {high.stiffness:g} N/m differ by more than a beam with a {support} end "
            f"does between {low.fulcrum:g} and {high.fulcrum:g} m, or not at all"
        )
    return CompressionFit(length, support, 1.0 / softness, 1.0 / rest if rest > 0.0 else np.inf)


def rounded(low: Compressed, high: Compressed, length: float, support: Support, half: float) -> list[CompressionFit]:
    """Fits to the four corners of stiffnesses that were rounded, by up to `half` [N/m] each."""
    return [
        fitted(
            Compressed(low.fulcrum, low.stiffness + a), Compressed(high.fulcrum, high.stiffness + b), length, support
        )
        for a, b in product((-half, half), repeat=2)
    ]


def told_apart(
    fulcrums: Float[np.ndarray, " n"], fit: CompressionFit, *, share: bool, place: bool = False
) -> Identifiability:
    """What compressions at some fulcrums tell apart: EI and series stiffness, and on demand more.

    Parameters
    ----------
    share
        Also how the posterior end is held: turn at the fulcrum over M l/EI, 1/3 pinned to 1/4 clamped.
    place
        Also where the plate presses, as a length L of the beam.

    Derivatives of the logarithm of the stiffness by those of the unknowns, so that errors are equal shares.
    ValueError for fewer fulcrums than unknowns.
    """
    names = ["bending", "series", *(["share"] if share else []), *(["place"] if place else [])]
    start = np.log([fit.bending, fit.series, SHARE[fit.support], fit.length])
    if len(fulcrums) < len(names):
        raise ValueError(f"{len(fulcrums)} compressions cannot separate {len(names)} numbers")
    chosen = [0, 1, *([2] if share else []), *([3] if place else [])]

    def logarithms(values: Float[np.ndarray, " four"]) -> Float[np.ndarray, " n"]:
        bending, series, part, length = np.exp(values)
        overhang = length - fulcrums
        compliance = (overhang**2 * part * fulcrums + overhang**3 / 3.0) / bending + 1.0 / series
        return np.asarray(-np.log(compliance))

    step = 1e-5
    columns = [(logarithms(start + step * e) - logarithms(start - step * e)) / (2.0 * step) for e in np.eye(4)[chosen]]
    return identifiability(names, np.stack(columns, axis=1))


TILT, TRAVEL = radians(20.0), 5e-3
WEIGHTLESS = (0.0, 0.0, 0.0)
FOREFOOT = "forefoot"


def pressed_tip(keel: Keel, fulcrum: float, series: float, travel: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """Force [N] of a level plate on the tip through a spring of `series` [N/m], along its travel [m]."""
    tip = SphereSet(np.array([[keel.length, 0.0, 0.0]]), np.array([1e-9]), ("tip",))
    law = SoleLaw(np.array([series]), np.zeros(1), 1.0, 1.0, np.zeros(1), np.zeros(1), 1.0)
    return _pressed(QuasiStaticKeel(keel, fulcrum, KeelSole(tip, (keel.joints,)), law), travel, 0.0)


def pressed_sole(
    keel: Keel, fulcrum: float, sole: KeelSole, law: SoleLaw, travel: Float[np.ndarray, " t"], *, tilt: float = TILT
) -> Float[np.ndarray, " t"]:
    """Force along y [N] of a plate on the sole, tilted by `tilt` [rad], along its travel [m] from first touch."""
    return _pressed(QuasiStaticKeel(keel, fulcrum, sole, law), travel, tilt)


def calibrated_on_sole(
    keel: Keel,
    sole: KeelSole,
    law: SoleLaw,
    measured: Sequence[Compressed],
    *,
    travel: float = TRAVEL,
    tilt: float = TILT,
    zone: str = FOREFOOT,
) -> tuple[Keel, SoleLaw]:
    """The same with EI and the stiffness of a zone such that compressions of the sole are nearest to measured ones.

    Least squares of relative errors; two compressions are met. The stiffness is the force over the whole travel. GJ
    keeps its ratio to EI.
    """
    forefoot = sole.spheres.zones[zone]

    def with_factors(logarithms: Float[np.ndarray, " two"]) -> tuple[Keel, SoleLaw]:
        bent, pressed = np.exp(logarithms)
        stiffer = np.where(forefoot, pressed * law.stiffness, law.stiffness)
        changed = replace(keel, bending=bent * keel.bending, torsional=bent * keel.torsional)
        return changed, replace(law, stiffness=stiffer)

    def off(logarithms: Float[np.ndarray, " two"]) -> list[float]:
        bent, pressed = with_factors(logarithms)
        forces = [
            pressed_sole(bent, each.fulcrum, sole, pressed, np.array([travel]), tilt=tilt)[0] for each in measured
        ]
        return [float(np.log(f / (travel * each.stiffness))) for f, each in zip(forces, measured, strict=True)]

    # central differences, to the end: what one-sided ones come to differs by 1e-7 from processor to processor
    found = least_squares(off, np.zeros(2), jac="3-point", diff_step=[1e-4, 1e-4], xtol=1e-13, ftol=1e-15, gtol=1e-15)
    return with_factors(found.x)


def _pressed(one: QuasiStaticKeel, travel: Float[np.ndarray, " t"], tilt: float) -> Float[np.ndarray, " t"]:
    normal = np.array([-sin(tilt), cos(tilt), 0.0])
    lowest = float((one.sole.spheres.centre @ normal - one.sole.spheres.radius).min())
    plate = HalfSpace(tuple(lowest * normal), tuple(normal))
    down = RigidTransform.from_translation(-travel[:, None] * np.array([0.0, 1.0, 0.0]))
    return np.asarray(one.solve(down, plate, gravity=WEIGHTLESS).force[:, 1])
