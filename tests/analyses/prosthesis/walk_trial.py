"""Files of a synthetic walk of both legs whose motion and forces are known: exact markers, plates of the simulation."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.recorded_steps import centre_on_floor
from geocontact.below_knee_prosthesis.both_sides.walk import GivenWalk, WholeMotion, walk_by_angles
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.trc import write_trc
from meshes.amputee import standing_trials
from meshes.amputee_walk import amputee_walk
from meshes.gait_persons import PARTICIPANTS, STANCE


@dataclass(frozen=True, eq=False)
class KnownWalk:
    """What was walked, and the options that name its files."""

    truth: Amputee
    given: GivenWalk
    walk: WholeMotion
    options: dict[str, Any]


def known_walk(folder: Path, *, machine_code: bool = False) -> KnownWalk:
    """Writes standing.trc, functional.trc, walking.trc and plates.mot of the first person at medium stiffness."""
    person, foot, fulcrum = PARTICIPANTS[0], vsf_foot(), fulcrum_of("medium")
    trials = standing_trials(person, foot, fulcrum, errors=0.0)
    truth = trials.truth
    given, span = amputee_walk(truth, STANCE["medium"])
    time = np.arange(span[0], span[1], 1e-3)
    walk = walk_by_angles(truth, given, time, tolerance=1e-6, machine_code=machine_code)
    model = amputee_tree(truth)
    values = np.zeros((len(given.time), len(model.coordinates)))
    for k, coordinate in enumerate(model.coordinates):
        if coordinate.name in given.names:
            values[:, k] = given.values[:, given.names.index(coordinate.name)]
    names = tuple(m.name for m in model.markers)
    seen = MarkerTrajectories(given.time, model.marker_places(values), names, "synthetic walk")
    for name, trial in (("standing", trials.standing), ("functional", trials.functional), ("walking", seen)):
        write_trc(folder / f"{name}.trc", trial)
    (folder / "plates.mot").write_text(_plates(given, walk))
    options = {
        "static": folder / "standing.trc",
        "functional": folder / "functional.trc",
        "mass": person.mass,
        "height": person.stature,
        "side": person.side,
        "plates": folder / "plates.mot",
        "plate": "own_force",
        "other_plate": "other_force",
        "cutoff": 0.0,
        "machine_code": machine_code,
    }
    return KnownWalk(truth, given, walk, options)


def _plates(given: GivenWalk, walk: WholeMotion) -> str:
    """Both feet at the times of the markers; nothing outside of the walk."""
    inside = (given.time >= walk.time[0]) & (given.time <= walk.time[-1])
    own = np.column_stack([np.interp(given.time, walk.time, column) * inside for column in walk.own.T])
    columns: dict[str, np.ndarray] = {"time": given.time}
    for name, wrench in (("own", own), ("other", given.ground)):
        point = np.nan_to_num(centre_on_floor(wrench))
        columns |= {f"{name}_force_v{axis}": wrench[:, k] for k, axis in enumerate("xyz")}
        columns |= {f"{name}_force_p{axis}": point[:, k] for k, axis in enumerate("xyz")}
        columns |= {f"{name}_torque_{axis}": 0.0 * given.time for axis in "xyz"}
    head = f"synthetic\nversion=1\nnRows={len(given.time)}\nnColumns={len(columns)}\ninDegrees=no\nendheader\n"
    rows = ("\t".join(f"{value:.9g}" for value in row) for row in zip(*columns.values(), strict=True))
    return head + "\n".join(("\t".join(columns), *rows)) + "\n"
