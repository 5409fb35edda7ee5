"""Static compression of the forefoot, simulated: a plate on the keel's tip, or on the spheres of the sole.

The study of the variable-stiffness foot fits its model to such tests without saying where the plate presses, how it is
tilted and how far it goes. Here it is tilted by 20 degrees, toes first, as the forefoot plate of ISO 10328, and
travels 5 mm along y. Without friction and damping.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, radians, sin

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.compression import Compressed
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.quasi_static import QuasiStaticKeel
from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.sphere_set import SoleLaw, SphereSet

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
) -> tuple[Keel, SoleLaw]:
    """The same with EI and the forefoot's stiffness such that compressions of the sole are nearest to measured ones.

    Least squares of relative errors; two compressions are met. The stiffness is the force over the whole travel. GJ
    keeps its ratio to EI.
    """
    forefoot = sole.spheres.zones[FOREFOOT]

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

    return with_factors(least_squares(off, np.zeros(2), xtol=1e-12).x)


def _pressed(one: QuasiStaticKeel, travel: Float[np.ndarray, " t"], tilt: float) -> Float[np.ndarray, " t"]:
    normal = np.array([-sin(tilt), cos(tilt), 0.0])
    lowest = float((one.sole.spheres.centre @ normal - one.sole.spheres.radius).min())
    plate = HalfSpace(tuple(lowest * normal), tuple(normal))
    down = RigidTransform.from_translation(-travel[:, None] * np.array([0.0, 1.0, 0.0]))
    return np.asarray(one.solve(down, plate, gravity=WEIGHTLESS).force[:, 1])
