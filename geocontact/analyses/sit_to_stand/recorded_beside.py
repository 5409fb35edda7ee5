"""Torques and straps of a recording beside what its other channels ask for: a warning for each that is another."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.data.errors import InputError
from geocontact.data.multibody.model import Multibody
from geocontact.identify.signals.agreement import clock_words, lag_of, likely_cause
from geocontact.identify.signals.filters import zero_lag
from geocontact.standing_up.chain import GRAVITY, JOINTS, Subject, leg_chain
from geocontact.standing_up.exoskeleton import EXO_JOINTS, two_chains
from geocontact.standing_up.prediction import contact_parameters
from geocontact.standing_up.recorded_balance import strap_by_coordinates, torques_by_ground
from geocontact.standing_up.trials import StandingTrial, StandingUpTrials
from geocontact.trial_checks.body_checks import BUILD
from geocontact.trial_checks.recorded import FootPlate, MovedModel, TrialInputs
from geocontact.trial_checks.still_checks import STANDING
from geocontact.trial_checks.table import CHECKS

HINGES = (*JOINTS, *EXO_JOINTS)
"""Joints, and hinges beside them, in the order of a file of torques."""
MISSED, MOST = 0.3, 20.0
"""Share of the torque that the ground asks for, and N m, both root mean square: from where the recorded one differs."""
ONE_LEG = (0.4, 0.6)
"""Share of that torque which one of two legs makes."""
STRAPPED, SMALLER, LARGER = 5.0, 0.15, 6.0
"""N, by which a strap's force varies, recorded or by coordinates, from which on both are compared, and parts of the one
that are another unit; errors of angles make it 1.4 times too large by coordinates."""
TURNED, ALIKE = -0.4, 0.5
"""Correlations of both, below which a sign is turned, and above which a lag is looked at."""
CROSSED, APART = 0.3, 0.8
"""Correlations with each other's springs, and their sum beyond that with their own, of straps that are exchanged."""
CUTOFF, FARTHEST, LATE, CLEARER = 6.0, 0.45, 0.1, 0.2
"""Hz, of both; s, of the lags that are looked at, and s and correlation from which a clock is doubted."""


ANGLES, UPRIGHT = slice(3, 6), np.radians(25.0)
"""Ankle, knee and hip; angles of somebody who stands."""
IN_TIME = tuple(check for check in CHECKS if check.name == "weight in time")
"""A check of plates whose mass nobody stated."""
FORWARD_KNEE, BENT = 30.0, 60.0
"""Degrees; a knee that is stretched as far as it goes is 10 degrees beyond straight at most; and from which somebody
sits or squats where the hip is lowest."""
SEATED = {"ankle": 15.0, "hip": -20.0}
"""Degrees that ankle and hip have there at most, flexion being negative: shanks lean forwards, or hardly backwards, and
the trunk is above the thighs."""
LOWERED = 0.2
"""m, by which the hip of who sits down or squats comes down at least, a low chair's seat being 0.4 m high; that of who
walks moves by 0.05 m, and its knee is bent by 60 degrees in swing (Perry, Gait Analysis, 1992)."""


BESIDE, OTHER = 20.0, 60.0
"""Degrees (root mean square) from its joint at which a hinge is doubted, and cannot be worn: synthetic ones of this
model are off by 1, and an angle of 2 degrees read in radians by 110; invented."""


def doubt_hinges(file: Path, joints: Float[np.ndarray, "t j"], hinges: Float[np.ndarray, "t h"]) -> None:
    """InputError for hinges of an exoskeleton that cannot be beside the joints [rad], a warning for those far off.

    Nothing where there are no hinges. Of such angles no motion can be found: a search would run until its time is over.
    """
    if not hinges.shape[1]:
        return
    off = np.degrees(np.sqrt(np.mean((hinges - joints) ** 2, axis=0)))
    for name, joint, most in zip(EXO_JOINTS, JOINTS, off, strict=True):
        what = f"{name} is {most:.0f} degrees (root mean square) from {joint}"
        remedy = "are its unit, sign and zero those of the joint beside it?"
        if most > OTHER:
            raise InputError(file, name, what, remedy)
        if most > BESIDE:
            reserve(f"{file}: {what}: {remedy}", cause=True)


def doubt_bending(
    file: Path, chain: Multibody, values: Float[np.ndarray, "t c"], height: Float[np.ndarray, " t"]
) -> None:
    """A warning for a knee that bends forwards, and for ankle and hip that bend backwards where the hip is lowest.

    Flexion is positive at the knee, negative at ankle and hip; `height` [m] is that of the hip.
    """
    angles = {c.name: angle for c, angle in zip(chain.coordinates, np.degrees(values).T, strict=True)}
    knee = angles["knee"]
    if knee.min() < -FORWARD_KNEE and -knee.min() > knee.max():
        reserve(f"{file}: knee is {knee.min():.0f} degrees at its least, flexion being positive: is its sign turned?")
        return
    for name, angle in angles.items():
        if name in SEATED and np.ptp(angle) == 0.0 and np.ptp(angles["knee"]) > BENT:
            what = f"{name} stays at {abs(angle[0]):.3g} degrees while the knee moves by {np.ptp(angles['knee']):.0f}"
            reserve(f"{file}: {what}: is its column empty?")
    lowest = int(np.argmin(height))
    for name, most in SEATED.items():
        # one leg in stance has no hip
        if name in angles and np.ptp(height) > LOWERED and knee[lowest] > BENT and angles[name][lowest] > most:
            what = f"{name} is {angles[name][lowest]:.0f} degrees where the hip is lowest and the knee bent by"
            reserve(f"{file}: {what} {knee[lowest]:.0f}, flexion of {name} being negative: is its sign turned?")


def doubt_plates(
    plates: tuple[FootPlate, ...],
    moved: tuple[Float[np.ndarray, " t"], Float[np.ndarray, "t c"]],
    height: float,
    file: Path,
) -> None:
    """Plates of all that carries the person, while the person stands with the height, and over time with the motion.

    A warning for a weight that belongs to nobody of that `height` [m], and for plates of another rise; `moved` are
    times [s] and coordinates of `file`. Nothing where the person stands neither at the beginning nor at the end.
    """
    time, q = moved
    stands = [float(time[k]) for k in (-1, 0) if np.abs(q[k, ANGLES]).max() < UPRIGHT]
    if not stands:
        return
    parts = [on.normal[np.abs(on.plate.time - stands[0]) <= STANDING] for on in plates]
    mass = sum(float(part.mean()) if len(part) else np.nan for part in parts) / -GRAVITY[1]
    names = " and ".join(on.plate.name for on in plates)
    if not BUILD[0] <= mass / height**2 <= BUILD[1]:
        what = f"carry {mass * -GRAVITY[1]:.0f} N, {mass:.3g} kg, while a person of {height:.2f} m stands"
        reserve(f"{plates[0].source} {names}: {what}; is the force in N, not in lbf or kgf, and `height` the person's?")
        return
    whole = MovedModel(leg_chain(Subject(mass, height)), time, q, str(file))
    check_trial(TrialInputs(plates=plates, mass=mass, stands_at=stands[0], moved=whole), IN_TIME)


def doubt_torques(name: str, file: Path, chain: Multibody, trial: StandingTrial) -> None:
    """Recorded torques of the joints, and of hinges beside them, with those that ground and coordinates ask for."""
    if trial.torque is None or trial.chair is not None or not trial.force.any():
        return
    asked = torques_by_ground(chain, trial.q, trial.force, trial.centre)
    given = trial.torque[:, :3] + (trial.torque[:, 3:] if trial.torque.shape[1] > 3 else 0.0)
    there = np.isfinite(given)
    given, asked = np.where(there, given, 0.0), np.where(there, asked, 0.0)  # samples that nobody measured
    off, size = (np.sqrt(np.sum(each**2, axis=0) / np.fmax(there.sum(axis=0), 1)) for each in (given - asked, asked))
    missed = [k for k in range(len(JOINTS)) if off[k] > max(MISSED * size[k], MOST)]
    if not missed:
        return
    parts = np.array([given[:, k] @ asked[:, k] / (asked[:, k] @ asked[:, k]) for k in missed])
    named = ", ".join(f"{JOINTS[k]} ({off[k]:.0f} of {size[k]:.0f} N m)" for k in missed)
    if (parts < 0.0).all():
        why = "is their sign turned?"
    elif ((parts > ONE_LEG[0]) & (parts < ONE_LEG[1])).all():
        why = "are they of one leg?"
    elif (np.abs(parts) < 0.05).all():
        why = "are they in N m, and not for each kg of the body?"
    elif any(unit := [likely_cause(asked[:, k], given[:, k]) for k in missed]):
        why = next(each for each in unit if each).lstrip(";: ")
    else:
        why = "are they of this trial, of these joints, and those of the exoskeleton in their sign?"
    reserve(f"{name}: {file} is off the torques that ground reaction and coordinates ask for, rms: {named}; {why}")


def doubt_straps(file: Path, trials: StandingUpTrials, values: Mapping[str, float]) -> None:
    """Recorded normal force of each strap with that of its spring between person and exoskeleton."""
    chain = two_chains(trials.subject) if trials.exoskeleton else leg_chain(trials.subject)
    for trial in trials.trials:
        if trial.straps is None:
            continue
        step = 1.0 / trial.rate
        q = zero_lag(trial.q, step, CUTOFF)
        for site, recorded in zip(trials.sites, trial.straps.T, strict=True):
            if np.isfinite(recorded).all():
                why = _another(strap_by_coordinates(chain, q, site, values), zero_lag(recorded, step, CUTOFF), step)
                if why:
                    reserve(f"{trial.name}: the force of the strap at the {site.name} in {file.name} {why}")


def doubt_sites(trials: StandingUpTrials) -> None:
    """Straps whose stiffness is sought, with the usual springs between person and exoskeleton.

    A warning for one that falls where its spring is pressed more, and for two that follow each other's spring.
    """
    chain = two_chains(trials.subject)
    values = {each.name: each.usual for each in contact_parameters(trials.sites)}
    for trial in trials.trials:
        if trial.straps is None:
            continue
        step = 1.0 / trial.rate
        q = zero_lag(trial.q, step, CUTOFF)
        there = {
            s.name: zero_lag(f, step, CUTOFF) for s, f in zip(trials.sites, trial.straps.T, strict=True) if f.any()
        }
        there = {name: force for name, force in there.items() if np.isfinite(force).all() and np.std(force) > 0.0}
        asked = {s.name: strap_by_coordinates(chain, q, s, values) for s in trials.sites if s.name in there}
        alike = {(a, b): float(np.corrcoef(there[a], asked[b])[0, 1]) for a in there for b in there}
        crossed = [
            (a, b)
            for a, b in combinations(there, 2)
            if min(alike[a, b], alike[b, a]) > CROSSED and alike[a, b] + alike[b, a] - alike[a, a] - alike[b, b] > APART
        ]
        for one, other in crossed:
            what = f"{trial.name}: the strap at the {one} follows the spring of that at the {other}, and vice versa"
            reserve(f"{what}; are they exchanged?")
        for name in there if not crossed else ():
            if alike[name, name] < TURNED and min(np.std(there[name]), np.std(asked[name])) > STRAPPED:
                what = f"{trial.name}: the force of the strap at the {name} falls where its spring is pressed more"
                reserve(f"{what}: is its sign turned, or are the device's angles others?")


def _another(asked: Float[np.ndarray, " t"], recorded: Float[np.ndarray, " t"], step: float) -> str:
    """Why a strap's recorded force is not that of its spring; empty where it may be."""
    expected, varies = float(np.std(asked)), float(np.std(recorded))
    if max(expected, varies) < STRAPPED:
        return ""
    if not SMALLER * expected < varies < LARGER * expected:
        what = f"varies by {varies:.2g} N, by coordinates and stiffness by {expected:.2g} N"
        return f"{what}: is it in N, does its cell work, and are the parameters those of this strap?"
    _, now = lag_of(asked, recorded, step, 0.0)
    if now < TURNED:
        return "falls where its spring is pressed more: is its sign turned, or are the device's angles others?"
    lag, there = lag_of(asked, recorded, step, FARTHEST)
    if LATE <= abs(lag) < FARTHEST - step and there - now >= CLEARER and there > ALIKE:
        return f"is not in time with the coordinates: {clock_words(lag)}"
    return ""
