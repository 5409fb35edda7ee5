"""Files of a gap case that is made step by step, read and written in a process of their own."""

from __future__ import annotations

import json
import os
import shutil
import sys
import warnings
from collections.abc import Mapping, Sequence
from contextlib import suppress
from importlib.machinery import PathFinder
from itertools import count
from pathlib import Path
from typing import Any

from geocontact.app.files import answer_of
from geocontact.data.errors import InputError
from geocontact.data.text import same_place

Row = Mapping[str, str]
"""A column of the recordings as it was chosen: column, channel, unit."""


def columns_of(files: Sequence[Path]) -> tuple[list[tuple[str, str]], list[str]]:
    """Columns of the first file with their units, and what is wrong with any of the files or doubtful about it."""
    found, wrong = answer_of(__name__, {"task": "columns", "files": list(map(str, files))})
    if found is None:
        return [], [wrong]
    return [(name, unit) for name, unit in found["columns"]], found["said"]


def write_trials(files: Sequence[Path], rows: Sequence[Row], folder: Path) -> list[str]:
    """Write a trial for each file into `folder`, which is there; why not, empty where they are written."""
    asked = {"task": "trials", "files": list(map(str, files)), "rows": list(map(dict, rows)), "folder": str(folder)}
    found, wrong = answer_of(__name__, asked)
    return [wrong] if found is None else found["said"]


def numbers_of(model: str, channels: Sequence[str], tables: Mapping[str, str]) -> tuple[dict[str, str], str]:
    """Numbers that a model of the package needs with their SI units, or why that is not known."""
    found, wrong = answer_of(__name__, {"task": "numbers", "model": model, "channels": channels, "tables": tables})
    return ({}, wrong) if found is None else (found.get("numbers", {}), "; ".join(found["said"]))


def settings_of(folder: Path) -> tuple[dict[str, Any], str]:
    """What case.toml of a begun case says, or why it cannot be read."""
    found, wrong = answer_of(__name__, {"task": "settings", "folder": str(folder)})
    return ({}, wrong) if found is None else (found.get("settings", {}), "; ".join(found["said"]))


def answer_questions(folder: Path, answers: Mapping[str, Any]) -> str:
    """Write answers into a case that was begun; why not, "" where they are written."""
    found, wrong = answer_of(__name__, {"task": "answers", "folder": str(folder), **answers})
    return wrong if found is None else "; ".join(found["said"])


def new_folder(first: Path) -> Path:
    """Make a folder that nobody else has: recordings-1, or the next one that was not there."""
    numbers = count(1)
    while True:
        made = first.with_name(f"{first.name}-{next(numbers)}")
        with suppress(FileExistsError):
            made.parent.mkdir(parents=True, exist_ok=True)
            made.mkdir()
            return made


def refused_name(simulator: Path) -> str:
    """Why a Python file cannot be imported by its name: another module has it; "" where it can."""
    if simulator.suffix != ".py":
        return ""
    places = [each for each in sys.path if each and Path(each).absolute() != simulator.parent.absolute()]
    found = PathFinder.find_spec(simulator.stem, places)
    if simulator.stem not in sys.stdlib_module_names and (found is None or found.origin is None):
        return ""
    return f"{simulator.name}: a module of Python or of an installed package has this name; rename the file"


def unreadable(simulator: Path) -> str:
    """Why the file of a simulator cannot be read, "" where it can."""
    if simulator.is_file() and os.access(simulator, os.R_OK):
        return ""
    return f"{simulator.name} cannot be read, or is there no more; choose it anew in step 1 and simulate the trials"


def own_modules(case: Path, simulator: Path, kept: Path) -> tuple[Path, ...]:
    """Folders in which Python finds the model of a begun case: a new one with its adapter alone, then the simulator's.

    Parameters
    ----------
    case
        Python looks for no module there.
    simulator
        Python file, or FMU, which has to lie beside its adapter.
    kept
        Folder for that of the adapter.
    """
    fmu = simulator.suffix.lower() == ".fmu"
    beside = () if fmu else (simulator.parent,)
    adapters = sorted(case.glob("*_adapter.py"))
    if not adapters:
        return beside
    alone = new_folder(kept / "adapter")
    for file in (*adapters, *((simulator,) if fmu else ())):
        shutil.copy(file, alone / file.name)
    return (alone, *beside)


def _columns(asked: dict[str, Any]) -> dict[str, Any]:
    from geocontact.analyses.gap.chosen_columns import recorded_columns, same_unit

    first, *others = [Path(each) for each in asked["files"]]
    columns = recorded_columns(first)
    said = []
    for file in others:
        here = dict(recorded_columns(file))
        lacking = sorted(name for name, _ in columns if name not in here)
        said += [f"{file.name}: lacks {', '.join(lacking)}, which {first.name} has"] if lacking else []
        said += [
            f"{file.name}: {name} {_in(here[name])}, in {first.name} it {_in(unit)}"
            for name, unit in columns
            if name in here and not same_unit(unit, here[name])
        ]
    return {"columns": columns, "said": said}


def _in(unit: str) -> str:
    return f"is in {unit}" if unit else "has no unit"


def _numbers(asked: dict[str, Any]) -> dict[str, Any]:
    from geocontact.analyses.gap.init.starts import needed_numbers

    return {"numbers": needed_numbers(asked["model"], asked["channels"], asked["tables"]), "said": []}


def _trials(asked: dict[str, Any]) -> dict[str, Any]:
    from geocontact.analyses.gap.chosen_columns import ChosenColumn, write_chosen

    folder, files = Path(asked["folder"]), [Path(each) for each in asked["files"]]
    if same_place(file.stem for file in files):
        raise InputError("", "trials", "two files have one name", "rename one: trials are named after their files")
    for file in files:
        write_chosen(file, [ChosenColumn(**row) for row in asked["rows"]], folder / f"{file.stem}.csv")
    return {"said": []}


def _answers(asked: dict[str, Any]) -> dict[str, Any]:
    from geocontact.analyses.gap.init.answers import AnsweredNumber, answer_case

    numbers = {name: AnsweredNumber(**each) for name, each in asked["numbers"].items()}
    answer_case(Path(asked["folder"]), asked["evaluation"], numbers, asked["noise"], simulator_allowed=True)
    return {"said": []}


def _settings(asked: dict[str, Any]) -> dict[str, Any]:
    from geocontact.analyses.gap.init.answers import begun_settings

    return {"settings": begun_settings(Path(asked["folder"])), "said": []}


def answer(asked: dict[str, Any]) -> dict[str, Any]:
    """The answer to one question, in this process; a refusal stands in `said`."""
    tasks = {
        "columns": _columns,
        "trials": _trials,
        "numbers": _numbers,
        "settings": _settings,
        "answers": _answers,
    }
    task = tasks[asked["task"]]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            found = task(asked)
        except (ValueError, OSError) as error:  # a wrong table, a file that is gone by now
            return {"columns": [], "said": [str(error)]}
    doubts = dict.fromkeys(f"warning: {each.message}" for each in caught) if asked["task"] == "columns" else {}
    return {**found, "said": [*found["said"], *doubts]}


if __name__ == "__main__":
    json.dump(answer(json.load(sys.stdin)), sys.stdout)
