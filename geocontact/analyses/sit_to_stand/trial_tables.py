"""Tables of trials: channels as recorded and by the model, certificates of motions, numbers and meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.dynamics.collocation.certificate import Certificate
from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.collocation.solve import MOST_HALVINGS
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit, of_residual
from geocontact.standing_up.chain import COORDINATES
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.numbers_that_ran import Ran
from geocontact.standing_up.phase import JudgedMotion
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingNoise, StandingTrial

SHEAR = "shear"
"""Channel that is never tracked: the strap's shear is predicted and compared where it was measured."""
DEGREE, MILLIMETRE = float(np.degrees(1.0)), 1e3
BEYOND = (
    "after an interval [-]",
    "after 0.2 s [-]",
    "open loop [-]",
    "open loop bound [-]",
    "growth rate [1/s]",
    "intervals [-]",
    "shortest interval [s]",
)
"""Departures of coordinates from another integrator [rad, m], the growth of deviations, and the mesh."""
Meshes = Sequence[tuple[str, Sequence[CollocatedMotion]]]
"""Motions by the name of their phase, predictor or design."""


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
        Standard deviation that was stated, in SI.
    """

    channel: str
    name: str
    unit: str
    factor: float
    recorded: Float[np.ndarray, " t"]
    model: Float[np.ndarray, " t"]
    noise: float


def channels(seen: StandingTrial, model: StandingTrial, noise: StandingNoise) -> list[StandingChannel]:
    """Columns of a trial as recorded and by a model, in the order of tables; NaN for what was not recorded."""
    found = []
    names = (*COORDINATES, *EXO_JOINTS)[: model.q.shape[1]]
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
    if seen.shear is not None:
        shear = none if model.shear is None else model.shear
        found.append(StandingChannel(SHEAR, "strap shear", "N", 1.0, seen.shear, shear, noise.shear))
    return found


def errors_table(trials: Sequence[TrialResult], noise: StandingNoise, tracks: Sequence[str]) -> pd.DataFrame:
    """Root mean square difference of each channel, with the noise that it was said to have beside it."""
    rows = [
        {
            "trial": trial.recorded.name,
            "quantity": each.name,
            "unit": each.unit,
            "rmsd": each.factor * float(np.sqrt(np.mean((each.model - each.recorded) ** 2))),
            "noise": each.factor * each.noise,
        }
        for trial in trials
        for each in channels(trial.recorded, trial.model, noise)
        if (each.channel in tracks or each.channel == SHEAR) and np.isfinite(each.recorded).all()
    ]
    return pd.DataFrame(rows, columns=["trial", "quantity", "unit", "rmsd", "noise"])


def goodness_of_trials(trials: Sequence[TrialResult], noise: StandingNoise, tracks: Sequence[str]) -> GoodnessOfFit:
    """Every channel that is tracked, against the noise that was stated for it."""
    doubts: list[Doubt] = []
    tested = []
    for trial in trials:
        for each in channels(trial.recorded, trial.model, noise):
            if each.channel not in tracks or not np.isfinite(each.recorded).all():
                continue
            name = f"{trial.recorded.name} {each.name}"
            residual = each.factor * (each.recorded - each.model)
            doubts += of_residual(name, each.unit, residual, each.factor * each.noise)
            tested.append(name)
    return GoodnessOfFit(tuple(doubts), tuple(tested))


def certificate_rows(phase: str, names: Sequence[str], motions: Sequence[JudgedMotion]) -> list[dict[str, object]]:
    """What lies between and beyond the points of each motion; empty cells where nothing was certified."""
    rows = []
    for name, seen in zip(names, motions, strict=True):
        c = seen.certificate
        told: dict[str, object] = {"phase": phase, "trial": name}
        told["certified"] = "no" if c is None or not c.converged else "yes"
        told |= {"residual [N]": float(seen.force.max()), "residual [N m]": float(seen.moment.max())}
        sizes: tuple[float, ...] = (np.nan,) * len(BEYOND)
        if c is not None:
            sizes = c.interval, c.window, c.open_loop, c.bound, c.growth_rate, c.intervals, c.shortest
        rows.append(told | dict(zip(BEYOND, sizes, strict=True)))
    return rows


def trial_table(trial: TrialResult, noise: StandingNoise, tracks: Sequence[str]) -> pd.DataFrame:
    """Over time: channels as recorded and by the model, torques of both legs, residual."""
    columns = {"time [s]": trial.recorded.time}
    for each in channels(trial.recorded, trial.model, noise):
        if each.channel == "rates":
            continue
        columns[f"{each.name} [{each.unit}]"] = each.factor * each.model
        if (each.channel in tracks or each.channel == SHEAR) and np.isfinite(each.recorded).all():
            columns[f"recorded {each.name} [{each.unit}]"] = each.factor * each.recorded
    columns["residual [N]"] = trial.residual(trial.judged.force)
    columns["residual [N m]"] = trial.residual(trial.judged.moment)
    return pd.DataFrame(columns)


def ran_table(rows: Sequence[Ran]) -> pd.DataFrame:
    """Every number in SI, and where it is from."""
    return pd.DataFrame(rows, columns=list(Ran._fields))


def mesh_table(of: str, meshes: Meshes) -> pd.DataFrame:
    """Ends of the intervals, from the start of each motion to its end; `of` is what the motions are named by."""
    rows = [(name, motion.name, float(at)) for name, motions in meshes for motion in motions for at in motion.breaks]
    return pd.DataFrame(rows, columns=[of, "trial", "break [s]"])


def not_certified(place: str, seen: Certificate) -> str:
    """What failed, and how fine the mesh is that was refined as often as it may be."""
    mesh = f"{seen.intervals} intervals down to {1e3 * seen.shortest:.2g} ms, each halved {MOST_HALVINGS} times at most"
    return f"{place} is not certified: {'; '.join(seen.failed)}; on {mesh}; give more `nodes`"
