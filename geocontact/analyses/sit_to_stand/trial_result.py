"""One trial as it was recorded and as the model moves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.chain import COORDINATES
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.judged import JudgedMotion
from geocontact.standing_up.trials import StandingNoise, StandingTrial

DEGREE, MILLIMETRE = float(np.degrees(1.0)), 1e3


@dataclass(frozen=True, kw_only=True, eq=False)
class TrialResult:
    """One trial.

    Parameters
    ----------
    recorded, model
        Channels at the same times; torques of the model are those of both legs.
    points
        Channels of the model at `CollocatedMotion.held_times`, where the equations hold.
    acceleration
        Of the coordinates there [m/s^2, rad/s^2].
    judged
        Certificate, and residual between the points.
    """

    recorded: StandingTrial
    model: StandingTrial
    points: StandingTrial
    acceleration: Float[np.ndarray, "t n"]
    judged: JudgedMotion

    def residual(self, of: Float[np.ndarray, " f"]) -> Float[np.ndarray, " t"]:
        """Largest of a residual of `judged` nearest to each time of the recording."""
        time = self.recorded.time
        edges = np.r_[-np.inf, 0.5 * (time[:-1] + time[1:]), np.inf]
        place = np.searchsorted(edges, self.judged.time, "right") - 1
        largest = np.zeros(len(time))
        np.maximum.at(largest, place, of)
        return largest


@dataclass(frozen=True, eq=False)
class StandingChannel:
    """One column of a trial, as recorded and by the model.

    Parameters
    ----------
    channel
        Name of what is tracked that it belongs to.
    name, unit, factor
        As tables call it; the factor turns SI into the unit.
    noise
        Standard deviation that was told, in SI.
    """

    channel: str
    name: str
    unit: str
    factor: float
    recorded: Float[np.ndarray, " t"]
    model: Float[np.ndarray, " t"]
    noise: float


def channels(seen: StandingTrial, model: StandingTrial, noise: StandingNoise) -> list[StandingChannel]:
    """Of a trial as recorded and by a model, in the order of tables; what was not recorded is not a number there."""
    found = []
    names = (*COORDINATES, *(EXO_JOINTS if model.q.shape[1] > len(COORDINATES) else ()))
    for k, name in enumerate(names):
        turns = k > 1
        unit, factor, size = ("deg", DEGREE, noise.angle) if turns else ("mm", MILLIMETRE, noise.length)
        found.append(StandingChannel("coordinates", name, unit, factor, seen.q[:, k], model.q[:, k], size))
    for k, name in enumerate(names):
        unit, factor = ("deg/s", DEGREE) if k > 1 else ("mm/s", MILLIMETRE)
        found.append(StandingChannel("rates", f"{name} rate", unit, factor, seen.u[:, k], model.u[:, k], noise.rate))
    for k, axis in enumerate("xy"):
        of = seen.force[:, k], model.force[:, k]
        found.append(StandingChannel("force", f"force_{axis}", "N", 1.0, *of, noise.force))
    found.append(StandingChannel("centre", "centre", "mm", MILLIMETRE, seen.centre, model.centre, noise.centre))
    none = np.full(len(seen.time), np.nan)
    if model.torque is not None:
        for k, name in enumerate(names[3:]):
            told = none if seen.torque is None else seen.torque[:, k]
            of = told, model.torque[:, k]
            found.append(StandingChannel("torque", f"{name} torque", "N m", 1.0, *of, noise.torque))
    if model.strap is not None:
        told = none if seen.strap is None else seen.strap
        found.append(StandingChannel("strap", "strap", "N", 1.0, told, model.strap, noise.strap))
    for site, force in model.elsewhere.items():
        told = seen.elsewhere.get(site, none)
        found.append(StandingChannel("strap", f"{site} strap", "N", 1.0, told, force, noise.strap))
    return found
