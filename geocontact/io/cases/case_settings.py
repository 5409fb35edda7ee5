"""case.toml and its folder: keys, files, and what they say held against itself."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, FiniteFloat, PlainValidator, ValidationError

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.gap_case import COMMAND, LISTED_SYSTEMS
from geocontact.data.parameter import Parameter
from geocontact.data.text import cannot_be_named, same_place
from geocontact.io.text.csv_text import LONGEST_NAME
from geocontact.io.text.file_preflight import regular_file
from geocontact.io.text.tables import listed
from geocontact.io.text.toml_text import toml_of

SETTINGS = "case.toml"
TRIALS = "trials"

MOST_BYTES = 512_000_000
"""Bytes of all trials of a case together, at the most."""


def case_folder(folder: str | PathLike[str]) -> Path:
    """The folder as a path, refused when it is none."""
    home = Path(folder)
    try:
        exists, is_folder = home.exists(), home.is_dir()
    except (OSError, ValueError) as error:  # a path that is too long, locked, or holds a NUL
        raise InputError(folder, "", f"cannot be opened: {error}", "check the path") from error
    if not is_folder:
        what = "is not a folder" if exists else "there is no such folder"
        raise InputError(folder, "", what, f"name the folder that holds {SETTINGS}")
    return home


def inside(home: Path, name: str, key: str, endings: tuple[str, ...] = (".csv",)) -> Path:
    """The file that case.toml names, inside the case's folder."""
    parts = Path(name).parts
    usable = name.isprintable() and not any(sign in name for sign in '\\:*?"<>|')
    if not usable or Path(name).is_absolute() or ".." in parts or not name.lower().endswith(endings):
        example = 'spheres = "spheres.csv"' if ".csv" in endings else 'file = "insert.stl"'
        remedy = f"name a {' '.join(endings)} file inside the folder of the case, as in {example}"
        raise InputError(home / SETTINGS, key, f"{name[:80]!r} cannot be used", remedy)
    path = home / name
    try:
        contained = path.resolve().is_relative_to(home.resolve())
    except (OSError, RuntimeError):  # links that lead in a circle
        contained = False
    if not contained:
        what = f"{name[:80]!r} leads out of the folder of the case"
        raise InputError(home / SETTINGS, key, what, "copy the file there")
    return path


def trial_file(home: Path, name: str) -> Path:
    """Where the trial of that id is."""
    return home / TRIALS / f"{name}.csv"


def check_trial_files(home: Path, settings: CaseSettings) -> None:
    """Every listed trial has a file, together of a size that can be read; others are warned of."""
    folder = home / TRIALS
    if not folder.is_dir():
        raise InputError(home, "", f"no folder '{TRIALS}' in it", f"put the trials there, as {TRIALS}/<id>.csv")
    try:
        present = {entry.stem: entry for entry in sorted(folder.iterdir()) if entry.suffix == ".csv"}
        size = sum(regular_file(present[name]) for name in settings.trials if name in present)
    except OSError as error:
        raise InputError(folder, "", f"cannot be read: {error.strerror or error}", "check its permissions") from error
    for place, ids in (("calibration", settings.calibration), ("evaluation", settings.evaluation)):
        for name in ids:
            if name not in present:
                remedy = f"delete it or add the file; there are {listed(tuple(present))}"
                raise InputError(home / SETTINGS, place, f"no file {TRIALS}/{name}.csv", remedy)
    if size > MOST_BYTES:
        what = f"the trials have {size / 1e6:.0f} MB, more than the {MOST_BYTES / 1e6:.0f} MB that are read"
        raise InputError(folder, "", what, "resample them or list fewer")
    _warn_of_idle(folder, tuple(present), settings)


def _warn_of_idle(folder: Path, present: tuple[str, ...], settings: CaseSettings) -> None:
    cells = {f"{name}_{site}_cells" for name in settings.trials for site in settings.layout}
    idle = tuple(f"{name}.csv" for name in present if name not in settings.trials and name not in cells)
    if idle:
        message = f"{fspath(folder)}: not listed in {SETTINGS} and not used: {listed(idle)}"
        warnings.warn(InputWarning(message), stacklevel=4)


LARGEST_SETTINGS = 1_000_000
"""Bytes of case.toml."""

MOST_TRIALS = 1000
"""Trials of either kind, at the most."""

_FILE_NAME = re.compile(r"\w([\w .+-]*[\w+-])?")


def _name(text: str) -> str:
    if not text.isprintable() or not text.strip() or text != text.strip() or len(text) > LONGEST_NAME:
        raise ValueError(f"expected a name of printable characters, at most {LONGEST_NAME}")
    return text


def _file_name(text: str) -> str:
    """A name that can be part of a file's, on every system, and that leads nowhere else."""
    if not _FILE_NAME.fullmatch(text) or cannot_be_named(text) or ".." in text or len(text) > LONGEST_NAME:
        raise ValueError("expected letters, digits, blanks or any of _ . + - (no path), as in t01")
    return text


def _number_or_word(value: object) -> float | str:
    if isinstance(value, str):
        return _name(value)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError('expected a finite number or a word in quotes, as in level = 0.5 or condition = "locked"')
    return float(value)


Name = Annotated[str, AfterValidator(_name)]
FileName = Annotated[str, AfterValidator(_file_name)]
Covariate = Annotated[float | str, PlainValidator(_number_or_word)]
Trials = Annotated[tuple[FileName, ...], Field(min_length=1, max_length=MOST_TRIALS, strict=False)]


class ParameterSettings(BaseModel):
    """`[parameters.<name>]`; the unit is a label."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    start: FiniteFloat
    lower: float | None = None
    upper: float | None = None
    unit: str = ""
    fixed: bool = False


class MeshSettings(BaseModel):
    """`[mesh.<name>]`: a file inside the folder of the case, its unit, and which faces count ("" for all)."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    file: str
    unit: Literal["m", "cm", "mm", "in"]
    region: str = ""


class CaseSettings(BaseModel):
    """case.toml, with the tables that it names gathered in `tables`."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    format: int
    system: str
    calibration: Trials
    evaluation: Trials
    noise: dict[Name, FiniteFloat] = {}
    constants: dict[Name, FiniteFloat] = {}
    parameters: dict[Name, ParameterSettings] = {}
    trial: dict[FileName, dict[Name, Covariate]] = {}
    layout: dict[FileName, str] = {}
    simulate: str = ""
    inputs: Annotated[tuple[Name, ...], Field(strict=False)] = ()
    outputs: Annotated[tuple[Name, ...], Field(strict=False)] = ()
    mesh: dict[Name, MeshSettings] = {}
    tables: dict[Name, str] = {}

    @property
    def trials(self) -> tuple[str, ...]:
        """Every trial's id, those for calibration first."""
        return (*self.calibration, *self.evaluation)


def read_settings(path: Path) -> CaseSettings:
    """Content of a case.toml of format 1; keys that are not known and values of another type are refused."""
    return settings_of(toml_of(path, LARGEST_SETTINGS), fspath(path))


def settings_of(given: Mapping[str, Any], file: str) -> CaseSettings:
    """The same of what such a file holds."""
    version = given.get("format", "missing")
    if type(version) is not int or version != 1:
        raise InputError(file, "format", f"is {version!r:.40}", "write format = 1, the one that is read here")
    try:
        return CaseSettings.model_validate(_tables_gathered(given))
    except ValidationError as error:
        raise _refusal(error, file) from error


def _tables_gathered(given: Mapping[str, Any]) -> dict[str, Any]:
    """Top-level keys that name a .csv file, moved into `tables`; a key `tables` of the file itself is unknown."""
    fields = set(CaseSettings.model_fields) - {"tables"}
    tables = {
        key: value
        for key, value in given.items()
        if key not in fields and isinstance(value, str) and value.lower().endswith(".csv")
    }
    rest = {f"{key} " if key == "tables" else key: value for key, value in given.items() if key not in tables}
    return {**rest, "tables": tables}


def _refusal(error: ValidationError, file: str) -> InputError:
    """One line for the first thing that is wrong; an unknown key comes before what it may have been meant as."""
    first, *_ = sorted(error.errors(), key=lambda found: found["type"] != "extra_forbidden")
    place = [str(part) for part in first["loc"] if part != "[key]"]
    key = place.pop().strip() if first["type"] in ("extra_forbidden", "missing") else ""
    where = ".".join(place)
    known = CaseSettings if not place else MeshSettings if place[0] == "mesh" else ParameterSettings
    keys = ", ".join(name for name in known.model_fields if name != "tables")
    if first["type"] == "extra_forbidden":
        more = ', or name a table: spheres = "spheres.csv"' if not place else ""
        return InputError(file, where, f"unknown key {key[:80]!r}", f"keys here are {keys}{more}")
    if first["type"] == "missing":
        return InputError(file, where, f"no key '{key}'", f"keys here are {keys}")
    reason = first["msg"].removeprefix("Value error, ")
    return InputError(file, where, f"is {first['input']!r:.60}", reason[0].lower() + reason[1:])


KNOWN_SYSTEMS = LISTED_SYSTEMS

_OBJECT = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*:[^\W\d]\w*")


def check_settings(settings: CaseSettings, path: Path, known_systems: tuple[str, ...] = KNOWN_SYSTEMS) -> None:
    """Refuse what contradicts itself.

    That is a system that is neither one of `known_systems` nor written `package.module:OBJECT`, a trial listed twice,
    covariates of a trial that is not listed, a covariate that is a number here and a word there, a name that is both
    constant and parameter, negative noise.
    """
    file = fspath(path)
    _check_system(settings.system, known_systems, file)
    _check_program(settings, file)
    _check_trials(settings, file)
    _check_names(settings, file)
    for channel, sd in settings.noise.items():
        if sd < 0.0:
            raise InputError(file, f"[noise] {channel}", f"is {sd:g}", "a standard deviation is positive")


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
        remedy = f"write one of {', '.join(known)}, and {own}"
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
