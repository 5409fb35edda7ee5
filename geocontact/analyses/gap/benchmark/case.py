"""One case of a benchmark in a process of its own: drawn, written, read back, diagnosed, and put into a journal."""

from __future__ import annotations

import json
import shutil
import time
import traceback
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from os.path import lexists
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.source_digest import digest
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.data.version import VERSION
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.problem import Problem
from geocontact.gap.diagnose import Findings, diagnose
from geocontact.gap_benchmark.answers import LEFT, confounding
from geocontact.gap_benchmark.drawing import Lot, SyntheticCase, drawn
from geocontact.gap_benchmark.residual_regression import residual_regression
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.cases.gap_case_writer import write_gap_case
from geocontact.io.text.file_preflight import read_text_bytes
from geocontact.systems.catalogue import system_of

OTHER_UNITS = {"rad": "deg", "N": "kN", "m": "mm"}
FULL = 17
"""Digits with which every number is read back exactly."""
ALIKE = 1e-3
"""Largest change of a probability or a reduction between two dresses of one case."""
ANSWERERS = ("diagnosis", "regression", "regression_aware")


@dataclass(frozen=True)
class Task:
    """A case to be worked: which, where its folder goes, whether that stays, and whether it is diagnosed twice."""

    lot: Lot
    folder: Path
    keep: bool = False
    again: bool = False


@dataclass(frozen=True)
class Worked:
    """What came of it.

    Parameters
    ----------
    name
        Of the case; tells nothing of its kind.
    label
        The truth; None where no case came of the draw.
    answers
        By answerer.
    wall, cpu
        From the folder to the diagnosis [s].
    same
        Whether the case in another dress got the same answer; None where that was not asked.
    trouble
        What went wrong, a line each.
    """

    lot: Lot
    name: str
    label: dict[str, Any] | None
    answers: Mapping[str, dict[str, Any]]
    wall: float = float("nan")
    cpu: float = float("nan")
    same: bool | None = None
    trouble: tuple[str, ...] = ()


def worked(task: Task) -> Worked:
    """Draw, write, read, diagnose on one core; whatever breaks down is named and scored as wrong."""
    with threadpool_limits(limits=1):
        return _worked(task)


def _worked(task: Task) -> Worked:
    where = _where(task)
    try:
        planted = drawn(task.lot)
    except Exception as error:  # the other cases shall be scored all the same
        return Worked(task.lot, where, None, {}, trouble=(f"{where} was not drawn: {_failure(error)}",))
    home = task.folder / planted.case.name
    try:
        write_gap_case(planted.case, home)
        return _answered(task, planted, home)
    finally:
        if not task.keep:
            shutil.rmtree(home, ignore_errors=True)


def lost(task: Task, why: BaseException) -> Worked:
    """A case whose process ended before it could say anything: drawn again for its label, and wrong everywhere."""
    where = _where(task)
    trouble = (f"{where} was lost: {type(why).__name__}: {why}",)
    try:
        label = plain(drawn(task.lot).label.as_dict())
    except Exception as error:  # as in the process that was lost
        return Worked(task.lot, where, None, {}, trouble=(*trouble, f"{where} was not drawn: {_failure(error)}"))
    return Worked(task.lot, where, label, {who: failed(label) for who in ANSWERERS}, trouble=trouble)


def _where(task: Task) -> str:
    lot = task.lot
    return f"{lot.system} {lot.kind} {lot.place} of seed {lot.seed}, laboratory {lot.laboratory}"


def _answered(task: Task, planted: SyntheticCase, home: Path) -> Worked:
    name, trouble = planted.case.name, []
    label = plain(planted.label.as_dict())
    answers = {who: failed(label) for who in ANSWERERS}
    wall, cpu, same = float("nan"), float("nan"), None
    began = time.perf_counter(), time.process_time()
    try:
        findings = from_folder(home)
        wall, cpu = time.perf_counter() - began[0], time.process_time() - began[1]
        answers["diagnosis"] = plain(findings.diagnosis.as_dict())
        problem = findings.attribution.problem
        answers |= _opponents(problem)
        if task.again:
            same = alike(answers["diagnosis"], plain(_in_another_dress(home).diagnosis.as_dict()))
        if task.lot.kind == "outside":
            label |= _imitated(planted, problem)
    except Exception as error:  # likewise
        trouble.append(f"{name} ({task.lot.system} {task.lot.kind}): {_failure(error)}")
    return Worked(task.lot, name, label, answers, wall, cpu, same, tuple(trouble))


def failed(label: Mapping[str, Any]) -> dict[str, Any]:
    """Answer of whoever broke down: right nowhere."""
    nothing = {"reduction": 0.0, "ci95": None}
    said: dict[str, Any] = {"verdict": "failed", "effects": [], "probabilities": {}, "ambiguity": [], "absorbed": []}
    return said | {"gap": dict.fromkeys(label["reduction"], nothing)}


def from_folder(home: Path) -> Findings:
    """The whole path of `gap diagnose` but for what is written."""
    case = read_gap_case(home)
    system = system_of(case)
    return diagnose(case, system, VERSION)


def _opponents(problem: Problem) -> dict[str, dict[str, Any]]:
    """What regressing the residual says, on the base fit of the diagnosis."""
    offered = candidates(problem.system)
    return {
        "regression": plain(residual_regression(problem, offered, aware=False)),
        "regression_aware": plain(residual_regression(problem, offered, aware=True)),
    }


def _imitated(planted: SyntheticCase, problem: Problem) -> dict[str, Any]:
    """Whether a candidate imitates what is not in the table, from the truth."""
    left, label = confounding(problem.system, planted.ideal, candidates(problem.system), planted.label.floor)
    return {"imitated": left < LEFT, "imitation": {"left": left, "by": label}}


def _in_another_dress(home: Path) -> Findings:
    """The same measurement: other names, trials listed the other way round, channels in other units."""
    case = read_gap_case(home)
    other = home.parent / f"{home.name}_again"
    signals = case.calibration[0].signals
    units = {name: OTHER_UNITS.get(si, si) for name, si in zip(signals.channels, signals.units, strict=True)}
    try:
        write_gap_case(renamed(case), other, units, FULL)
        return from_folder(other)
    finally:
        shutil.rmtree(other, ignore_errors=True)


def renamed(case: GapCase) -> GapCase:
    """The case with trials of other names, in the opposite order."""

    def other(trials: tuple[Trial, ...], letter: str) -> tuple[Trial, ...]:
        return tuple(replace(one, name=f"{letter}{i}") for i, one in enumerate(reversed(trials)))

    return replace(case, calibration=other(case.calibration, "m"), evaluation=other(case.evaluation, "b"))


def alike(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Whether two diagnoses say the same: words exactly, probabilities and reductions within `ALIKE`."""
    if any(one[key] != other[key] for key in ("verdict", "effects", "ambiguity", "absorbed")):
        return False
    names = {*one["probabilities"], *other["probabilities"]}
    apart = [abs(one["probabilities"].get(n, 0.0) - other["probabilities"].get(n, 0.0)) for n in names]
    apart += [abs(gap["reduction"] - other["gap"][channel]["reduction"]) for channel, gap in one["gap"].items()]
    return max(apart, default=0.0) <= ALIKE


def _failure(error: Exception) -> str:
    last = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {' '.join(str(error).split())} ({Path(last.filename).name} {last.lineno})"


class Journal:
    """What was worked by the same sources; of any seed, so that runs can be put together.

    The file is only added to: an end in between costs the case at hand.

    Parameters
    ----------
    path
        The file; begun where it is not there. InputError where other sources wrote it.
    """

    def __init__(self, path: Path) -> None:
        self.path, here = path, digest()
        begun = lexists(path) and not (path.is_file() and path.stat().st_size == 0)
        lines = read_text_bytes(path).decode("utf-8").splitlines(keepends=True) if begun else []
        whole = [json.loads(line) for line in lines if line.endswith("\n")]  # one that was cut off is no case
        if whole and whole[0] != {"sources": here}:
            what = f"was written by sources {whole[0].get('sources')}, these are {here}"
            raise InputError(path, "line 1", what, "take the same version, or another file")
        if lines and not lines[-1].endswith("\n"):
            path.write_text("".join(lines[:-1]), encoding="utf-8")
        if not whole:
            self._add({"sources": here})
        self.done = {one.lot: one for one in map(_case_of, whole[1:])}

    def keep(self, one: Worked) -> None:
        """Add a case."""
        self.done[one.lot] = one
        self._add(asdict(one))

    def _add(self, line: dict[str, object]) -> None:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line) + "\n")


def _case_of(row: dict[str, object]) -> Worked:
    given = dict(row)
    return Worked(**{**given, "lot": Lot(**given["lot"]), "trouble": tuple(given["trouble"])})  # type: ignore[arg-type]
