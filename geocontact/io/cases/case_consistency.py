"""What case.toml says, held against itself: a known system, trials on one side only, one meaning per name."""

from __future__ import annotations

import math
import re
from os import fspath
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.data.file_names import same_place
from geocontact.data.gap.case import COMMAND, LISTED_SYSTEMS
from geocontact.data.parameter import Parameter
from geocontact.io.cases.case_settings import CaseSettings, ParameterSettings

KNOWN_SYSTEMS = LISTED_SYSTEMS

_OBJECT = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*:[^\W\d]\w*")


def check_settings(settings: CaseSettings, path: Path, known_systems: tuple[str, ...] = KNOWN_SYSTEMS) -> None:
    """Refuse what contradicts itself.

    That is a system that is neither one of `known_systems` nor written `package.module:OBJECT`, a trial listed twice,
    covariates of a trial that is not listed, a covariate that is a number here and a word there, a name that is both
    constant and parameter.
    """
    file = fspath(path)
    _check_system(settings.system, known_systems, file)
    _check_program(settings, file)
    _check_trials(settings, file)
    _check_names(settings, file)


def parameters_of(settings: CaseSettings, path: Path) -> tuple[Parameter, ...]:
    """Parameters of the base model, in the order written."""
    return tuple(_parameter(name, given, fspath(path)) for name, given in settings.parameters.items())


def _parameter(name: str, given: ParameterSettings, file: str) -> Parameter:
    place = f"[parameters.{name}]"
    if not given.fixed and (given.lower is None or given.upper is None):
        lacking = "upper" if given.upper is None else "lower"
        remedy = "write lower and upper (-inf and inf where there is no bound), or fixed = true"
        raise InputError(file, place, f"no key '{lacking}'", remedy)
    lower = -math.inf if given.lower is None else given.lower
    upper = math.inf if given.upper is None else given.upper
    try:
        return Parameter(name, given.unit, given.start, lower, upper, given.fixed)
    except ValueError as error:
        raise InputError(file, place, str(error), "correct start, lower or upper") from error


def _check_system(system: str, known: tuple[str, ...], file: str) -> None:
    if system not in (*known, COMMAND) and not _OBJECT.fullmatch(system):
        own = '"package.module:OBJECT" for a system of your own, "command" for a program'
        remedy = f"known are {', '.join(known)}, and {own}"
        raise InputError(file, "system", f"{system[:80]!r} is unknown", remedy)


def _check_program(settings: CaseSettings, file: str) -> None:
    """simulate, inputs and outputs go with system = "command", and with nothing else."""
    for key in ("simulate", "inputs", "outputs"):
        given = getattr(settings, key)
        if settings.system == COMMAND and not given:
            example = 'simulate = "prog {params} {trial} {out}", inputs = ["angle"], outputs = ["torque"]'
            raise InputError(file, "", f"system command needs the key '{key}'", f"write {example}")
        if settings.system != COMMAND and given:
            raise InputError(file, key, f"does nothing for the system {settings.system}", "leave it out")
    if both := [name for name in settings.inputs if name in settings.outputs]:
        raise InputError(file, "outputs", f"{both[0]} is among the inputs too", "a channel is one or the other")


def _check_trials(settings: CaseSettings, file: str) -> None:
    for place, ids in (("calibration", settings.calibration), ("evaluation", settings.evaluation)):
        for one in ids:
            if ids.count(one) > 1:
                raise InputError(file, place, f"'{one}' is listed {ids.count(one)} times", "list each trial once")
    if both := [one for one in settings.calibration if one in settings.evaluation]:
        what = f"'{both[0]}' is listed in calibration too"
        raise InputError(file, "evaluation", what, "a held-out trial must not be one that is fitted to")
    alike = same_place(settings.trials)
    if alike is not None:
        what = f"'{alike}' differs from another trial in capitals only"
        raise InputError(file, "trials", what, "rename it: on Windows and macOS both would be one file")
    for one in settings.trial:
        if one not in settings.trials:
            remedy = f"trials are {', '.join(settings.trials[:30])}"
            raise InputError(file, f"[trial.{one}]", "neither calibration nor evaluation lists this trial", remedy)


def _check_names(settings: CaseSettings, file: str) -> None:
    """A name means one thing: no constant is a parameter, no covariate a number here and a word there."""
    if both := [name for name in settings.constants if name in settings.parameters]:
        remedy = "keep [constants], or the parameter with fixed = true"
        raise InputError(file, f"[parameters.{both[0]}]", "is in [constants] too", remedy)
    kinds: dict[str, tuple[type, str]] = {}
    for one, covariates in settings.trial.items():
        for name, value in covariates.items():
            kind, before = kinds.setdefault(name, (type(value), one))
            if type(value) is not kind:
                what = f"'{name}' is a {_kind(value)} here and a {_kind(kind())} in trial {before}"
                raise InputError(file, f"[trial.{one}]", what, "write it the same way in all trials")


def _kind(value: object) -> str:
    return "word" if isinstance(value, str) else "number"
