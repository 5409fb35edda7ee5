"""Forces on a person who stands up from plates: when the chair is left, its load, and force and centre under the feet.

The ground is y = 0, x points forwards and y up; what is below is in InputErrors without a file, which whoever reads the
plates adds.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.wrench import Wrench
from geocontact.identify.signals.filters import UNEVEN, zero_lag

SEATED = 5.0
"""Force on the chair from which on one sits [N], the study's."""
BRIEF = 0.1
"""Time [s] in which a load on the chair, or its absence, counts where it takes up more than half; invented."""
CHAIR_CUTOFF = 10.0
"""Cut-off of the chair's force [Hz], ours: the load is given, so that a motion would have to follow its noise."""
STANDING = 20.0
"""Least force up on both feet [N] at which their centre of pressure can be found."""
BESIDE = 0.5
"""Farther from the ankle than that [m] a centre of pressure is not under the foot."""

Times = Float[np.ndarray, " t"]
Table = Float[np.ndarray, "t c"]


def steady(time: Times, force: Times) -> Times:
    """Running median of the chair's force over `BRIEF` [N]: without single samples of noise, its falls where they were.

    NaN counts as none.

    Parameters
    ----------
    force
        Normal force on the chair, without a sign [N].
    """
    from scipy.ndimage import median_filter

    half = int(0.5 * BRIEF / float(np.median(np.diff(time))))
    return np.asarray(median_filter(np.nan_to_num(force), 2 * half + 1, mode="reflect"))


def seat_off(time: Times, force: Times) -> float:
    """When the chair's force falls below `SEATED` for good [s]; InputError where it never does or never was above.

    Parameters
    ----------
    force
        Normal force on the chair, without a sign [N].
    """
    seated = np.flatnonzero(force >= SEATED)
    if not len(seated):
        what = f"seat-off not found: its force is never {SEATED:g} N"
        raise InputError("", "", what, "check that this is the chair's plate, or give start")
    if seated[-1] == len(force) - 1:
        what = f"seat-off not found: its force is {force[-1]:.3g} N to the end"
        raise InputError("", "", what, "check that the plate was set to zero, or give start")
    return float(time[seated[-1] + 1])


def seat_contact(time: Times, force: Times) -> float:
    """When the chair's force rises to `SEATED` and stays there [s]; InputError where somebody sits from the start, or
    never.

    Parameters
    ----------
    force
        Normal force on the chair, without a sign [N].
    """
    free = np.flatnonzero(force < SEATED)
    if not len(free):
        what = f"seat contact not found: its force is at least {force.min():.3g} N all along"
        raise InputError("", "", what, "check that the plate was set to zero, or give end")
    if free[-1] == len(force) - 1:
        what = f"seat contact not found: its force is {force[-1]:.3g} N at the end"
        raise InputError("", "", what, "check that this is the chair's plate, or give end")
    return float(time[free[-1] + 1])


def chair_load(wrench: Wrench, time: Times) -> Table:
    """Force forwards and up [N] and moment about the ground's origin [N m] on the person, low-passed, (t, 3).

    300 N that are let go within 0.3 s from the first sample on are off by 1 N at most for it. InputError for times that
    are not even, or too far apart for the filter.

    Parameters
    ----------
    wrench
        Of the chair at these times, about the ground's origin; NaN counts as none.
    """
    load = np.nan_to_num(np.column_stack([wrench.force[:, :2], wrench.moment[:, 2]]))
    step, remedy = float(np.median(np.diff(time))), "resample the coordinates evenly, at 50 Hz or more"
    if np.abs(np.diff(time) - step).max() > 2.0 * UNEVEN * step:
        raise InputError("", "", "is wanted at times that are not even, as a filter needs them", remedy)
    try:
        return zero_lag(load, step, CHAIR_CUTOFF)
    except ValueError as error:
        raise InputError("", "", str(error), remedy) from error


def under_the_feet(wrench: Wrench, time: Times, ankle: Times) -> tuple[Table, Times]:
    """Force forwards and up [N], and the centre of pressure on the ground y = 0 [m].

    InputError where the plate has gaps, is left, or is not under the ankle.

    Parameters
    ----------
    wrench
        Of the ground on both feet at these times, about the ground's origin.
    ankle
        Place of the ankle forwards [m].
    """
    force = wrench.force[:, :2]
    if not np.isfinite(wrench.force).all() or not np.isfinite(wrench.moment[:, 2]).all():
        raise InputError("", "", "has gaps within the trial", "fill them or cut the trial by start and end")
    if force[:, 1].min() < STANDING:
        what = f"carries {force[:, 1].min():.3g} N at {time[int(np.argmin(force[:, 1]))]:g} s"
        raise InputError("", "", what, "the feet must stand on it throughout; check that it is theirs")
    centre = wrench.moment[:, 2] / force[:, 1]
    away = float(np.median(centre - ankle))
    if abs(away) > BESIDE:
        what = f"its centre of pressure is {away:.2f} m ahead of the ankle"
        raise InputError("", "", what, "plates and coordinates must have one origin, x forwards, y up")
    return force, centre
