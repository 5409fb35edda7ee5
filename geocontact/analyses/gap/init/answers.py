"""Answers to what a begun case asks, written into its case.toml."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.io.cases.case_settings import SETTINGS
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.cases.gap_case_writer import toml_key
from geocontact.io.text.file_preflight import read_text_bytes

_SECTION = re.compile(r"\[(?P<name>[^\]]+)\]")
_ASKED = re.compile(r"#\s+(\d+\. |.*= \?)|# Open questions")


@dataclass(frozen=True)
class AnsweredNumber:
    """A number of the model: its start value and bounds, or no bounds where it is known exactly; SI units."""

    start: float
    lower: float | None
    upper: float | None
    unit: str


def begun_settings(folder: Path) -> dict[str, Any]:
    """What case.toml of a begun case says, with "?" for what is open."""
    return tomllib.loads(read_text_bytes(folder / SETTINGS).decode("utf-8"))


def answer_case(
    folder: Path,
    evaluation: Sequence[str],
    numbers: Mapping[str, AnsweredNumber],
    noise: Mapping[str, float],
    simulator_allowed: bool = False,
) -> None:
    """Write held-out trials, numbers and noise into the case that `gap init` began in `folder`.

    The other trials are those to fit to. What stood there stays where the case cannot be read afterwards.

    Parameters
    ----------
    evaluation
        Names of the trials that are held out.
    numbers
        All numbers of the model by name.
    noise
        Standard deviation of a sensor by channel, in the channel's SI unit; one that is not named is estimated.
    simulator_allowed
        Whether a program that the case names may be looked for.

    Raises
    ------
    InputError
        The case cannot be read with these answers.
    """
    file = folder / SETTINGS
    before = read_text_bytes(file).decode("utf-8")
    trials = sorted(each.stem for each in (folder / "trials").glob("*.csv"))
    if unknown := [name for name in evaluation if name not in trials]:
        raise InputError(folder, "", f"has no trial {unknown[0]}", f"it has {', '.join(trials)}")
    calibration = [name for name in trials if name not in evaluation]
    answered = "\n".join(_lines(before, calibration, evaluation, numbers, noise)) + "\n"
    file.write_text(answered, encoding="utf-8", newline="\n")
    try:
        read_gap_case(folder, run_programs=simulator_allowed)
    except InputError:
        file.write_text(before, encoding="utf-8", newline="\n")
        raise


def _lines(
    text: str,
    calibration: Sequence[str],
    evaluation: Sequence[str],
    numbers: Mapping[str, AnsweredNumber],
    noise: Mapping[str, float],
) -> Iterator[str]:
    """Keys of the head without its questions; noise and numbers anew."""
    head = []
    for line in text.splitlines():
        if _SECTION.match(line):
            break
        key = line.partition("=")[0].strip()
        if key not in ("calibration", "evaluation") and not _ASKED.match(line) and line.strip():
            head.append(line)
    yield from head
    yield f"calibration = {json.dumps(list(calibration), ensure_ascii=False)}"
    yield f"evaluation = {json.dumps(list(evaluation), ensure_ascii=False)}"
    if noise:
        yield "\n[noise]"
        yield from (f"{toml_key(name)} = {value!r}" for name, value in noise.items())
    for name, each in numbers.items():
        yield f"\n[parameters.{toml_key(name)}]"
        yield f"start = {each.start!r}"
        if each.lower is None or each.upper is None:
            yield "fixed = true"
        else:
            yield f"lower = {each.lower!r}"
            yield f"upper = {each.upper!r}"
        yield f"unit = {json.dumps(each.unit, ensure_ascii=False)}"
