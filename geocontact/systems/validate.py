"""Whether a base model and the trials of a case suit each other: channels, units, numbers; one run on every trial."""

from __future__ import annotations

from geocontact.chain.system import System
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial

LONGEST = 300
"""Characters that are shown of an error in somebody's code."""


def validated(system: System, case: GapCase) -> System:
    """The same system, after every trial was found to have its channels in its units, and was simulated once."""
    for trial in (*case.calibration, *case.evaluation):
        _require_channels(system, trial, case)
    for trial in (*case.calibration, *case.evaluation):
        _try_out(system, trial, case)
    return system


def _require_channels(system: System, trial: Trial, case: GapCase) -> None:
    for channel in (*system.inputs, *system.outputs):
        if channel not in trial.signals.channels:
            has = ", ".join(trial.signals.channels)
            raise refusal(case, f"needs channel {channel}, which trial {trial.name} lacks", f"it has {has}")
        unit = trial.signals.units[trial.signals.channels.index(channel)]
        if unit and system.unit(channel) not in ("-", unit):
            what = f"needs {channel} in {system.unit(channel)}, trial {trial.name} gives {unit}"
            raise refusal(case, what, "correct the unit in the header")


def _try_out(system: System, trial: Trial, case: GapCase) -> None:
    """One simulation at the starting values: what is missing or of a wrong shape shows here."""
    try:
        outputs = system.demand(trial, system.start)
    except KeyError as error:
        remedy = f"give it under [constants], [parameters.{error.args[0]}] or [trial.{trial.name}]"
        raise refusal(case, f"needs the number {error.args[0]} in trial {trial.name}", remedy) from error
    except Exception as error:  # the user's code may raise anything
        raise refusal(case, f"fails on trial {trial.name}: {said(error)}", "correct the case or the model") from error
    if outputs.shape != (len(trial), len(system.outputs)):
        what = f"gives {outputs.shape} values for trial {trial.name}"
        raise refusal(case, what, f"expected {(len(trial), len(system.outputs))}, samples by outputs")


def said(error: BaseException) -> str:
    """Kind and first words of what somebody's code raised."""
    words = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return words if len(words) <= LONGEST else f"{words[:LONGEST]} …"


def refusal(case: GapCase, what: str, remedy: str) -> InputError:
    """One line that names the case and its system."""
    return InputError(f"{case.name}/case.toml", f"system {case.system}", what, remedy)
