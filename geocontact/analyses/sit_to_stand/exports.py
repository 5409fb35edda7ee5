"""Standing up for other programs: motion, loads and model for OpenSim, lines for ParaView, a case for `gap gather`.

A sphere slides and is pressed where OpenSim's is, half of its depth below the ground, and straps are its bushings: the
accelerations of the equations are those of the model.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.io.opensim.external_loads import write_external_loads
from geocontact.io.opensim.osim_contact import bushing_force_between, smooth_sphere_force, torque_along
from geocontact.io.opensim.osim_writer import ContactBall, write_osim
from geocontact.io.opensim.storage_writer import write_moco_trajectory, write_storage
from geocontact.io.text.results import CASES, write_table
from geocontact.standing_up.chain import COORDINATES, FRICTION, SITS, TURNING, Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.stance import chain_of
from geocontact.standing_up.strap import StrapForce, StrapMotion, strap_force, strap_motion
from geocontact.standing_up.strap_sites import THIGH_STRAP, StrapSite, sites_of
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingTrial
from geocontact.view.surfaces.vtp_series import LineSeries, write_line_series

LINE_FRAMES = 101
"""Frames that ParaView gets, evenly over the movement."""
GROUND, CHAIR = "ground_force", "chair_force"
PERSON = ("shank", "thigh", "trunk")
EXOSKELETON = ("exo_shank", "exo_thigh", "exo_module")
Vectors = Float[np.ndarray, "t 3"]
Straps = list[tuple[StrapSite, StrapForce]]
MODEL_NOTE = "Both legs are one planar chain: masses, torques, contacts and bushings are those of both."
GATHER = """# One strap at the thigh: displacements of both chains as recorded, with what the mat measures.
# Trials of the calibration are not held-out ones: put trials that it did not use in their place.
format = 1
system = "sit_to_stand"
calibration = {calibration}
evaluation = {evaluation}

{sources}[constants]
b = {damping:g}

[parameters.k_n_thigh]
start = {stiffness:.6g}
lower = {least:.6g}
upper = {most:.6g}
unit = "N/m"

[parameters.rho_thigh]
start = 0.0
lower = -0.1
upper = 0.1
unit = "m"
"""
STIFFNESS_ROOM = 10.0
"""Factor on the stiffness within which a fit may move it."""


def write_solution(file: Path, trial: TrialResult, solved: bool) -> None:
    """The motion at its collocation points as OpenSim's Moco reads it; torques are those of both legs [N m].

    At these points it solves the equations; at the recording's own times something is left of the balance.
    """
    q, u = trial.points.q, trial.points.u
    names = (*COORDINATES, *EXO_JOINTS)[: q.shape[1]]

    def paths(ending: str, values: Float[np.ndarray, "t n"]) -> dict[str, Float[np.ndarray, " t"]]:
        return {f"/jointset/{name}/{name}/{ending}": values[:, k] for k, name in enumerate(names)}

    states = paths("value", q) | paths("speed", u)
    torque = np.zeros((len(q), 0)) if trial.points.torque is None else trial.points.torque
    controls = {f"/forceset/{name}_torque": column for name, column in zip(names[3:], torque.T, strict=True)}
    write_moco_trajectory(file, trial.points.time, states, controls, paths("accel", trial.acceleration), solved)


def write_motion(
    folder: Path,
    subject: Subject,
    trial: TrialResult,
    values: Mapping[str, float],
    solved: bool,
    sites: Sequence[StrapSite] = (),
) -> None:
    """solution_NAME.sto, coordinates_NAME.mot, loads_NAME.mot and .xml, forces_NAME.pvd; the model's, not recorded.

    Parameters
    ----------
    values
        Of the parameters, in SI.
    sites
        Where straps are; those of the values, damped as in the study of the paper, by default.
    """
    name, q, time = trial.recorded.name, trial.model.q, trial.recorded.time
    write_solution(folder / f"solution_{name}.sto", trial, solved)
    turning = np.r_[np.array(TURNING), np.ones(len(EXO_JOINTS), bool)][: q.shape[1]]
    names = (*COORDINATES, *EXO_JOINTS)[: q.shape[1]]
    title = "Coordinates while standing up"
    degrees = np.where(turning, np.degrees(q), q)
    write_storage(folder / f"coordinates_{name}.mot", time, names, degrees, title=title, degrees=True)
    worn = q.shape[1] > len(COORDINATES)
    sites = (sites or sites_of(values)) if worn else ()
    straps = [(site, strap_force(subject, q, trial.model.u, values, site)) for site in sites]
    _write_loads(folder, trial, straps)
    _write_lines(folder, subject, trial, straps)


def _write_loads(folder: Path, trial: TrialResult, straps: Straps) -> None:
    """Forces on both feet at their centre of pressure, of the chair, and of all straps both ways."""
    name, none = trial.recorded.name, np.zeros((len(trial.recorded.time), 3))
    loads: dict[str, tuple[str, Vectors, Vectors, Vectors]] = {
        GROUND: ("foot", _ground(trial), _centre(trial), none),
    }
    if trial.recorded.chair is not None:
        fore, up, about = trial.recorded.chair.T
        loads[CHAIR] = (
            _loaded(trial),
            np.column_stack([fore, up, none[:, 2]]),
            none,
            np.column_stack([none[:, :2], about]),
        )
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
    kept = np.unique(np.linspace(0, len(time) - 1, LINE_FRAMES).round().astype(int))
    chain, last = chain_of(subject, trial.model.q.shape[1]), _loaded(trial)
    poses = chain.poses(trial.model.q)
    person = PERSON[: PERSON.index(last) + 1]
    tops: list[tuple[tuple[str, ...], str, float]] = [(person, last, subject.segments[last].length)]
    tops += [(EXOSKELETON, "exo_module", subject.device.module_height)] if straps else []
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


def _loaded(trial: TrialResult) -> str:
    """The body that a given load acts on: the trunk on a chair, the thigh of one leg in stance."""
    return SITS if trial.model.q.shape[1] >= len(COORDINATES) else "thigh"


def _ground(trial: TrialResult) -> Vectors:
    return np.column_stack([trial.model.force, np.zeros(len(trial.recorded.time))])


def _centre(trial: TrialResult) -> Vectors:
    return np.column_stack([trial.model.centre, np.zeros((len(trial.recorded.time), 2))])


def write_standing_model(
    file: Path,
    subject: Subject,
    values: Mapping[str, float],
    *,
    worn: bool,
    sites: Sequence[StrapSite] = (),
    one_leg: bool = False,
) -> None:
    """Spheres under the foot, straps as bushings where an exoskeleton is worn, torques of all joints.

    Parameters
    ----------
    values
        Of the parameters of feet and straps, in SI.
    sites
        Where straps are; those of the values, damped as in the study of the paper, by default.
    one_leg
        Whether the chain is that of a stance.
    """
    count = len(COORDINATES) + (len(EXO_JOINTS) if worn else -1 if one_leg else 0)
    chain = chain_of(subject, count)
    height, factor = values["radius"] - values["bottom"], values["friction"]
    friction = [float(each) for each in (FRICTION.v_t, FRICTION.mu_s * factor, FRICTION.mu_d * factor, FRICTION.mu_v)]
    balls = [
        ContactBall(name, "foot", np.array([values[name], height, 0.0]), values["radius"]) for name in ("heel", "toe")
    ]
    forces = [smooth_sphere_force(each.name, values["stiffness"], values["dissipation"], friction) for each in balls]
    if worn:
        forces += [_bushing(site, values) for site in sites or sites_of(values)]
    forces += [torque_along(each.name) for each in chain.coordinates[3:]]
    write_osim(file, replace(chain, name="sit_to_stand"), balls=balls, forces=forces, note=MODEL_NOTE)


def _bushing(site: StrapSite, values: Mapping[str, float]) -> Element:
    """All straps of a site in one; called strap at the thigh, and shank_strap, pelvis_strap."""
    normal, tangential, turning, place = (values[name] for name in site.names)
    there = np.array([0.0, place, 0.0])
    ends = [(site.person, there), (site.device, there - [0.0, site.above, 0.0])]
    turns, moves = np.array([0.0, 0.0, site.count]), np.array([site.count, site.count, 0.0])
    stiff = turns * turning, moves * [normal, tangential, 0.0]
    name = site.names[0].removesuffix(" normal").replace(" ", "_")
    return bushing_force_between(name, ends, stiff, (turns * site.turning_damping, moves * site.damping))


def write_strap_case(
    folder: Path,
    subject: Subject,
    trials: Sequence[StandingTrial],
    values: Mapping[str, float],
    held_out: int = 2,
    site: StrapSite = THIGH_STRAP,
) -> None:
    """NAME_strap.csv (displacements), NAME_mat.csv (normal force) and gather.toml, the last `held_out` to evaluate on.

    Of fewer than four trials with the thigh's strap at most half are held out, and nothing is written of one: a
    diagnosis needs two to fit to and two held out.

    Parameters
    ----------
    values
        Of the strap's parameters, in SI.
    site
        The thigh's strap, with its dashpot.
    """
    trials = [trial for trial in trials if trial.strap is not None and np.isfinite(trial.strap).all()]
    if len(trials) < 2:
        return
    held_out = min(held_out, len(trials) // 2)
    folder.mkdir(parents=True, exist_ok=True)
    for trial in trials:
        moved = strap_motion(subject, trial.q, values["strap place"], site)
        write_table(motion_table(trial, moved), folder, f"{trial.name}_strap", CASES)
        mat = pd.DataFrame({"time [s]": trial.time, "thigh_force [N]": trial.strap})
        write_table(mat, folder, f"{trial.name}_mat", CASES)
    names = [trial.name for trial in trials]
    sources = "".join(f'[from.{n}]\ninputs = "{n}_strap.csv"\noutputs = "{n}_mat.csv"\n\n' for n in names)
    stiffness = values["strap normal"]
    text = GATHER.format(
        calibration=json.dumps(names[:-held_out]),
        evaluation=json.dumps(names[-held_out:]),
        sources=sources,
        damping=site.damping,
        stiffness=stiffness,
        least=stiffness / STIFFNESS_ROOM,
        most=stiffness * STIFFNESS_ROOM,
    )
    (folder / "gather.toml").write_text(text, encoding="utf-8")


def motion_table(trial: StandingTrial, moved: StrapMotion) -> pd.DataFrame:
    """Inputs of the base model."""
    columns = {
        "thigh_normal [m]": moved.normal,
        "thigh_tangential [m]": moved.tangential,
        "thigh_rotation [rad]": moved.rotation,
    }
    return pd.DataFrame({"time [s]": trial.time, **columns})
