"""A walking trial of both legs of a synthetic person: what cameras see, and both plates of a walk along given angles.

The walk is simulated with the load of the intact foot given. Markers are those of the model whose socket does not move,
with errors of skin and cameras; plates are exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from zlib import crc32

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.recorded_steps import centre_on_floor
from geocontact.below_knee_prosthesis.both_sides.walk import GivenWalk, WholeMotion, walk_by_angles
from geocontact.below_knee_prosthesis.from_markers import BODIES, INTACT_BODIES
from geocontact.data.multibody.markers import MarkerTrajectories
from meshes.amputee import DEFORMED, fully_marked
from meshes.amputee_walk import amputee_walk
from meshes.gait_persons import STANCE
from meshes.gait_trial import skin_error

EVERY, STEP, TOLERANCE = 2, 1e-3, 1e-6
"""Which of the given samples cameras see; s between samples of the simulation, and error of a step."""


@dataclass(frozen=True, eq=False)
class AmputeeTrial:
    """What was walked, and what was recorded of it.

    Parameters
    ----------
    walking
        Markers, x forward and y up.
    own, other
        Force and moment about the origin on the prosthetic and the intact foot at the times of `given` [N, N m].
    """

    truth: Amputee
    given: GivenWalk
    walk: WholeMotion
    walking: MarkerTrajectories
    own: Float[np.ndarray, "t 6"]
    other: Float[np.ndarray, "t 6"]


def amputee_trial(truth: Amputee, setting: str, *, errors: float = 1.0, machine_code: bool = True) -> AmputeeTrial:
    """A stance of the prosthesis between two of the other foot; `errors` is a factor on those of the markers."""
    given, span = amputee_walk(truth, STANCE[setting])
    walk = walk_by_angles(truth, given, np.arange(*span, STEP), tolerance=TOLERANCE, machine_code=machine_code)
    inside = (given.time >= walk.time[0]) & (given.time <= walk.time[-1])
    own = np.column_stack([np.interp(given.time, walk.time, column) * inside for column in walk.own.T])
    return AmputeeTrial(truth, given, walk, _seen(truth, given, setting, errors), own, given.ground)


def _seen(truth: Amputee, given: GivenWalk, setting: str, errors: float) -> MarkerTrajectories:
    """Markers of the coordinates that were given."""
    whole, time = fully_marked(truth), given.time[::EVERY]
    model = amputee_tree(whole)
    values = np.zeros((len(time), len(model.coordinates)))
    for k, coordinate in enumerate(model.coordinates):
        if coordinate.name in given.names:
            values[:, k] = given.values[::EVERY, given.names.index(coordinate.name)]
    places, rng = model.marker_places(values), np.random.default_rng(crc32(f"both legs {setting}".encode()))
    step = float(time[1] - time[0])
    bodies = {m.name: m.body for m in (*whole.prosthetic.markers, *whole.intact.markers)}
    for body in BODIES | INTACT_BODIES:
        shift = skin_error(body, len(time), step, rng)
        for k, m in enumerate(model.markers):
            if bodies[m.name] == body:
                places[:, k] += errors * (shift + DEFORMED * skin_error(body, len(time), step, rng))
    return MarkerTrajectories(time, places, tuple(m.name for m in model.markers), "synthetic walk")


def plates_of(trial: AmputeeTrial) -> dict[str, Float[np.ndarray, " t"]]:
    """Columns of the plates' file; where nothing presses the point is 0."""
    columns = {"time": trial.given.time}
    for name, wrench in (("own", trial.own), ("other", trial.other)):
        point = np.nan_to_num(centre_on_floor(wrench))
        columns |= {f"{name}_force_v{axis}": wrench[:, k] for k, axis in enumerate("xyz")}
        columns |= {f"{name}_force_p{axis}": point[:, k] for k, axis in enumerate("xyz")}
        columns |= {f"{name}_torque_{axis}": 0.0 * wrench[:, k] for k, axis in enumerate("xyz")}
    return columns
