"""Trials of one person as a study describes them, each from seat-off on at the times of its coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.frame.collector import add_input
from geocontact.data.errors import InputError
from geocontact.data.multibody.model import Multibody
from geocontact.identify.signals.filters import UNEVEN, zero_lag
from geocontact.io.mocap.force_plates import LOADED, ForcePlate, plate_named, read_force_plates
from geocontact.io.opensim.coordinates import columns_of, motion_of
from geocontact.io.recordings.standing_study import StandingTrialFiles, read_standing_study
from geocontact.io.text.tables import read_table
from geocontact.standing_up.chain import COMPONENTS, FOOT_PARAMETERS, SOUGHT, SOUGHT_WORN, Subject, leg_chain
from geocontact.standing_up.exoskeleton import two_chains
from geocontact.standing_up.phases import TRACKS, TRACKS_B
from geocontact.standing_up.strap_sites import THIGH_STRAP, StrapSite, strap_sites
from geocontact.standing_up.trials import StandingNoise, StandingTrial

SEATED = 5.0
"""Force on the chair from which on one sits [N], the study's."""
CHAIR_CUTOFF = 10.0
"""Cut-off of the chair's force [Hz], ours: the load is given, so that a motion would have to follow its noise."""
FEWEST = 20
"""Samples of a trial."""
NORMAL, FORWARDS = "normal", "fx"
"""Columns of a strap's force: in a file of its own, and in the wrench.csv of a mat, whose scan has x forwards."""
SCANS = {"thigh": "thigh", "shank": "shank", "pelvis": "torso"}
"""What a scan of a site is of."""
CELL = "r0c0"
"""First cell in a mat's own recording."""
BESIDE = 0.5
"""Farther from the ankle than that [m] a centre of pressure is not under the foot."""

Times = Float[np.ndarray, " t"]
Table = Float[np.ndarray, "t c"]


@dataclass(frozen=True, eq=False)
class StandingUpTrials:
    """Trials of one person.

    Parameters
    ----------
    exoskeleton
        Whether it was worn, so that its strap is calibrated too.
    free, tracks
        Names of the feet's parameters, and channels.
    sites
        Where straps are, if an exoskeleton was worn.
    """

    subject: Subject
    noise: StandingNoise
    trials: tuple[StandingTrial, ...]
    exoskeleton: bool
    free: tuple[str, ...]
    tracks: tuple[str, ...]
    sites: tuple[StrapSite, ...] = (THIGH_STRAP,)

    @property
    def seated(self) -> bool:
        """Whether a trial begins on the chair."""
        return any(trial.chair is not None for trial in self.trials)


def standing_trials(file: Path, role: str, c3d_unit: str | None = None) -> StandingUpTrials:
    """Everything in the study; `c3d_unit` is that of .c3d files that have none."""
    study = read_standing_study(file)
    add_input(role, file, trials=len(study.trials))
    subject = Subject(study.mass, study.height)
    usual = SOUGHT_WORN if study.exoskeleton else SOUGHT
    free = _known(file, "free", study.free, usual, tuple(each.name for each in FOOT_PARAMETERS))
    channels = TRACKS_B if study.exoskeleton else TRACKS
    tracks = _known(file, "tracks", study.tracks, channels, channels)
    if "coordinates" not in tracks:
        raise InputError(file, "tracks", "coordinates are not among them", "add them: the motion must stay near")
    if study.exoskeleton and "strap" not in tracks:
        raise InputError(file, "tracks", "strap is not among them", "add it, or leave out exoskeleton = true")
    chain = two_chains(subject) if study.exoskeleton else leg_chain(subject)
    sites = strap_sites(tuple(site for each in study.trials for site in each.elsewhere))
    names = tuple(site.name for site in sites[1:])
    trials = with_chairs([channels_of(each, chain, tracks, file, names, c3d_unit) for each in study.trials])
    return StandingUpTrials(subject, StandingNoise(**study.noise), trials, study.exoskeleton, free, tracks, sites)


def with_chairs(trials: Sequence[StandingTrial]) -> tuple[StandingTrial, ...]:
    """Where one begins on the chair, the others have one that carries nothing."""
    if all(trial.chair is None for trial in trials):
        return tuple(trials)
    return tuple(
        trial if trial.chair is not None else replace(trial, chair=np.zeros((len(trial.time), COMPONENTS)))
        for trial in trials
    )


def _known(
    study: Path, key: str, told: tuple[str, ...] | None, usual: tuple[str, ...], names: tuple[str, ...]
) -> tuple[str, ...]:
    """In the order of all names; the usual ones where nothing is told."""
    if told is None:
        return usual
    odd = [name for name in told if name not in names]
    if odd or not told:
        what = f"{odd[0]!r} is not known here" if odd else "names nothing"
        raise InputError(study, key, what, f"names are {', '.join(names)}")
    return tuple(name for name in names if name in told)


def channels_of(
    files: StandingTrialFiles,
    chain: Multibody,
    tracks: tuple[str, ...],
    study: Path,
    sites: tuple[str, ...] = (),
    c3d_unit: str | None = None,
) -> StandingTrial:
    """The trial; InputError where a channel that is tracked is missing, or where clocks or models are not the same.

    Parameters
    ----------
    sites
        Names of the further straps that the model has.
    c3d_unit
        Of plates in a .c3d file whose own is empty.
    """
    place = f"[[trials]] {files.name}"
    _require_tracked(files, tracks, study, place)
    time, q = _motion(files.coordinates, chain, f"{files.name} coordinates")
    off, feet, chair = time >= time[0], None, None
    if files.plates is not None:
        plates = read_force_plates(files.plates, c3d_unit)
        add_input(f"{files.name} plates", files.plates, plates=len(plates))
        feet = plate_named(plates, files.feet, files.plates, f"{place} feet")
        _require_one_clock(files.plates, feet, time)
        if files.chair is not None:
            chair = plate_named(plates, files.chair, files.plates, f"{place} chair")
            left = time >= seat_off(files.plates, chair)
            off = off if files.sitting else left
    used = off & _within(files, time)
    if used.sum() < FEWEST:
        what = f"{int(used.sum())} samples are left of it"
        raise InputError(study, place, what, f"{FEWEST} are needed: check start, end and chair")
    time, q = time[used], q[used]
    u = np.zeros_like(q) if files.rates is None else _rates(files.rates, chain, files.name, time)
    force, centre = np.zeros((len(time), 2)), np.zeros(len(time))
    if feet is not None and files.plates is not None:
        force, centre = _under_the_feet(files.plates, feet, time, q[:, 0])
    torque, strap, elsewhere = None, None, {}
    if "torque" in tracks and files.torques is not None:
        names = [c.name for c in chain.coordinates[3:]]
        torque = _columns(files.torques, names, f"{files.name} torques", time)
    if "strap" in tracks:
        strap = site_force(files.strap, f"{files.name} strap", "thigh", time)
        roles = {site: f"{files.name} strap_{site}" for site in sites}
        elsewhere = {s: site_force(files.elsewhere.get(s, ()), role, s, time) for s, role in roles.items()}
    sat_on = None
    if files.sitting and chair is not None and files.plates is not None:
        sat_on = chair_load(files.plates, chair, time)
    return StandingTrial(time - time[0], q, u, force, centre, files.name, torque, strap, sat_on, elsewhere)


def _require_tracked(files: StandingTrialFiles, tracks: tuple[str, ...], study: Path, place: str) -> None:
    for channel, file, key in (
        ("rates", files.rates, "rates"),
        ("force", files.plates, "plates"),
        ("centre", files.plates, "plates"),
        ("torque", files.torques, "torques"),
        ("strap", next(iter([*files.strap, *sum(files.elsewhere.values(), ())]), None), "strap"),
    ):
        if channel in tracks and file is None:
            what = f"{channel} is tracked, and this trial has none"
            raise InputError(study, place, what, f"name its file as {key}, or leave {channel} out of tracks")


def chair_load(file: Path, chair: ForcePlate, time: Times) -> Table:
    """Force forwards and up [N] and moment about the ground's origin [N m] on the person, low-passed, (t, 3).

    300 N that are let go within 0.3 s from the first sample on are off by 1 N at most for it.
    """
    wrench = chair.at(np.clip(time, *chair.time[[0, -1]]))
    load = np.nan_to_num(np.column_stack([wrench.force[:, :2], wrench.moment[:, 2]]))
    step, remedy = float(np.median(np.diff(time))), "resample the coordinates evenly, at 50 Hz or more"
    if np.abs(np.diff(time) - step).max() > 2.0 * UNEVEN * step:
        raise InputError(file, chair.name, "is wanted at times that are not even, as a filter needs them", remedy)
    try:
        return zero_lag(load, step, CHAIR_CUTOFF)
    except ValueError as error:
        raise InputError(file, chair.name, str(error), remedy) from error


def site_force(files: Sequence[Path], role: str, site: str, time: Times) -> Times:
    """Sum over the mats of one strap [N]; not a number where there is none."""
    forces = [strap_force(file, role, site, time) for file in files]
    return np.asarray(np.sum(forces, axis=0)) if forces else np.full(len(time), np.nan)


def strap_force(file: Path, role: str, site: str, time: Times) -> Times:
    """Normal force on the person, forwards positive [N]; InputError for pressures of cells that lie on no body."""
    names = read_table(file).channels
    if CELL in names:
        what = "is a mat's own recording: pressures of cells, and the mat is not registered to a body"
        remedy = (
            f"register it: run geocontact mat {file.name} with a scan of the {SCANS[site]} as `surface`, `landmarks`"
        )
        remedy += " and `layout`, and give the wrench.csv that it writes"
        raise InputError(file, "", what, remedy)
    return _columns(file, [FORWARDS if FORWARDS in names else NORMAL], role, time)[:, 0]


def seat_off(file: Path, chair: ForcePlate) -> float:
    """When the chair's force falls below `SEATED` for good [s]; InputError where it never does or never was above."""
    force = np.abs(chair.wrench.force @ chair.normal)
    seated = np.flatnonzero(force >= SEATED)
    if not len(seated):
        what = f"seat-off not found: its force is never {SEATED:g} N"
        raise InputError(file, chair.name, what, "check that this is the chair's plate, or give start")
    if seated[-1] == len(force) - 1:
        what = f"seat-off not found: its force is {force[-1]:.3g} N to the end"
        raise InputError(file, chair.name, what, "check that the plate was set to zero, or give start")
    return float(chair.time[seated[-1] + 1])


def _within(files: StandingTrialFiles, time: Times) -> Bool[np.ndarray, " t"]:
    low = -np.inf if files.start is None else files.start
    high = np.inf if files.end is None else files.end
    return np.asarray((time >= low) & (time <= high))


def _motion(file: Path, chain: Multibody, role: str) -> tuple[Times, Table]:
    table = read_table(file)
    add_input(role, file, frames=len(table.time))
    known = columns_of(table, chain.joints)
    lacking = [c.name for c in chain.coordinates if c.name not in known]
    if lacking:
        remedy = f"all trials are of one model, with {', '.join(c.name for c in chain.coordinates)}"
        raise InputError(file, "", f"no column for {', '.join(lacking)}", remedy)
    if len(table.time) < FEWEST:
        raise InputError(file, "", f"{len(table.time)} frames are too few", f"{FEWEST} are needed")
    step = float(np.ptp(table.time)) / (len(table.time) - 1)
    if np.abs(np.diff(table.time) - step).max() > UNEVEN * step:
        raise InputError(file, "", f"frames are not {step:g} s apart everywhere", "fill the gaps")
    return table.time, motion_of(table, chain)


def _rates(file: Path, chain: Multibody, name: str, time: Times) -> Table:
    own, rates = _motion(file, chain, f"{name} rates")
    if own[0] > time[0] + 1e-9 or own[-1] < time[-1] - 1e-9:
        what = f"runs from {own[0]:g} to {own[-1]:g} s, the coordinates from {time[0]:g} to {time[-1]:g} s"
        raise InputError(file, "", what, "put both on one clock")
    return np.column_stack([np.interp(time, own, column) for column in rates.T])


def _columns(file: Path, names: Sequence[str], role: str, time: Times) -> Table:
    """Columns as they are, in SI, at the times of the trial."""
    table = read_table(file)
    add_input(role, file, frames=len(table.time))
    values = np.column_stack([table.needed(name) for name in names])
    begin, end = table.time[[0, -1]]
    if begin > time[0] + 1e-6 or end < time[-1] - 1e-6:
        what = f"runs from {begin:g} to {end:g} s, the trial from {time[0]:g} to {time[-1]:g} s"
        raise InputError(file, "", what, "put both on one clock")
    return np.column_stack([np.interp(time, table.time, column) for column in values.T])


def _require_one_clock(file: Path, plate: ForcePlate, time: Times) -> None:
    """A plate that was not recording while the markers were is on another clock."""
    begin, end = plate.time[[0, -1]]
    step = float(np.ptp(time)) / (len(time) - 1)
    if begin > time[0] + step or end < time[-1] - step:
        what = f"runs from {begin:g} to {end:g} s, the coordinates from {time[0]:g} to {time[-1]:g} s"
        raise InputError(file, plate.name, what, "put plates and markers on one clock, or cut the coordinates")


def _under_the_feet(file: Path, plate: ForcePlate, time: Times, ankle: Times) -> tuple[Table, Times]:
    """Force forwards and up, and the centre of pressure on the ground y = 0."""
    wrench = plate.at(np.clip(time, *plate.time[[0, -1]]))
    force = wrench.force[:, :2]
    if not np.isfinite(wrench.force).all() or not np.isfinite(wrench.moment[:, 2]).all():
        raise InputError(file, plate.name, "has gaps within the trial", "fill them or cut the trial by start and end")
    if force[:, 1].min() < LOADED:
        what = f"carries {force[:, 1].min():.3g} N at {time[int(np.argmin(force[:, 1]))]:g} s"
        raise InputError(file, plate.name, what, "the feet must stand on it throughout; check that it is theirs")
    centre = wrench.moment[:, 2] / force[:, 1]
    away = float(np.median(centre - ankle))
    if abs(away) > BESIDE:
        what = f"its centre of pressure is {away:.2f} m ahead of the ankle"
        raise InputError(file, plate.name, what, "plates and coordinates must have one origin, x forwards, y up")
    return force, centre
