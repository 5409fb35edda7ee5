"""Who stands or sits still on plates, and who rises: force and its point beside the model's centre of mass."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.identify.signals.agreement import lag_of
from geocontact.trial_checks.plate_checks import GRAVITY
from geocontact.trial_checks.recorded import Check, Contradiction, TrialInputs

SMOOTH = 0.3
"""s, over which height and force are smoothed before their lag is sought; 0.5 mm of noise are 0.3 m/s^2 then."""
LATEST, LATE, ALIKE, CLEARER = 0.4, 0.06, 0.8, 0.03
"""s, of the lags that are looked at, and from which a clock is doubted; correlation of weight and force at that lag,
and by how much it is above that without a lag."""
STANDING, FEET, UNDER = 0.15, 100.0, 0.05
"""s to either side, N on the feet, and m between centre of pressure and the point below the centre of mass: who stands
sways by 10 mm (Winter, Gait and Posture 3, 1995), and mass centres are known to 20 mm."""
SEATED, STILL, CARRIED, RISES = 0.1, 0.05, 0.15, 0.5
"""m, twice that of who stands, thighs and trunk of a model being coarser in a chair; m/s of a mass that rests; share of
the weight that something else may carry, as an arm rest; s before the person stands."""
LEVEL = 0.1
"""Force along the floor in parts of that out of it, mean of twice `STANDING`: slowing down at 1 m/s^2."""
OFF, LONG = 0.25, 0.15
"""Share of the weight, and s for which force and weight may differ by more: a hand on a rail carries as much."""
FEWEST = 30
"""Frames of a lag."""


def _longest(there: Bool[np.ndarray, " t"]) -> Int[np.ndarray, " k"]:
    """Places of the longest run of what is there."""
    edges = np.flatnonzero(np.diff(np.r_[False, there, False].astype(int)))
    runs = [np.arange(start, stop) for start, stop in zip(edges[::2], edges[1::2], strict=True)]
    return max(runs, key=len, default=np.arange(0))


def weight_in_time(trial: TrialInputs) -> Iterator[Contradiction]:
    """Weight and acceleration of a model that rises, m (g + a), against the force of all plates."""
    moved = trial.moved
    if moved is None or trial.stands_at is None or not trial.plates or len(moved.time) < FEWEST:
        return
    time = moved.time
    step = float(np.median(np.diff(time)))
    force = np.sum([np.interp(time, on.plate.time, on.normal, np.nan, np.nan) for on in trial.plates], axis=0)
    height = smooth(moved.model.mass_centre(moved.values) @ trial.up, step)
    expected = np.gradient(np.gradient(height, step), step)
    force = smooth(force, step)
    off = force / (moved.model.mass * GRAVITY) - 1.0 - expected / GRAVITY
    other = _longest(np.abs(off) > OFF)
    on = trial.plates[0]
    if moved.model.mass > 0.0 and len(other) * step > LONG:
        names = " and ".join(each.plate.name for each in trial.plates)
        at = other[int(np.argmax(np.abs(off[other])))]
        what = f"carry {force[at]:.0f} N at {time[at]:.2f} s, weight and acceleration by {moved.source} are "
        what += f"{moved.model.mass * (GRAVITY + expected[at]):.0f} N"
        yield Contradiction(
            on.source, names, what, "is a plate missing, of a chair or a foot, or the mass another one?"
        )
    whole = slice(_half(step), -_half(step))  # beyond it nothing is known of how the person went on
    if len(time[whole]) < FEWEST:
        return
    lag, there = lag_of(expected[whole], force[whole], step, LATEST)
    _, now = lag_of(expected[whole], force[whole], step, 0.0)
    if abs(lag) >= LATE and there >= ALIKE and there - now >= CLEARER:
        when = "before" if lag > 0.0 else "after"
        what = f"the force of the plates is {abs(lag):.2f} s {when} weight and acceleration of the body"
        remedy = "plates and coordinates need one clock: shift one of them"
        yield Contradiction(on.source, on.plate.name, f"{what} by {moved.source}", remedy)


def _off_balance(trial: TrialInputs, at: float) -> tuple[Float[np.ndarray, " 3"], float, float]:
    """Centre of pressure of all plates from below the centre of mass [m], load [N] and speed of the mass [m/s] then.

    Means over `STANDING` to either side; NaN where the model or the plates have nothing there.
    """
    moved = trial.moved
    nothing = np.full(3, np.nan), np.nan, np.nan
    there = np.zeros(0, bool) if moved is None else np.abs(moved.time - at) <= STANDING
    if moved is None or there.sum() < 2:
        return nothing
    time, mass = moved.time[there], moved.model.mass_centre(moved.values[there])
    wrenches = [on.plate.at(np.clip(time, on.plate.time[0], on.plate.time[-1])) for on in trial.plates]
    force = np.nan_to_num(np.sum([np.nan_to_num(each.force) for each in wrenches], axis=0)).mean(axis=0)
    moment = np.sum([np.nan_to_num(each.moment) for each in wrenches], axis=0).mean(axis=0)
    load = float(force @ trial.up)
    if load < FEET:
        return nothing
    off = np.cross(trial.up, moment) / load - mass.mean(axis=0)
    speed = float(np.linalg.norm(mass[-1] - mass[0]) / (time[-1] - time[0]))
    return off - (off @ trial.up) * trial.up, load, speed


def balance(trial: TrialInputs) -> Iterator[Contradiction]:
    """The centre of pressure of all plates against the centre of mass, while the person stands still."""
    if trial.moved is None or trial.stands_at is None or not trial.plates:
        return
    off, _, _ = _off_balance(trial, trial.stands_at)
    if np.linalg.norm(off) > UNDER:
        on = trial.plates[0]
        what = f"its centre of pressure is {_most(off)} from below the centre of mass"
        remedy = "do plates and coordinates have one origin and the same axes?"
        yield Contradiction(on.source, on.plate.name, f"{what} while the person stands", remedy)


def seated(trial: TrialInputs) -> Iterator[Contradiction]:
    """The same before the person rises, where nothing moves and the plates carry the model's weight."""
    moved = trial.moved
    if moved is None or trial.stands_at is None or len(trial.plates) < 2 or not len(moved.time):
        return
    begin = float(moved.time[0]) + STANDING
    off, load, speed = _off_balance(trial, begin)
    carried = load / (moved.model.mass * GRAVITY) if moved.model.mass > 0.0 else np.nan
    if trial.stands_at - begin < RISES or not (speed < STILL and abs(carried - 1.0) < CARRIED):
        return
    if np.linalg.norm(off) > SEATED:
        on = trial.plates[0]
        names = " and ".join(each.plate.name for each in trial.plates)
        what = f"the centre of pressure of all plates is {_most(off)} from below the centre of mass before the rise"
        yield Contradiction(on.source, names, what, "are the places of chair and feet those of this trial, in m?")


def _most(off: Float[np.ndarray, " 3"]) -> str:
    k = int(np.argmax(np.abs(off)))
    return f"{1e3 * abs(off[k]):.0f} mm along {'xyz'[k]}"


def level(trial: TrialInputs) -> Iterator[Contradiction]:
    """Force along the floor of who stands still, which would move the person, against nothing."""
    if trial.stands_at is None or not trial.plates:
        return
    force = np.zeros(3)
    for on in trial.plates:
        there = np.abs(on.plate.time - trial.stands_at) <= STANDING
        force += np.asarray(on.plate.wrench.force[there].mean(axis=0)) if there.any() else np.nan
    load = float(force @ trial.up)
    along = force - load * trial.up
    share = float(np.linalg.norm(along)) / load if load >= FEET else np.nan
    if share > LEVEL:
        on = trial.plates[0]
        names = " and ".join(each.plate.name for each in trial.plates)
        k = int(np.argmax(np.abs(along)))
        what = f"the force along {'xyz'[k]} is {along[k]:.0f} N, {share:.0%} of that out of the floor, while the person"
        remedy = (
            "does one channel of the plate read another one's load (cross-talk), or is it not level, or not at zero?"
        )
        yield Contradiction(on.source, names, f"{what} stands", remedy)


def smooth(values: Float[np.ndarray, " t"], step: float) -> Float[np.ndarray, " t"]:
    """Mean over `SMOOTH` with the weights of a Hann window; beyond the ends what moves there goes on at its rate."""
    half = _half(step)
    weights = np.hanning(2 * half + 3)[1:-1]
    return np.convolve(np.pad(values, half, mode="reflect", reflect_type="odd"), weights / weights.sum(), "valid")


def _half(step: float) -> int:
    """Samples of half of the window."""
    return max(round(0.5 * SMOOTH / step), 1)


STILL_CHECKS = (
    Check(
        "weight in time",
        "force of all plates with weight and acceleration of the model's centre of mass, for who stands up",
        f"{OFF:.0%} of the weight for {LONG:g} s; {LATE:g} s of lag, where the correlation at it is {ALIKE:g} and "
        f"{CLEARER:g} above that without",
        weight_in_time,
    ),
    Check(
        "balance",
        "centre of pressure of all plates with the model's centre of mass, while the person stands",
        f"{1e3 * UNDER:.0f} mm, mean of {2 * STANDING:g} s; who stands sways by 10 mm (Winter 1995)",
        balance,
    ),
    Check(
        "balance before the rise",
        "centre of pressure of chair and feet with the model's centre of mass, before who stands up moves",
        f"{1e3 * SEATED:.0f} mm, mean of {2 * STANDING:g} s, where the plates carry the weight within {CARRIED:.0%}",
        seated,
    ),
    Check(
        "level",
        "force of all plates along the floor with the force out of it, while the person stands",
        f"{LEVEL:.0%}, mean of {2 * STANDING:g} s; slowing down at 1 m/s² is as much",
        level,
    ),
)
"""Checks of who stands up, or stands still."""
