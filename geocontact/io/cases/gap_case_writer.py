"""A gap case into a folder: what `read_gap_case` reads back, to the digits printed."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from os import PathLike
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.data.gap_case import GapCase
from geocontact.data.gap_cells import CellChannels
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.io.cases.case_settings import SETTINGS, TRIALS
from geocontact.io.cases.trial_table import AREA, PLACE, cells_file, channel_name
from geocontact.io.text.results import with_microseconds
from geocontact.io.text.units import si_unit

DIGITS = 9
_BARE = re.compile(r"[A-Za-z0-9_-]+")


def write_gap_case(
    case: GapCase, folder: str | PathLike[str], units: Mapping[str, str] | None = None, digits: int = DIGITS
) -> None:
    """Write case.toml, trials/<id>.csv, cells and tables; nothing in them depends on the name of the case.

    Parameters
    ----------
    case
        SI units; every channel's unit must be given.
    folder
        Made if it is not there.
    units
        Other units for some channels, of the same dimension; their noise is converted with them.
    digits
        Significant ones of a cell. Numbers in case.toml and in the tables are written in full.
    """
    if case.meshes:
        raise ValueError("a case with meshes is not written: its surfaces belong to files, which it does not know")
    home, wanted = Path(folder), units or {}
    write_trials(case, home, wanted, digits)
    write_tables(case, home)
    for site, cells in case.cells.items():
        _write_cells(home, site, cells, digits)
    (home / SETTINGS).write_text("\n".join(_settings(case, wanted)) + "\n", encoding="utf-8", newline="\n")


def write_trials(case: GapCase, home: Path, units: Mapping[str, str] | None = None, digits: int = DIGITS) -> None:
    """Write trials/<id>.csv only, over those that are there."""
    (home / TRIALS).mkdir(parents=True, exist_ok=True)
    for trial in (*case.calibration, *case.evaluation):
        table = with_microseconds(trial_table(trial, units), digits)
        file = home / TRIALS / f"{trial.name}.csv"
        table.to_csv(file, index=False, float_format=f"%.{digits}g", lineterminator="\n")


def write_tables(case: GapCase, home: Path) -> None:
    """Write the tables only, <key>.csv."""
    for key, table in case.tables.items():
        table.to_csv(home / file_of(key), index=False, lineterminator="\n")


def file_of(key: str) -> str:
    """File name of a table."""
    return f"{key}.csv"


def _write_cells(home: Path, site: str, cells: CellChannels, digits: int) -> None:
    places = {name: cells.place[:, k] for k, name in enumerate(PLACE)}
    layout = pd.DataFrame({"id": cells.ids, **places, AREA: cells.area})
    layout.to_csv(home / _layout_file(site), index=False, lineterminator="\n")
    names = [f"{channel_name(each)} [Pa]" for each in cells.ids]
    for trial, own in cells.trials.items():
        table = pd.DataFrame(own.pressure, columns=names)
        table.insert(0, "time [s]", own.time)
        file = cells_file(home, trial, site)
        with_microseconds(table, digits).to_csv(file, index=False, float_format=f"%.{digits}g", lineterminator="\n")


def _layout_file(site: str) -> str:
    return f"{site}_layout.csv"


def trial_table(trial: Trial, units: Mapping[str, str] | None = None) -> pd.DataFrame:
    """`time [s]` and a column per channel, in SI units or in those that are given."""
    columns: dict[str, np.ndarray] = {"time [s]": trial.time}
    for name, si in zip(trial.signals.channels, trial.signals.units, strict=True):
        unit = (units or {}).get(name, si)
        columns[f"{name} [{unit}]"] = trial.column(name) / _per_unit(name, si, unit)
    return pd.DataFrame(columns)


def _per_unit(name: str, si: str, unit: str) -> float:
    """How many SI units one `unit` is."""
    known = si_unit(unit)
    if known is None or known[0] != si:
        raise ValueError(f"channel {name} is in {si!r}, which is not written as {unit!r}")
    return known[1]


def _settings(case: GapCase, units: Mapping[str, str]) -> Iterator[str]:
    """Lines of case.toml."""
    yield "format = 1"
    yield f"system = {_word(case.system)}"
    yield f"calibration = {_words(case.calibration)}"
    yield f"evaluation = {_words(case.evaluation)}"
    for key in case.tables:
        yield f"{toml_key(key)} = {_word(file_of(key))}"
    yield from _section("layout", {site: _word(_layout_file(site)) for site in case.cells})
    si = dict(zip(case.calibration[0].signals.channels, case.calibration[0].signals.units, strict=True))
    noise = {name: sd / _per_unit(name, si[name], units.get(name, si[name])) for name, sd in case.noise.items()}
    yield from _section("noise", {name: repr(float(sd)) for name, sd in noise.items()})
    yield from _section("constants", {name: repr(float(value)) for name, value in case.constants.items()})
    for parameter in case.parameters:
        yield from _section(f"parameters.{toml_key(parameter.name)}", _parameter(parameter))
    for trial in (*case.calibration, *case.evaluation):
        numbers = {name: repr(float(value)) for name, value in trial.covariates.items()}
        yield from _section(f"trial.{toml_key(trial.name)}", numbers | {k: _word(v) for k, v in trial.labels.items()})


def _parameter(p: Parameter) -> dict[str, str]:
    numbers = {key: repr(float(value)) for key, value in (("start", p.start), ("lower", p.lower), ("upper", p.upper))}
    return numbers | {"unit": _word(p.unit)} | ({"fixed": "true"} if p.fixed else {})


def _section(name: str, lines: Mapping[str, str]) -> Iterator[str]:
    if lines:
        yield ""
        yield f"[{name}]"
        yield from (f"{toml_key(key)} = {value}" for key, value in lines.items())


def toml_key(name: str) -> str:
    """A name as a key of TOML, in quotes where it needs them."""
    return name if _BARE.fullmatch(name) else _word(name)


def _word(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _words(trials: tuple[Trial, ...]) -> str:
    return f"[{', '.join(_word(trial.name) for trial in trials)}]"
