"""A synthetic trial: a stance by a finer foot than the one that is to predict it, seen by cameras and force plates.

The truth has more keel joints and twice as many rows of spheres, which stand for a continuous beam and dense foam: a
finer model of the same kind, not another one. Markers of pelvis and thigh move on the skin, those of the socket do not;
plates have noise and an offset. All sizes of errors are invented.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from zlib import crc32

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter1d

from geocontact.below_knee_prosthesis.from_markers import STANDING, mirrored_name, of_side
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg import Leg, Side
from geocontact.below_knee_prosthesis.leg_tree import RECORDED, recorded_tree
from geocontact.below_knee_prosthesis.simulate import Stance, simulate_stance
from geocontact.data.multibody.markers import MarkerTrajectories
from meshes.gait_course import GaitCourse, course
from meshes.gait_persons import STANCE, Walker, marker_places, true_leg

JOINTS, FINER, ROWS = 12, 2, 2
"""Of the truth's keel and sole: joints, factor on the rows of spheres, spheres in a row."""
CAMERAS, PLATES = 5, 1
"""Every which sample of the simulation cameras (100 Hz) and plates (500 Hz) take."""
CAMERA_NOISE = 0.3e-3
SKIN = {
    "pelvis": 2.0e-3,
    "thigh": 4.0e-3,
    "shank": 0.0,
    "intact_thigh": 4.0e-3,
    "intact_shank": 3.0e-3,
    "intact_foot": 1.0e-3,
    "intact_toes": 1.0e-3,
}
"""m; standard deviation of a camera's error and of the skin's smooth one, by body."""
SKIN_TIME = 0.08
"""s; over which the skin's error changes."""
FORCE_NOISE, OFFSET = 2.0, 1.0
"""N; standard deviation of a sample and of a plate's constant error."""
STANDING_FRAMES = 20


@dataclass(frozen=True, eq=False)
class GaitTrial:
    """What cameras and plates saw, and what was true.

    Parameters
    ----------
    standing, walking
        Markers in the laboratory: x forward, y up, z to the right.
    time, own, other
        Of the plates [s]; forces on both feet [N] and the own one's centre of pressure [m].
    centre
        Of the own foot [m]; NaN where it is not loaded.
    truth
        As of a right leg.
    """

    name: str
    person: Walker
    setting: str
    standing: MarkerTrajectories
    walking: MarkerTrajectories
    time: Float[np.ndarray, " t"]
    own: Float[np.ndarray, "t 3"]
    other: Float[np.ndarray, "t 3"]
    centre: Float[np.ndarray, "t 3"]
    truth: Stance


@lru_cache(maxsize=2)
def true_foot() -> VariableStiffnessFoot:
    """The foot that is the truth."""
    return vsf_foot(joints=JOINTS, finer=FINER, columns=ROWS)


def synthetic_trial(person: Walker, setting: str, number: int = 1, *, machine_code: bool = True) -> GaitTrial:
    """One trial; the same numbers every time."""
    name = f"{person.name}_{setting}_{number}"
    rng = np.random.default_rng(crc32(name.encode()))
    foot, fulcrum = true_foot(), fulcrum_of(setting, "pinned")
    below = sole_numbers()["below"].value
    leg = true_leg(person, below)
    lasting = STANCE[setting] * (1.0 + 0.02 * rng.standard_normal())
    driven = course(leg, vsf_foot(), fulcrum, lasting, phase=0.2 * rng.standard_normal())
    truth = simulate_stance(
        driven.motion, foot, fulcrum, driven.push, driven.span, tolerance=1e-5, machine_code=machine_code
    )
    places = marker_places(leg, foot.keel.length)
    walking = _seen(truth, driven, leg, places, rng)
    push = driven.push.at(truth.time)
    noisy = [
        force + rng.normal(0.0, FORCE_NOISE, force.shape) + rng.normal(0.0, OFFSET, 3) for force in (truth.force, push)
    ]
    side = person.side
    return GaitTrial(
        name,
        person,
        setting,
        _of_side(standing_places(leg, places, rng), side, "standing"),
        _of_side(walking, side, "walking"),
        truth.time,
        of_side(noisy[0], side),
        of_side(noisy[1], side),
        of_side(truth.centre("ground"), side),
        truth,
    )


def _seen(
    truth: Stance,
    driven: GaitCourse,
    leg: Leg,
    places: dict[str, dict[str, Float[np.ndarray, " 3"]]],
    rng: np.random.Generator,
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, "t m 3"]]:
    """Markers of the walk: pelvis and thigh by the given angles and the pelvis' free place, the socket where it is."""
    kept = slice(None, None, CAMERAS)
    time = truth.time[kept]
    values = np.column_stack([np.interp(time, driven.motion.time, driven.motion.of(name)) for name in RECORDED])
    for k in range(2):
        values[:, 3 + k] = truth.found.q[kept, k]
    poses = recorded_tree(leg).poses(values)
    keel = truth.poses[kept]
    found = {}
    for body, of in places.items():
        for name, place in of.items():
            on_keel = leg.turn.inv().apply(place - leg.keel)
            at = keel.apply(on_keel) if body == "shank" else poses[body].apply(place)
            found[name] = at + skin_error(body, len(time), float(time[1] - time[0]), rng)
    return time, np.stack([found[name] for name in STANDING], axis=1)


def skin_error(body: str, frames: int, step: float, rng: np.random.Generator) -> Float[np.ndarray, "t 3"]:
    """Smooth error of the skin on a body and white one of the cameras [m], over frames that are `step` apart [s]."""
    smooth = gaussian_filter1d(rng.standard_normal((frames, 3)), SKIN_TIME / step, axis=0, mode="wrap")
    smooth *= SKIN[body] / max(float(smooth.std()), 1e-12)
    return smooth + rng.normal(0.0, CAMERA_NOISE, (frames, 3))


def standing_places(
    leg: Leg, places: dict[str, dict[str, Float[np.ndarray, " 3"]]], rng: np.random.Generator
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, "t m 3"]]:
    """Upright with the foot flat: the shank vertical, hip and knee nearly straight."""
    time = np.arange(STANDING_FRAMES) / 100.0
    tilt, knee = 0.12, 0.03
    values = np.zeros((1, len(RECORDED)))
    values[0, RECORDED.index("pelvis_tilt")] = tilt
    values[0, RECORDED.index("hip_flexion")] = knee - tilt
    values[0, RECORDED.index("knee_flexion")] = knee
    poses = recorded_tree(leg).poses(values)
    keel = poses["shank"].apply(leg.keel)[0]
    up = sole_numbers()["below"].value - keel[1]
    rows = {name: poses[body].apply(place)[0] for body, of in places.items() for name, place in of.items()}
    still = np.stack([rows[name] for name in STANDING]) + np.array([0.0, up, 0.0])
    return time, still + rng.normal(0.0, CAMERA_NOISE, (len(time), *still.shape))


def _of_side(
    seen: tuple[Float[np.ndarray, " t"], Float[np.ndarray, "t m 3"]], side: Side, what: str
) -> MarkerTrajectories:
    names = STANDING if side == "right" else tuple(mirrored_name(name) for name in STANDING)
    return MarkerTrajectories(seen[0], of_side(seen[1], side), names, f"synthetic {what}")
