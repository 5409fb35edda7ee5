"""Answers to what a begun case asks, written into its case.toml; what they do not answer stays there."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise, takewhile
from pathlib import Path
from typing import Any

from geocontact.analyses.gap.init.options import QUESTIONS
from geocontact.analyses.gap.init.settings import ASKED, NOISE_ASKED, NUMBERS_ASKED, OPEN
from geocontact.data.errors import InputError
from geocontact.data.gap_case import LISTED_SYSTEMS
from geocontact.io.cases.case_settings import LARGEST_SETTINGS, SETTINGS
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.cases.gap_case_writer import toml_key
from geocontact.io.text.file_preflight import read_text_bytes
from geocontact.io.text.toml_text import toml_of

_SECTION = re.compile(r"\s*\[\[?\s*\"?(?P<name>[^\].\"]+)")
_QUESTION = re.compile(r"#\s+\d+\. (?P<words>.+)")
_ANSWERED = (NUMBERS_ASKED, NOISE_ASKED)
_TRIALS = ("calibration", "evaluation")


@dataclass(frozen=True)
class AnsweredNumber:
    """A number of the model: its start value and bounds, or no bounds where it is known exactly; SI units.

    The latter becomes a constant of a model of the package, whose known lengths may be a little off, and a fixed
    parameter of any other.
    """

    start: float
    lower: float | None
    upper: float | None
    unit: str


def begun_settings(folder: Path) -> dict[str, Any]:
    """What case.toml of a begun case says, with "?" for what is open, and by `QUESTIONS` what `answer_case` leaves."""
    file = folder / SETTINGS
    lines = read_text_bytes(file).decode("utf-8", "replace").splitlines()
    return {**toml_of(file, LARGEST_SETTINGS), QUESTIONS: [line.partition(". ")[2] for line in _left(lines)]}


def answer_case(
    folder: Path,
    evaluation: Sequence[str],
    numbers: Mapping[str, AnsweredNumber],
    noise: Mapping[str, float],
    simulator_allowed: bool = False,
) -> None:
    """Write held-out trials, numbers and noise into the case that `gap init` began in `folder`.

    The other trials are those to fit to. Other keys, sections and questions of case.toml stay, and the whole file where
    the case cannot be read afterwards.

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
        The case cannot be read with these answers, a number has no answer, one whose bounds are open has no unit, or
        one of a model of the package another than case.toml says.
    """
    file = folder / SETTINGS
    said = toml_of(file, LARGEST_SETTINGS)
    before = read_text_bytes(file)
    trials = sorted(each.stem for each in (folder / "trials").glob("*.csv"))
    if unknown := [name for name in evaluation if name not in trials]:
        raise InputError(folder, "", f"has no trial {unknown[0]}", f"it has {', '.join(trials)}")
    calibration = [name for name in trials if name not in evaluation]
    _check_numbers(file, said, numbers)
    sections = _sections(said, numbers, noise)
    answered = "\n".join(_lines(before.decode("utf-8-sig"), calibration, evaluation, sections)) + "\n"
    _check_kept(file, said, answered, sections)
    try:
        file.write_text(answered, encoding="utf-8", newline="\n")
        read_gap_case(folder, run_programs=simulator_allowed)
    except BaseException:
        file.write_bytes(before)
        raise


def _sections(
    said: Mapping[str, Any], numbers: Mapping[str, AnsweredNumber], noise: Mapping[str, float]
) -> dict[str, dict[str, Any]]:
    """What is written anew; constants are where an answer is one, or was."""
    listed, before = said.get("system") in LISTED_SYSTEMS, said.get("constants", {})
    exact = {name: each.start for name, each in numbers.items() if listed and each.lower is None}
    anew: dict[str, dict[str, Any]] = {"noise": dict(noise)}
    anew["parameters"] = {name: each for name, each in numbers.items() if name not in exact}
    if exact or any(name in numbers for name in before):
        anew["constants"] = {name: value for name, value in before.items() if name not in numbers} | exact
    return anew


def _check_numbers(file: Path, said: Mapping[str, Any], numbers: Mapping[str, AnsweredNumber]) -> None:
    """All numbers of the file are answered; in the unit that a model of the package takes, else in any stated one."""
    listed, asked = said.get("system") in LISTED_SYSTEMS, said.get("parameters", {})
    if lacking := [name for name in asked if name not in numbers]:
        remedy = "give it with the others, or delete it there"
        raise InputError(file, f"[parameters.{lacking[0]}]", "is not among the numbers that are answered", remedy)
    for name, each in numbers.items():
        unit, known = each.unit.strip(), asked.get(name, {}).get("unit", "")
        if listed and known and unit != known:
            what = f"is answered in {unit or 'no unit'}"
            raise InputError(file, f"[parameters.{name}]", what, f"give it in {known}; nothing is converted")
        if not unit and asked.get(name, {}).get("lower") == json.loads(OPEN):
            raise InputError(
                file, f"[parameters.{name}]", "its unit is missing", 'write it in SI, "-" for a pure number'
            )


def _check_kept(file: Path, said: Mapping[str, Any], text: str, written: Mapping[str, Mapping[str, Any]]) -> None:
    """The new text says what the old one said, but for what is written anew."""
    try:
        found: dict[str, Any] = tomllib.loads(text)
    except ValueError:
        found = {}
    anew = (*_TRIALS, *written)
    kept, before = ({key: value for key, value in all_.items() if key not in anew} for all_ in (found, said))
    if kept != before or any(set(found.get(key, {})) != set(each) for key, each in written.items()):
        what = "cannot be answered line by line"
        raise InputError(file, "", what, "write lists on one line, and noise and parameters as [noise], [parameters.k]")


def _left(lines: Sequence[str]) -> list[str]:
    """Questions above the first section that neither numbers nor noise answer."""
    head = takewhile(lambda line: not _SECTION.match(line), lines)
    return [line for line in head if (found := _QUESTION.match(line)) and not found["words"].startswith(_ANSWERED)]


def _lines(
    text: str,
    calibration: Sequence[str],
    evaluation: Sequence[str],
    sections: Mapping[str, Mapping[str, Any]],
) -> Iterator[str]:
    """Head and sections without what is answered; trials, noise and numbers anew."""
    lines = text.splitlines()
    begins = [k for k, line in enumerate(lines) if _SECTION.match(line)] + [len(lines)]
    if asked := _left(lines):
        yield from (ASKED, *asked)
    for line in lines[: begins[0]]:
        key = line.partition("=")[0].strip()
        if line.strip() and key not in _TRIALS and line.strip() != ASKED and not _QUESTION.match(line):
            yield line
    yield f"calibration = {json.dumps(list(calibration), ensure_ascii=False)}"
    yield f"evaluation = {json.dumps(list(evaluation), ensure_ascii=False)}"
    for begin, end in pairwise(begins):
        section = _SECTION.match(lines[begin])
        if section is not None and section["name"].strip() not in sections:
            yield "\n" + "\n".join(lines[begin:end]).strip()
    for plain in ("noise", "constants"):
        if sections.get(plain):
            yield f"\n[{plain}]"
            yield from (f"{toml_key(name)} = {value!r}" for name, value in sections[plain].items())
    for name, each in sections["parameters"].items():
        yield f"\n[parameters.{toml_key(name)}]"
        yield f"start = {each.start!r}"
        if each.lower is None or each.upper is None:
            yield "fixed = true"
        else:
            yield f"lower = {each.lower!r}"
            yield f"upper = {each.upper!r}"
        yield f"unit = {json.dumps(each.unit, ensure_ascii=False)}"
