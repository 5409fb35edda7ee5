"""Trials of one person as a study describes them, each from seat-off on at the times of its coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.folder import digest
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.analyses.motion.markers import turn_of
from geocontact.analyses.sit_to_stand.recorded_beside import (
    ANGLES,
    HINGES,
    UPRIGHT,
    doubt_bending,
    doubt_hinges,
    doubt_torques,
)
from geocontact.analyses.sit_to_stand.trial_recordings import (
    FEWEST,
    Times,
    Used,
    chair_force,
    confront_shear,
    motion_of_file,
    named_plate,
    plates_of_trial,
    rates_of,
    require_tracked,
    site_force,
    site_shear,
    wrench_at,
)
from geocontact.analyses.sit_to_stand.worn_exoskeleton import worn_device, worn_sites
from geocontact.analyses.sit_to_stand.worn_trials import (
    confront_segments,
    doubt_friction,
    joint_torques,
    name_odd_segments,
    person_of,
)
from geocontact.data.errors import InputError
from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.data.multibody.model import Multibody
from geocontact.data.wrench import Wrench
from geocontact.io.recordings.standing_study import StandingTrialFiles, read_standing_study
from geocontact.io.text.tables import read_table
from geocontact.standing_up.chain import COORDINATES, FOOT_PARAMETERS, SOUGHT, SOUGHT_WORN, Subject, leg_chain
from geocontact.standing_up.exoskeleton import two_chains
from geocontact.standing_up.movements import LEAST_RANGE, contradiction, hip_height, movements_of
from geocontact.standing_up.phases import TRACKS, TRACKS_B
from geocontact.standing_up.stance import in_stance, load_of_the_rest, off_the_foot, one_leg, smooth
from geocontact.standing_up.trial_forces import SEATED, chair_load, seat_contact, seat_off, under_the_feet
from geocontact.standing_up.trials import CostWeights, StandingNoise, StandingTrial, StandingUpTrials, with_chairs
from geocontact.trial_checks.recorded import FootPlate, MovedModel, RecordedChannel, TrialInputs


def standing_trials(
    file: Path, role: str, c3d_unit: str | None = None, axes: str | None = None, device: Path | None = None
) -> StandingUpTrials:
    """Everything in the study.

    Parameters
    ----------
    c3d_unit
        Unit of .c3d files that have none.
    axes
        What turns plates into x, y up, z.
    device
        Description of the exoskeleton, in place of the study's.
    """
    study = read_standing_study(file)
    add_input(role, file, trials=len(study.trials))
    subject = replace(person_of(study), device=worn_device(study, file, device))
    name_odd_segments(study.person, study.height, file)
    confront_segments(subject, file, study.person)
    size = TrialInputs(mass=study.mass, height=study.height, age=study.person.age, mass_option=f"mass in {file}")
    check_trial(size)
    usual = SOUGHT_WORN if study.exoskeleton else SOUGHT
    free = _known(file, "free", study.free, usual, tuple(each.name for each in FOOT_PARAMETERS))
    channels = TRACKS_B if study.exoskeleton else tuple(n for n in TRACKS if n != "rates" or not study.one_leg)
    tracks = _known(file, "tracks", study.tracks, channels, channels)
    if "coordinates" not in tracks:
        raise InputError(file, "tracks", "coordinates are not among them", "add them: the motion must stay near")
    if study.exoskeleton and "strap" not in tracks:
        raise InputError(file, "tracks", "strap is not among them", "add it, or leave out exoskeleton = true")
    chain = one_leg(subject) if study.one_leg else two_chains(subject) if study.exoskeleton else leg_chain(subject)
    sites = worn_sites(study, file, subject)
    noise = StandingNoise(**study.noise)
    names = tuple(site.name for site in sites[1:])
    _warn_of_copies(study.trials)
    turn = turn_of(axes)
    if axes is not None and all(each.plates is None for each in study.trials):
        raise InputError("", "`axes`", "has no effect without plates", "leave it out")
    read = [channels_of(each, chain, subject, noise, tracks, file, names, c3d_unit, turn) for each in study.trials]
    weights, worn = CostWeights(**study.weights), study.exoskeleton
    return StandingUpTrials(subject, noise, with_chairs(read), worn, free, tracks, sites, weights, study.one_leg)


def refuse_stances(trials: StandingUpTrials, study: Path) -> None:
    """InputError for stances of walking, whose one leg has no movement of its own to predict."""
    if trials.one_leg:
        what = "its trials are stances of one leg, which phase A alone takes"
        raise InputError(study, "[[trials]] task", what, "run sit-to-stand calibrate")


def _warn_of_copies(trials: Sequence[StandingTrialFiles]) -> None:
    """A warning for two trials of one recording, whose weight is doubled."""
    for one, other in combinations(trials, 2):
        ours, theirs = ((each.coordinates.resolve(), each.start, each.end) for each in (one, other))
        if ours == theirs:
            reserve(
                f"{other.name}: its coordinates are those of {one.name}; name the files of each trial's own recording"
            )
        elif ours[0] != theirs[0]:
            for role in ("rates", "torques", "motors", "strap", "strap_shank", "strap_pelvis"):
                own, others = (_contents(getattr(each, role)) for each in (one, other))
                if any(_at_one_time(one, other, own[name]) for name in own.keys() & others.keys()):
                    reserve(
                        f"{other.name}: its {role} is that of {one.name}; name the file of each trial's own recording"
                    )


def _contents(files: Path | Sequence[Path] | None) -> dict[str, Path]:
    """Files that are there by their digest."""
    each = [] if files is None else [files] if isinstance(files, Path) else files
    return {digest(file): file for file in each if file.is_file()}


def _at_one_time(one: StandingTrialFiles, other: StandingTrialFiles, file: Path) -> bool:
    """Whether a file of two trials cannot be of both: they are at one time, or it has not the times of both of them
    though their clocks start alike. A session on one clock may have one file of all its trials.
    """
    clocks = [read_table(each.coordinates).time for each in (one, other)]
    used = [time[_within(each, time)] for each, time in zip((one, other), clocks, strict=True)]
    if not all(map(len, used)):
        return False  # a trial of no samples is refused later
    starts, ends = [each[0] for each in used], [each[-1] for each in used]
    if max(starts) < min(ends):
        return True
    time = read_table(file).time
    step = float(np.median(np.diff(time))) if len(time) > 1 else 0.0
    alike = abs(float(clocks[0][0] - clocks[1][0])) <= step
    return alike and not (time[0] <= min(starts) + step and max(ends) - step <= time[-1])


def _known(
    study: Path, key: str, told: tuple[str, ...] | None, usual: tuple[str, ...], names: tuple[str, ...]
) -> tuple[str, ...]:
    """In the order of all names; the usual ones by default."""
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
    subject: Subject,
    noise: StandingNoise,
    tracks: tuple[str, ...],
    study: Path,
    sites: tuple[str, ...] = (),
    c3d_unit: str | None = None,
    turn: Rotation | None = None,
) -> StandingTrial:
    """The trial; InputError where a channel that is tracked is missing, or where clocks or models are not the same.

    Parameters
    ----------
    sites
        Names of the further straps that the model has.
    c3d_unit
        Of plates in a .c3d file whose own is empty.
    turn
        Of the plates into x forwards, y up.
    """
    place = f"[[trials]] {files.name}"
    require_tracked(files, tracks, study, place)
    time, q = motion_of_file(files.coordinates, chain, f"{files.name} coordinates")
    doubt_bending(files.coordinates, chain, q, hip_height(subject, q))
    whole = MovedModel(chain, time, q, str(files.coordinates))
    feet, chair = plates_of_trial(files, place, time, c3d_unit, turn)
    if files.task == "stance" and feet is not None:
        return _stance(files, subject, whole, feet, study)
    used = _used(files, place, time, hip_height(subject, q), chair)
    if used.sum() < FEWEST:
        what = f"{int(used.sum())} samples are left of it"
        raise InputError(study, place, what, f"{FEWEST} are needed: check start, end and chair")
    time, q = time[used], q[used]
    doubt_hinges(files.coordinates, q[:, ANGLES], q[:, len(COORDINATES) :])
    _doubt_task(files, hip_height(subject, q))
    u = np.zeros_like(q) if files.rates is None else rates_of(files.rates, chain, files.name, time)
    if files.rates is not None:
        rates = np.full_like(whole.values, np.nan)
        rates[used] = u
        whole = replace(whole, rates=rates)
    force, centre = np.zeros((len(time), 2)), np.zeros(len(time))
    if feet is not None and files.plates is not None:
        with named_plate(files.plates, feet):
            force, centre = under_the_feet(wrench_at(feet, time), time, q[:, 0])
    torque = None
    if "torque" in tracks:
        torque = joint_torques(
            files, subject.device, whole.time, whole.values[:, len(COORDINATES) :], used, noise.torque
        )
    else:
        _doubt_unused(files)
        doubt_friction(files.name, subject.device, "torque is not among tracks")
    strap, shear, elsewhere = _of_straps(files, time, sites) if "strap" in tracks else (None, None, {})
    sat_on = None
    if files.sitting and chair is not None and files.plates is not None:
        with named_plate(files.plates, chair):
            sat_on = chair_load(wrench_at(chair, time), time)
    upright = [k for k in (-1, 0) if feet is not None and np.abs(q[k, ANGLES]).max() < UPRIGHT]
    inputs = TrialInputs(
        plates=tuple(FootPlate(each, str(files.plates)) for each in (feet, chair) if each is not None),
        mass=chain.mass,
        mass_option=f"mass in {study}",
        stands_at=float(time[upright[0]]) if upright else None,
        turn=turn,
        moved=whole,
    )
    check_trial(replace(inputs, channels=_recorded(study, time, torque, strap)))
    trial = StandingTrial(time - time[0], q, u, force, centre, files.name, torque, strap, sat_on, elsewhere, shear)
    if files.torques is not None:
        doubt_torques(files.name, files.torques, chain, trial)
    return trial


def _of_straps(
    files: StandingTrialFiles, time: Float[np.ndarray, " t"], sites: tuple[str, ...]
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"] | None, dict[str, Float[np.ndarray, " t"]]]:
    """Force of the thigh's strap, its shear, and forces of straps elsewhere [N]."""
    strap = site_force(files.strap, f"{files.name} strap", "thigh", time)
    shear = site_shear(files.strap, time)
    confront_shear(files, shear, strap, time)
    roles = {site: f"{files.name} strap_{site}" for site in sites}
    return strap, shear, {s: site_force(files.elsewhere.get(s, ()), role, s, time) for s, role in roles.items()}


def _recorded(
    study: Path,
    time: Float[np.ndarray, " t"],
    torque: Float[np.ndarray, "t h"] | None,
    strap: Float[np.ndarray, " t"] | None,
) -> tuple[RecordedChannel, ...]:
    """Force of the strap [N] and torques of hinges [N m], as far as they are tracked."""
    found = [("strap", "N", strap)] if strap is not None else []
    if torque is not None:
        found += [(f"torque of {name}", "N m", own) for name, own in zip(HINGES, torque.T, strict=False)]
    return tuple(RecordedChannel(name, unit, time, own, str(study)) for name, unit, own in found)


def _stance(
    files: StandingTrialFiles, subject: Subject, whole: MovedModel, plate: ForcePlate, study: Path
) -> StandingTrial:
    """A stance of walking: low-passed over the whole recording, x from where the ankle stands, and the load of the rest
    of the body.
    """
    time, place = whole.time, f"[[trials]] {files.name}"
    own = FootPlate(plate, str(files.plates))
    walk = _over_the_foot(subject, whole, _within(files, time))
    check_trial(TrialInputs(plates=(own,), mass=subject.mass, mass_option=f"mass in {study}", moved=whole, walk=walk))
    wrench = wrench_at(plate, time)
    raw = np.nan_to_num(np.column_stack([wrench.force[:, :2], wrench.moment[:, 2]]))
    try:
        q, load = smooth(time, whole.values), smooth(time, raw)
    except ValueError as error:
        raise InputError(
            files.coordinates, "", str(error), "resample the coordinates evenly, at 50 Hz or more"
        ) from error
    used = _within(files, time) & in_stance(load[:, 1], q[:, 2])
    if used.sum() < FEWEST or np.diff(np.flatnonzero(used)).max() > 1:
        what = f"{int(used.sum())} samples of stance are left of it, or those of several stances"
        raise InputError(study, place, what, "give start and end of one: sit-to-stand coordinates writes them")
    # the origin lies where the ankle stands
    stood = float(np.median(q[used, 0]))
    q, load = q - [stood, 0.0, 0.0, 0.0, 0.0], load - np.outer(stood * load[:, 1], [0.0, 0.0, 1.0])
    rest = load_of_the_rest(subject, time, q, load)
    step = float(np.ptp(time)) / (len(time) - 1)
    u, at = np.gradient(q, step, axis=0), time[used]
    none = np.zeros((len(at), 1))
    force3, moment = np.hstack([load[used, :2], none]), np.hstack([none, none, load[used, 2:]])
    with named_plate(Path(own.source), plate):
        force, centre = under_the_feet(Wrench(force3, moment, 0.0 * force3, wrench.frame), at, q[used, 0])
    off = off_the_foot(centre, q[used, 0])
    if off is not None:
        what = f"its load is {off:.2f} m ahead of the ankle (median)"
        raise InputError(study, f"{place} feet", what, "is it the plate of the other foot?")
    return StandingTrial(at - at[0], q[used], u[used], force, centre, files.name, chair=rest[used])


def _over_the_foot(subject: Subject, whole: MovedModel, used: Used) -> Float[np.ndarray, " 3"] | None:
    """Mean velocity of the hip over the ankle [m/s]; None without two samples."""
    if used.sum() < 2:
        return None
    turn = np.cumsum(whole.values[used, 2:5], axis=1)[:, 1:]
    ahead = -np.sin(turn) @ [subject.segments[name].length for name in ("shank", "thigh")]
    speed = (ahead[-1] - ahead[0]) / float(np.ptp(whole.time[used]))
    return np.array([float(speed), 0.0, 0.0])


def _doubt_unused(files: StandingTrialFiles) -> None:
    """A warning for what says of the exoskeleton's torques where torques are not tracked."""
    for key in ("motors", "mode"):
        if getattr(files, key) is not None:
            reserve(f"{files.name}: {key} has no effect, as torque is not among tracks: add it, or leave {key} out")


def _within(files: StandingTrialFiles, time: Times) -> Bool[np.ndarray, " t"]:
    low = -np.inf if files.start is None else files.start
    high = np.inf if files.end is None else files.end
    return np.asarray((time >= low) & (time <= high))


def _used(files: StandingTrialFiles, place: str, time: Times, height: Times, chair: ForcePlate | None) -> Used:
    """Samples of the trial: between its times, within its movement, and off the chair unless sitting belongs to it."""
    used = _within(files, time)
    loaded = np.zeros(0) if chair is None else chair_force(chair)
    if files.movement is not None:
        seen = None if chair is None else np.interp(time, chair.time, loaded)
        used &= _movement(files, place, time, height, seen)
    if chair is None or files.plates is None or files.sitting or not used.any():
        return used
    first, last = time[used][[0, -1]]
    own, cut = (chair.time >= first) & (chair.time <= last), (files.start, files.end, files.movement) != (None,) * 3
    if own.any() and not (cut and loaded[own].max() < SEATED):
        with named_plate(files.plates, chair):
            used &= _off_the_seat(files.task, time, chair.time[own], loaded[own])
    return used


def _movement(files: StandingTrialFiles, place: str, time: Times, height: Times, chair: Times | None) -> Used:
    """When the movement of the recording is that the trial names."""
    try:
        every = movements_of(time, height, chair, squats=files.task == "squat")
    except ValueError as error:
        raise InputError(files.coordinates, "", str(error), "give a longer recording, or start and end") from error
    kinds = {files.task, {"standing up": "rising", "sitting down": "going down"}.get(files.task)}
    found = [one for one in every if one.kind in kinds]
    wanted = files.movement or 1
    if wanted > len(found):
        what = f"{files.task} is there {len(found)} times in {files.coordinates.name}, among {len(every)} movements"
        raise InputError(place, "movement", what, "run geocontact sit-to-stand movements to see them")
    one = found[wanted - 1]
    if not one.agrees:
        reserve(f"{files.name}, {one.kind}: {contradiction(one)}")
    return np.asarray((time >= one.start) & (time <= one.end))


def _off_the_seat(task: str, time: Times, own: Float[np.ndarray, " s"], force: Float[np.ndarray, " s"]) -> Used:
    """Times from seat-off on, or up to seat contact."""
    if task == "sitting down":
        return np.asarray(time < seat_contact(own, force))
    return np.asarray(time >= seat_off(own, force))


def _doubt_task(files: StandingTrialFiles, height: Times) -> None:
    """A task that the coordinates contradict: by which the hip rises, and how far it goes down in between."""
    rise, dip = float(height[-1] - height[0]), float(min(height[0], height[-1]) - height.min())
    way = "squat" if dip > abs(rise) else "standing up" if rise > 0.0 else "sitting down"
    if way != files.task and max(dip, abs(rise)) > LEAST_RANGE:
        reserve(f'{files.name}: the hip moves as in {way}, and its task is {files.task}: write task = "{way}"')
