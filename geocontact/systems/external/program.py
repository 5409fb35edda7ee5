"""A simulator that is not ours as a base model: `system = "command"`, a program that is started for every run."""

from __future__ import annotations

from geocontact.chain.system import System
from geocontact.data.gap.case import GapCase
from geocontact.systems.external.simulator import simulated_system
from geocontact.systems.validate import refusal


def program_system(case: GapCase) -> System:
    """The base model; InputError when the case brings no simulator."""
    own = case.simulator
    if own is None:
        raise refusal(case, "has no simulator", 'give simulate = "prog {params} {trial} {out}"')
    trials = (*case.calibration, *case.evaluation)
    covariates = dict.fromkeys(name for trial in trials for name in trial.covariates)
    names = (*(p.name for p in case.parameters), *case.constants, *covariates)
    return simulated_system("command", own, tuple(dict.fromkeys(names)), case.parameters, case.constants)
