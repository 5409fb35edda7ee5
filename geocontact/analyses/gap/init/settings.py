"""case.toml of a case that is begun: what is known as values, what is not as "?" and questions beside them."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence

from geocontact.analyses.gap.init.first_run import FirstRun
from geocontact.analyses.gap.init.simulator import FoundSimulator
from geocontact.data.gap_case import GapCase
from geocontact.data.parameter import Parameter
from geocontact.io.cases.gap_case_writer import file_of, toml_key

OPEN = '"?"'
"""Value of what only the user knows; not a number, so that a diagnosis refuses it."""
ASKED = "# Open questions; delete each line when it is answered:"
NUMBERS_ASKED, NOISE_ASKED = "start, lower, upper and unit of ", "noise of "
"""Beginnings of the questions that numbers and noise in case.toml answer."""


def settings_text(case: GapCase, found: FoundSimulator, run: FirstRun, questions: Sequence[str]) -> str:
    """The whole file."""
    return "\n".join(_lines(case, found, run, questions)) + "\n"


def _lines(case: GapCase, found: FoundSimulator, run: FirstRun, questions: Sequence[str]) -> Iterator[str]:
    if questions:
        yield ASKED
        yield from (f"#   {k}. {question}" for k, question in enumerate(questions, 1))
    yield "format = 1"
    yield f"system = {_word(found.system)}"
    for key, value in found.settings:
        yield f"{key} = {_word(value)}"
    yield f"calibration = {_word([one.name for one in case.calibration])}"
    yield f"evaluation = {_word([one.name for one in case.evaluation])}  # held out: nothing is fitted to them"
    for key in case.tables:
        yield f"{toml_key(key)} = {_word(file_of(key))}"
    yield ""
    yield "[noise]  # standard deviation of a sensor"
    for name in run.system.outputs:
        yield f"# {toml_key(name)} = ?  # {_unit(case, name)}"
    for one in (*case.calibration, *case.evaluation):
        if one.covariates:
            yield f"\n[trial.{toml_key(one.name)}]"
            yield from (f"{toml_key(name)} = {_number(value)}" for name, value in one.covariates.items())
    declared = {p.name for p in found.declared}
    for p in run.system.parameters:
        yield ""
        yield from _parameter(p, p.name in declared, p.name in run.unknown)


def _parameter(p: Parameter, declared: bool, unknown: bool) -> Iterator[str]:
    yield f"[parameters.{toml_key(p.name)}]"
    yield f"start = {OPEN if unknown else _number(p.start)}"
    if p.fixed:
        yield "fixed = true"
    elif declared:
        yield f"lower = {_number(p.lower)}"
        yield f"upper = {_number(p.upper)}"
    else:
        yield f"lower = {OPEN}  # or fixed = true in place of lower and upper"
        yield f"upper = {OPEN}"
    yield f"unit = {_word(p.unit)}" + ("" if declared or p.unit else '  # SI: "m", "rad", "N m/rad" …')


def _unit(case: GapCase, name: str) -> str:
    signals = case.calibration[0].signals
    return signals.units[signals.channels.index(name)]


def _number(value: float) -> str:
    return repr(float(value)) if math.isfinite(value) else ("inf" if value > 0.0 else "-inf")


def _word(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)
