"""The first call of a simulator on every trial: which numbers it asks for, what it gives, how long that takes."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.analyses.gap.init.simulator import FoundSimulator
from geocontact.chain.system import NotConverged, System
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.systems.validate import said

MOST_NUMBERS = 200
UNKNOWN = 1.0
"""Value of a number that nobody gave, for the first call only."""
BUMP = 0.01
"""Share of the half-range of an input by which one sample is moved."""
SPREADS = 1e-3
"""Share of the largest change of an output from which a change at another sample counts."""
FACTORS = {"180/π": 180.0 / np.pi, "1000": 1e3, "100": 100.0, "9.81": 9.80665, "4.448": 4.44822}
"""Ratios of units that are mixed up often."""
CLOSE = 0.15
"""Relative distance from such a ratio within which it is asked about."""


@dataclass(frozen=True)
class FirstRun:
    """What the first calls gave.

    Parameters
    ----------
    system
        The base model with every number that it asked for.
    unknown
        Names of numbers that it asked for and nobody gave, called with `UNKNOWN`.
    simulated
        Outputs at the start values, by trial.
    seconds
        Power of ten that no call takes longer than.
    spreads
        Whether a change of the inputs at one sample changes outputs at others.
    silent
        Inputs that change no output at any of the samples that were moved.
    """

    system: System
    unknown: tuple[str, ...]
    simulated: Mapping[str, Float[np.ndarray, "t c"]]
    seconds: float
    spreads: bool
    silent: tuple[str, ...]


def first_run(found: FoundSimulator, case: GapCase, starts: Mapping[str, float], file: str) -> FirstRun:
    """The simulator called on every trial; InputError, naming the trial, where it fails.

    Parameters
    ----------
    case
        Its trials; what it says of the base model is not used.
    starts
        Start values of numbers by name, SI units.
    file
        What was named as the simulator, for messages.
    """
    trials = (*case.calibration, *case.evaluation)
    declared = [replace(p, start=starts.get(p.name, p.start)) for p in found.declared]
    given = {p.name for p in declared}
    declared += [
        Parameter(name, found.units.get(name, ""), value) for name, value in starts.items() if name not in given
    ]
    parameters, unknown = tuple(declared), []
    for _ in range(MOST_NUMBERS):
        system = _built(found, parameters, case, file)
        name = _lacking(system, trials[0], file)
        if name is None:
            break
        if name in {p.name for p in parameters}:
            raise InputError(file, "", f"raises KeyError: {name!r} although that number is given", "correct it")
        unknown.append(name)
        parameters = (*parameters, Parameter(name, "", UNKNOWN))
    else:
        raise InputError(file, "", f"asks for more than {MOST_NUMBERS} numbers", "give PARAMETERS or `number`")
    simulated, longest = {}, 0.0
    for trial in trials:
        began = time.perf_counter()
        simulated[trial.name] = _called(system, trial, file)
        longest = max(longest, time.perf_counter() - began)
    spreads, silent = _answers(system, trials[0], simulated[trials[0].name], file)
    return FirstRun(system, tuple(unknown), simulated, decade(longest), spreads, silent)


def decade(seconds: float) -> float:
    """The next power of ten, a millisecond at the least: what is written does not depend on how busy a machine is."""
    return float(10.0 ** max(np.ceil(np.log10(max(seconds, 1e-9))), -3.0))


def _built(found: FoundSimulator, parameters: tuple[Parameter, ...], case: GapCase, file: str) -> System:
    try:
        return found.base.build(parameters, {}, case.tables)
    except (Exception, SystemExit) as error:  # the user's code may raise anything
        remedy = "give its numbers as PARAMETERS or by `number`"
        raise InputError(file, "", f"cannot be built: {said(error)}", remedy) from error


def _lacking(system: System, trial: Trial, file: str) -> str | None:
    """Name of a number that a call asks for and does not find, None where it finds all."""
    try:
        system.demand(trial, system.start)
    except (NotConverged, KeyError) as error:
        cause: BaseException | None = error
        while cause is not None and not isinstance(cause, KeyError):
            cause = cause.__cause__
        if cause is not None and cause.args and isinstance(cause.args[0], str):
            return cause.args[0]
        raise _failure(error, trial, file) from error
    except (Exception, SystemExit) as error:  # the user's code may raise anything
        raise _failure(error, trial, file) from error
    return None


def _called(system: System, trial: Trial, file: str) -> Float[np.ndarray, "t c"]:
    try:
        outputs = system.demand(trial, system.start)
    except (Exception, SystemExit) as error:  # the user's code may raise anything
        raise _failure(error, trial, file) from error
    wanted = (len(trial), len(system.outputs))
    if outputs.shape != wanted:
        raise InputError(file, "", f"gives {outputs.shape} values for trial {trial.name}", f"expected {wanted}")
    return outputs


def _failure(error: BaseException, trial: Trial, file: str) -> InputError:
    shapes = f"it got {len(trial)} times"
    remedy = f"{shapes}; correct it, or give its numbers as PARAMETERS or by `number`"
    return InputError(file, "", f"fails on trial {trial.name}: {said(error)}", remedy)


def _answers(
    system: System, trial: Trial, outputs: Float[np.ndarray, "t c"], file: str
) -> tuple[bool, tuple[str, ...]]:
    """Whether a sample of the inputs changes outputs at other samples, and which inputs change nothing.

    A sample of one input after the other is moved by `BUMP` of its half-range: where an output is largest, then at
    quarters of the trial, until an output changes: a contact may be open for most of a trial.
    """
    largest = [int(np.argmax(np.nan_to_num(np.abs(each)))) for each in outputs.T]
    places = tuple(dict.fromkeys([*largest, *(len(trial) * k // 4 for k in (2, 1, 3))]))
    spreads, silent = False, []
    for name in system.inputs:
        column = trial.signals.channels.index(name)
        half = 0.5 * float(np.ptp(trial.signals.values[:, column][np.isfinite(trial.signals.values[:, column])]))
        for at in places:
            values = trial.signals.values.copy()
            values[at, column] += BUMP * (half if half > 0.0 else 1.0)
            moved = _called(system, replace(trial, signals=replace(trial.signals, values=values)), file)
            change = np.nan_to_num(np.abs(moved - outputs)).max(axis=1)
            if change.max() > 1e-12 * max(float(np.nanmax(np.abs(outputs))), 1e-300):
                spreads = spreads or bool(np.delete(change, at).max() > SPREADS * change.max())
                break
        else:
            silent.append(name)
    return spreads, tuple(silent)


def unit_ratio(measured: Float[np.ndarray, " t"], simulated: Float[np.ndarray, " t"]) -> str:
    """In words which ratio of units lies between two curves, "" where none does: "57.3 times (180/π)".

    By their root mean squares where both are known; nothing is compared with a curve of zeros.
    """
    there = np.isfinite(measured) & np.isfinite(simulated)
    sizes = [float(np.sqrt(np.mean(each[there] ** 2))) if there.any() else 0.0 for each in (measured, simulated)]
    if min(sizes) <= 0.0:
        return ""
    ratio = sizes[1] / sizes[0]
    for words, factor in FACTORS.items():
        for each, sign in ((ratio, "times"), (1.0 / ratio, "times smaller")):
            if abs(each / factor - 1.0) < CLOSE:
                return f"{each:.3g} {sign} ({words})"
    return ""


def errors_of(
    case: GapCase, outputs: Sequence[str], simulated: Mapping[str, Float[np.ndarray, "t c"]]
) -> dict[str, dict[str, float]]:
    """Root mean square of measured minus simulated, by trial and channel [the channel's SI unit]."""
    found = {}
    for trial in (*case.calibration, *case.evaluation):
        off = np.stack([trial.column(name) for name in outputs], axis=1) - simulated[trial.name]
        with np.errstate(invalid="ignore"):
            squares = np.nansum(off**2, axis=0) / np.maximum(np.isfinite(off).sum(axis=0), 1)
        found[trial.name] = dict(zip(outputs, np.sqrt(squares).tolist(), strict=True))
    return found
