"""Many gap cases at once, a process each, as many at a time as there are cores.

A case that cannot be used costs the others nothing: it is one line, and the exit code is 2. Cases are independent, so
the results are those of one call per case. Each is written as it is done: a run that is ended keeps what it has.
"""

from __future__ import annotations

import shutil
import traceback
import uuid
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import pandas as pd

from geocontact.analyses.frame.collector import (
    collecting,
    current,
    listener,
    note,
    results,
    results_place,
    say,
    spelled,
)
from geocontact.analyses.frame.folder import RUN, Scratch, digest, written_whole
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.record import Record
from geocontact.analyses.frame.rerun import read_run, results_of
from geocontact.analyses.frame.result import Part, Result
from geocontact.analyses.frame.several import CONTRADICTS, doubt_columns, judge_several, reserve_of_several
from geocontact.analyses.frame.source_digest import digest as sources_digest
from geocontact.analyses.frame.table_forms import TableForms
from geocontact.analyses.frame.words import counted
from geocontact.analyses.frame.workers import each
from geocontact.analyses.gap.diagnose.options import ManyOptions
from geocontact.analyses.gap.diagnose.result import read, run
from geocontact.data.errors import InputError
from geocontact.data.version import VERSION
from geocontact.io.cases.gap_case import gap_case_folders
from geocontact.io.text.file_preflight import read_json

SUMMARY = "summary"
FAILED = 1
ANSWER = "diagnosis.json"
SOURCES, SAID = "sources", "said"
"""Keys of the results in run.json: which sources they came of, and the verdict in words."""
WRONG = 2


@dataclass(frozen=True)
class Outcome:
    """What became of one case.

    Parameters
    ----------
    code
        0 done, 2 for a mistake in the input, 1 for any other failure.
    line
        What it says: the verdict, or what is wrong.
    warnings
        Reservations.
    row
        Of the summary.
    fit
        Whether the answer agrees with the trials that were held out; "" where nothing was compared.
    """

    name: str
    code: int
    line: str
    warnings: tuple[str, ...] = ()
    row: tuple[tuple[str, str | float], ...] = ()
    fit: str = ""

    @property
    def told(self) -> dict[str, str | float]:
        """The row with the outcome of the fit and each kind of warning in words."""
        return dict(self.row) | doubt_columns(self.fit, self.warnings)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ManyResult(Result):
    """Diagnoses of the cases in a folder, each in a sub-folder of its own.

    Parameters
    ----------
    outcomes
        What became of each case, by name.
    scratch
        Where the results of each case lie until they are written.
    """

    options: ManyOptions
    outcomes: tuple[Outcome, ...]
    scratch: Scratch

    @property
    def done(self) -> tuple[Outcome, ...]:
        """Cases that could be diagnosed."""
        return tuple(one for one in self.outcomes if one.code == 0)

    @property
    def accepted(self) -> bool:
        """False where a case could not be diagnosed."""
        return len(self.done) == len(self.outcomes)

    @property
    def exit_code(self) -> int:
        """That of the worst case; 1 where an answer contradicts its data."""
        codes = {one.code for one in self.outcomes}
        return FAILED if FAILED in codes or any(one.fit == CONTRADICTS for one in self.outcomes) else max(codes)

    @property
    def title(self) -> str:
        """With the folder of the cases."""
        return f"Gap diagnoses of {self.options.case.name}"

    @property
    def parts(self) -> frozenset[Part]:
        """The summary alone; pages are those of the cases."""
        return frozenset(("tables",))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`summary`: a row for each case that could be diagnosed."""
        return {SUMMARY: pd.DataFrame([one.told for one in self.done])}

    def write_files(self, folder: Path) -> None:
        """Also all results of each case in a sub-folder of its name."""
        super().write_files(folder)
        for one in self.done:
            shutil.copytree(self.scratch.folder / one.name, folder / one.name)


def kept(case: Path, folder: Path, o: ManyOptions, sources: str) -> Outcome | None:
    """What an earlier run found of a case, or None where it must be diagnosed again.

    Parameters
    ----------
    folder
        Of its results.
    sources
        Digest of the package's sources now.
    """
    try:
        before = read_run(folder)
        if before.command != "gap diagnose" or before.version != VERSION or case / "case.toml" not in before.inputs:
            return None
        told = read_json(folder / RUN)
        alike = all(told["options_si"].get(name) == getattr(o, name) for name in ("bare", "run_simulator"))
        if not alike or told["results"][SOURCES] != sources or before.changed():
            return None
        if any(digest(folder / name) != known for name, known in results_of(folder).items()):
            return None
        answer = read_json(folder / ANSWER)
        fit = told.get("fit", {}).get("outcome", "")
        return Outcome(case.name, 0, told["results"][SAID], tuple(told["warnings"]), row(answer), fit)
    except (InputError, OSError, KeyError, TypeError, AttributeError, ValueError):
        return None  # nothing there, or not of this make


def run_of(folder: Path) -> str:
    """Mark of the run that results are of."""
    return str(read_json(folder / RUN)["results"]["run"])


def row(d: Mapping[str, Any]) -> tuple[tuple[str, str | float], ...]:
    """A case in the summary, from what diagnosis.json holds."""
    effects = d["effects"]
    answer = effects or {"no_gap": ("none",), "unknown": ("unknown",)}.get(d["verdict"], ())
    return (
        ("case", d["case"]),
        ("system", d["system"]),
        ("verdict", d["verdict"]),
        ("effects", " + ".join(effects)),
        ("ambiguity", " ".join(d["ambiguity"])),
        ("one_law", " ".join("=".join(group) for group in d.get("one_law", []))),
        ("probability [-]", float(sum(d["probabilities"].get(name, 0.0) for name in answer))),
        ("largest_reduction [-]", max((g["reduction"] for g in d["gap"].values()), default=0.0)),
        ("seconds [s]", round(d["seconds"], 3)),
    )


def read_folders(o: ManyOptions) -> list[Path]:
    """Folders of the cases; what is in them is read case by case, so that a wrong one does not stop the others."""
    folders = gap_case_folders(o.case)
    current().inputs += [{"role": "case", "file": str(folder), "folder": folder.name} for folder in folders]
    return folders


def run_many(folders: list[Path], o: ManyOptions) -> ManyResult:
    """Diagnose every case; InputError where none can be."""
    note("run", uuid.uuid4().hex)
    scratch = Scratch()
    outcomes = _all(folders, scratch.folder, o)
    judge_several([(one.name, one.fit) for one in outcomes], "nothing is named in them", "case")
    reserve_of_several([(one.name, one.warnings) for one in outcomes], "case")
    for one in outcomes:
        if one.code:
            listener().fail(one.line)
    result = ManyResult(options=o, outcomes=tuple(outcomes), scratch=scratch)
    if not result.done:
        raise InputError(o.case, "", f"none of the {len(folders)} cases could be diagnosed", "see the lines above")
    note("cases", {one.name: "done" if one.code == 0 else one.line for one in outcomes})
    for one in result.done:
        say(f"{one.name}: {one.line}")
    say(f"{len(result.done)} of {len(folders)} cases diagnosed")
    return result


def _all(folders: list[Path], draft: Path, o: ManyOptions) -> list[Outcome]:
    """Outcomes in the order of the folders."""
    sources = sources_digest()
    found = _finished(folders, draft, o, sources) if o.resume else {}
    marks = {"run": str(results()["run"]), SOURCES: sources}
    asked = current()
    work = partial(outcome, draft=draft, o=o, options=dict(asked.options), marks=marks, forms=asked.forms)
    work = partial(work, without=asked.without)
    todo, place = [folder for folder in folders if folder.name not in found], results_place()
    with listener().progress("cases", len(todo)) as step:
        for folder, became in each(work, todo, o.workers):
            found[folder.name] = one = _outcome_of(folder, became, draft)
            if one.code == 0 and place is not None:
                _keep(draft / one.name, place / one.name)
            step()
    return [found[folder.name] for folder in folders]


def _finished(folders: list[Path], draft: Path, o: ManyOptions, sources: str) -> dict[str, Outcome]:
    """What an earlier run had finished, by name; InputError where nothing is written and there can be nothing."""
    place = results_place()
    if place is None:
        raise InputError("", "`resume`", "has no effect: nothing is written", "leave it out")
    found = {}
    for folder in folders:
        one = kept(folder, place / folder.name, o, sources)
        if one is not None:
            shutil.copytree(place / folder.name, draft / folder.name)
            found[folder.name] = one
            note("run", run_of(place / folder.name))  # this one goes on with it
    say(f"{len(found)} of {counted(len(folders), 'case')} as an earlier run left them")
    return found


def _keep(done: Path, place: Path) -> None:
    """Results of a case where they will be, whole, before the other cases are done."""
    with written_whole(place) as draft:
        shutil.copytree(done, draft, dirs_exist_ok=True)


def _outcome_of(folder: Path, became: Outcome | BaseException, draft: Path) -> Outcome:
    if isinstance(became, Outcome):
        return replace(became, line=spelled(became.line))
    shutil.rmtree(draft / folder.name, ignore_errors=True)  # a process that was killed leaves what it had written
    return Outcome(folder.name, FAILED, f"{folder}: {type(became).__name__}: {became}")


def outcome(
    folder: Path,
    draft: Path,
    o: ManyOptions,
    options: Mapping[str, object],
    marks: Mapping[str, str],
    forms: TableForms,
    without: frozenset[str],
) -> Outcome:
    """Diagnosis of one case into draft/<case>; what is wrong is written, not raised.

    Parameters
    ----------
    options
        As they were given for all cases.
    marks
        Results of every case: which run it was, and of which sources.
    forms
        Further forms of the tables.
    without
        Parts that are not written.
    """
    place = draft / folder.name
    one = ManyOptions(folder, many=True, bare=o.bare, workers=o.workers, run_simulator=o.run_simulator)
    typed = {**options, "case": folder}
    record = Record("gap diagnose", typed, one.in_si(), results=dict(marks), forms=forms, without=without)

    def failed(code: int, line: str) -> Outcome:
        shutil.rmtree(place, ignore_errors=True)
        return Outcome(folder.name, code, line, tuple(record.warnings))

    try:
        if folder.name in (RUN, f"{SUMMARY}.csv"):
            raise InputError(folder, "", "has the name of a result", "rename the folder")
        place.mkdir()
        with collecting(record):
            result = run(read(one), one)
            note(SAID, result.sentences[0])
            result.put(place)
    except InputError as error:
        return failed(WRONG, str(error))
    except Exception as error:  # the others shall be diagnosed all the same
        last = traceback.extract_tb(error.__traceback__)[-1]
        return failed(FAILED, f"{folder}: {type(error).__name__}: {error} ({Path(last.filename).name} {last.lineno})")
    said = result.sentences[0], result.warnings, row(result.diagnosis.as_dict()), result.fit_outcome or ""
    return Outcome(folder.name, 0, *said)


diagnose_many = Job("gap diagnose", ManyOptions, read_folders, run_many)
