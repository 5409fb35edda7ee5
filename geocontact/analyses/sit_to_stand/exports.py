"""A motion that stands up for other programs: coordinates and external loads for OpenSim, lines for ParaView."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.sit_to_stand.solution_file import write_solution
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.io.opensim.external_loads_writer import write_external_loads
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.standing_up.chain import COORDINATES, TRUNK, TURNING, Subject, leg_chain
from geocontact.standing_up.chair import SITS
from geocontact.standing_up.exoskeleton import EXO_JOINTS, HEIGHT, two_chains
from geocontact.standing_up.strap_force import StrapForce, strap_force
from geocontact.standing_up.strap_sites import StrapSite, sites_of
from geocontact.view.surfaces.line_series import LineSeries, write_line_series

FRAMES = 101
"""Of what ParaView gets, evenly over the movement."""
GROUND, CHAIR = "ground_force", "chair_force"
PERSON = ("shank", "thigh", "trunk")
EXOSKELETON = ("exo_shank", "exo_thigh", "exo_module")
Vectors = Float[np.ndarray, "t 3"]
Straps = list[tuple[StrapSite, StrapForce]]


def write_motion(folder: Path, subject: Subject, trial: TrialResult, values: Mapping[str, float], solved: bool) -> None:
    """solution_NAME.sto, coordinates_NAME.mot, loads_NAME.mot and .xml, forces_NAME.pvd; the model's, not recorded.

    Parameters
    ----------
    values
        Of the parameters, in SI.
    """
    name, q, time = trial.recorded.name, trial.model.q, trial.recorded.time
    write_solution(folder / f"solution_{name}.sto", trial, solved)
    turning = np.r_[np.array(TURNING), np.ones(q.shape[1] - len(TURNING), bool)]
    names = (*COORDINATES, *EXO_JOINTS)[: q.shape[1]]
    title = "Coordinates while standing up"
    degrees = np.where(turning, np.degrees(q), q)
    write_storage(folder / f"coordinates_{name}.mot", time, names, degrees, title=title, degrees=True)
    worn = q.shape[1] > len(COORDINATES)
    sites = sites_of(values) if worn else ()
    straps = [(site, strap_force(subject, q, trial.model.u, values, site)) for site in sites]
    _write_loads(folder, trial, straps)
    _write_lines(folder, subject, trial, straps)


def _write_loads(folder: Path, trial: TrialResult, straps: Straps) -> None:
    """Of both feet at their centre of pressure, of the chair, and of all straps on the person and back on the
    exoskeleton.
    """
    name, none = trial.recorded.name, np.zeros((len(trial.recorded.time), 3))
    loads: dict[str, tuple[str, Vectors, Vectors, Vectors]] = {
        GROUND: ("foot", _ground(trial), _centre(trial), none),
    }
    if trial.recorded.chair is not None:
        fore, up, about = trial.recorded.chair.T
        loads[CHAIR] = (SITS, np.column_stack([fore, up, none[:, 2]]), none, np.column_stack([none[:, :2], about]))
    for site, strap in straps:
        stem = site.names[0].removesuffix(" normal").replace(" ", "_")
        force, moment = site.count * strap.force, site.count * strap.moment
        loads[f"{stem}_force"] = (site.person, force, strap.place, moment)
        loads[f"{stem}_back_force"] = (site.device, -force, strap.place, -moment)
    names, columns = [], []
    for stem, (_, force, place, moment) in loads.items():
        names += [f"{stem}_{kind}{axis}" for kind in "vp" for axis in "xyz"]
        names += [f"{stem.replace('force', 'torque')}_{axis}" for axis in "xyz"]
        columns += [force, place, moment]
    file, title = f"loads_{name}.mot", "Forces while standing up, both legs"
    write_storage(folder / file, trial.recorded.time, names, np.hstack(columns), title=title, degrees=False)
    bodies = {stem: body for stem, (body, *_) in loads.items()}
    write_external_loads(folder / f"loads_{name}.xml", file, bodies, torques=True)


def _write_lines(folder: Path, subject: Subject, trial: TrialResult, straps: Straps) -> None:
    """Chains, the ground's force on both feet, and that of one strap at each site on the person."""
    time = trial.recorded.time
    kept = np.unique(np.linspace(0, len(time) - 1, FRAMES).round().astype(int))
    poses = (two_chains(subject) if straps else leg_chain(subject)).poses(trial.model.q)
    tops = [(PERSON, "trunk", TRUNK.length * subject.height)]
    tops += [(EXOSKELETON, "exo_module", HEIGHT)] if straps else []
    points, force = [_centre(trial)], {0: _ground(trial)}
    lines: list[tuple[int, ...]] = [(0,)]
    for bodies, last, above in tops:
        lines.append(tuple(range(len(points), len(points) + len(bodies) + 1)))
        points += [poses[body].translation for body in bodies] + [poses[last].apply(np.array([0.0, above, 0.0]))]
    for _, strap in straps:
        lines.append((len(points), len(points) + 1))
        points += [strap.own, strap.place]
        force[len(points) - 1] = strap.force
    on = np.zeros((len(time), len(points), 3))
    for at, vectors in force.items():
        on[:, at] = vectors
    series = LineSeries(time[kept], np.stack(points, axis=1)[kept], lines)
    write_line_series(folder, f"forces_{trial.recorded.name}", series, {"force [N]": on[kept]})


def _ground(trial: TrialResult) -> Vectors:
    return np.column_stack([trial.model.force, np.zeros(len(trial.recorded.time))])


def _centre(trial: TrialResult) -> Vectors:
    return np.column_stack([trial.model.centre, np.zeros((len(trial.recorded.time), 2))])
