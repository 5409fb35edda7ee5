"""What a case must hold to be diagnosed at all, and the order in which its trials are taken."""

from __future__ import annotations

from dataclasses import replace

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
    for site, cells in case.cells.items():
        if cells.channel not in system.outputs:
            what = f"the model does not predict {cells.channel}, which the cells of {site} add up to"
            raise _refusal(case, f"layout.{site}", what, f"outputs are {', '.join(system.outputs)}")
    return replace(
        case,
        calibration=tuple(sorted(case.calibration, key=lambda trial: _content(trial, system))),
        evaluation=tuple(sorted(case.evaluation, key=lambda trial: _content(trial, system))),
    )


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
