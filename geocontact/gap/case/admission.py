"""What a case must hold to be diagnosed at all, and the order in which its trials are taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from geocontact.chain.system import System
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.gap.levels import FEWEST


def admitted(case: GapCase, system: System) -> GapCase:
    """The case with its trials in an order that neither their names nor case.toml have a say in.

    Sums over trials and draws of random signs depend on their order, in the last digits and in those of a p-value; so
    trials are sorted by what was measured in them. InputError where too little was.
    """
    for trial in (*case.calibration, *case.evaluation):
        _require_samples(case, system, trial)
    for side, trials in (("calibration", case.calibration), ("evaluation", case.evaluation)):
        for name in system.outputs:
            count = sum(int(np.isfinite(trial.column(name)).sum()) for trial in trials)
            if count < (FEWEST if side == "calibration" else 1):
                what = f"{name} has {count} measured values in the {side} trials"
                raise _refusal(case, side, what, f"at least {FEWEST} are needed" if count else "choose other trials")
    _require_movement(case, system)
    _require_own_recordings(case, system)
    if len(case.calibration) == 1:
        what = "1 trial to fit to: how much trials differ from each other is not known"
        raise _refusal(case, "calibration", what, "list at least 2, and 2 or more to evaluate on")
    if len(case.evaluation) == 1:
        what = "1 trial held out: how much of its error is its own, and how far a gap shrinks on others, is not known"
        raise _refusal(case, "evaluation", what, "list at least 2, and 2 or more to fit to")
    for site, cells in case.cells.items():
        if cells.channel not in system.outputs:
            what = f"the model does not predict {cells.channel}, which the cells of {site} add up to"
            raise _refusal(case, f"layout.{site}", what, f"outputs are {', '.join(system.outputs)}")
    return replace(
        case,
        calibration=tuple(sorted(case.calibration, key=lambda trial: _content(trial, system))),
        evaluation=tuple(sorted(case.evaluation, key=lambda trial: _content(trial, system))),
    )


@dataclass(frozen=True)
class Repeated:
    """Two trials that hold the same values of a channel that was measured."""

    first: str
    second: str
    channel: str


def repeated(trials: Sequence[Trial], channels: Sequence[str]) -> Repeated | None:
    """The first two trials with the same values of one of these channels, sample by sample; None where all differ.

    No sensor reads the same twice. A channel that never changes says nothing.
    """
    for name in channels:
        seen: dict[bytes, str] = {}
        for trial in trials:
            values = trial.column(name)
            there = values[np.isfinite(values)]
            if not len(there) or np.ptp(there) == 0.0:
                continue
            content = np.where(np.isfinite(values), values, np.nan).tobytes()
            if content in seen:
                return Repeated(seen[content], trial.name, name)
            seen[content] = trial.name
    return None


def _require_own_recordings(case: GapCase, system: System) -> None:
    """Each trial must be a recording of its own: a copy that is held out would confirm anything."""
    same = repeated((*case.calibration, *case.evaluation), system.outputs)
    if same is not None:
        what = f"{same.channel} is the same as in trial {same.first}, sample by sample"
        raise _refusal(case, f"trial {same.second}", what, "give each trial its own recording")


def _require_samples(case: GapCase, system: System, trial: Trial) -> None:
    if len(trial) < FEWEST:
        raise _refusal(case, f"trial {trial.name}", f"{len(trial)} samples", f"at least {FEWEST} are needed")
    for name in system.inputs:
        if int(np.isfinite(trial.column(name)).sum()) < FEWEST:
            what = f"input {name} has fewer than {FEWEST} measured values"
            raise _refusal(case, f"trial {trial.name}", what, "a model cannot be driven by what was not measured")


def _require_movement(case: GapCase, system: System) -> None:
    """Something must drive the model, and every output must answer."""
    if not any(_moves(case, name) for name in system.inputs):
        what = f"no input changes in the calibration trials ({', '.join(system.inputs)})"
        raise _refusal(case, "calibration", what, "choose trials with movement")
    for name in system.outputs:
        if not _moves(case, name):
            what = f"{name} never changes in the calibration trials"
            raise _refusal(case, "calibration", what, "was the sensor on? delete the column or choose other trials")


def _moves(case: GapCase, name: str) -> bool:
    values = np.concatenate([trial.column(name) for trial in case.calibration])
    there = values[np.isfinite(values)]
    return bool(np.ptp(there) > 0.0)


def _content(trial: Trial, system: System) -> tuple[float, ...]:
    """Length, duration and sums of squares of a trial, rounded so that a conversion of units changes nothing."""
    squares = [float(np.nansum(trial.column(name) ** 2)) for name in (*system.inputs, *system.outputs)]
    return (float(len(trial)), *(float(f"{value:.9g}") for value in (trial.time[-1] - trial.time[0], *squares)))


def _refusal(case: GapCase, place: str, what: str, remedy: str) -> InputError:
    return InputError(f"{case.name}/case.toml", place, what, remedy)
