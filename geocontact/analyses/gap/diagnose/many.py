"""Many gap cases at once, a process each, as many at a time as there are cores.

A case that cannot be used costs the others nothing: it is one line on stderr, and the exit code is 2. Cases are
independent, so the results are those of one call per case.
"""

from __future__ import annotations

import shutil
import sys
import traceback
import uuid
from contextlib import redirect_stderr
from dataclasses import asdict, dataclass
from functools import partial
from io import StringIO
from pathlib import Path

import pandas as pd

from geocontact.analyses.gap.diagnose.run import COMMAND, diagnosed
from geocontact.analyses.gap.diagnose.words import verdict_sentences
from geocontact.analyses.progress import progress
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.analyses.stale_results import RUN
from geocontact.analyses.workers import each
from geocontact.cli.gap_diagnose import DiagnoseOptions
from geocontact.data.errors import InputError
from geocontact.io.cases.gap_case import gap_case_folders
from geocontact.io.text.results import write_table

SUMMARY = "summary"
WRONG, FAILED = 2, 1


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
    """

    name: str
    code: int
    line: str
    warnings: tuple[str, ...] = ()
    row: tuple[tuple[str, str | float], ...] = ()


def diagnose_many(cases: Path, o: DiagnoseOptions) -> int:
    """Diagnose every case in a folder; exit code of the worst."""
    if o.workers is not None and o.workers < 1:
        raise InputError("", "--workers", f"{o.workers} is less than one process", "give 1 or more")
    folders = gap_case_folders(cases)
    record = Record(COMMAND, {"case": cases, **asdict(o)})
    record.results["run"] = token = uuid.uuid4().hex
    with written_whole(o.out) as draft:
        outcomes = _all(folders, draft, o, token)
        done = [one for one in outcomes if one.code == 0]
        for one in outcomes:
            for line in one.warnings:
                record.warn(line)
            if one.code:
                print(" ".join(one.line.split()), file=sys.stderr)
        if not done:
            raise InputError(cases, "", f"none of the {len(folders)} cases could be diagnosed", "see the lines above")
        write_table(pd.DataFrame([dict(one.row) for one in done]), draft, parquet=False, name=SUMMARY)
        record.inputs += [{"role": "case", "file": str(folder), "folder": folder.name} for folder in folders]
        record.results["cases"] = {one.name: "done" if one.code == 0 else one.line for one in outcomes}
        record.write(draft)
    for one in done:
        record.say(f"{one.name}: {one.line}")
    record.say(f"{len(done)} of {len(folders)} cases diagnosed, results in {o.out}: {SUMMARY}.csv, {RUN}, <case>/…")
    record.speak()
    codes = {one.code for one in outcomes}
    return FAILED if FAILED in codes else max(codes)


def _all(folders: list[Path], draft: Path, o: DiagnoseOptions, token: str) -> list[Outcome]:
    """Outcomes in the order of the folders."""
    found = {}
    with progress("cases", len(folders)) as step:
        for folder, became in each(partial(outcome, draft=draft, o=o, token=token), folders, o.workers):
            found[folder.name] = _outcome_of(folder, became, draft)
            step()
    return [found[folder.name] for folder in folders]


def _outcome_of(folder: Path, became: Outcome | BaseException, draft: Path) -> Outcome:
    if isinstance(became, Outcome):
        return became
    shutil.rmtree(draft / folder.name, ignore_errors=True)  # a process that was killed leaves what it had written
    return Outcome(folder.name, FAILED, f"{folder}: {type(became).__name__}: {became}")


def outcome(folder: Path, draft: Path, o: DiagnoseOptions, token: str) -> Outcome:
    """Diagnosis of one case into draft/<case>; what is wrong is told, not raised."""
    place = draft / folder.name
    record = Record(COMMAND, {"case": folder, **asdict(o)})
    record.results["run"] = token

    def kept(code: int, line: str) -> Outcome:
        shutil.rmtree(place, ignore_errors=True)
        return Outcome(folder.name, code, line, tuple(record.warnings))

    try:
        if folder.name in (RUN, f"{SUMMARY}.csv"):
            raise InputError(folder, "", "has the name of a result", "rename the folder")
        place.mkdir()
        with redirect_stderr(StringIO()), record.catching_warnings():
            findings = diagnosed(record, folder, place, o)
    except InputError as error:
        return kept(WRONG, str(error))
    except Exception as error:  # the others shall be diagnosed all the same
        last = traceback.extract_tb(error.__traceback__)[-1]
        return kept(FAILED, f"{folder}: {type(error).__name__}: {error} ({Path(last.filename).name} {last.lineno})")
    d = findings.diagnosis
    row: list[tuple[str, str | float]] = [
        ("case", d.case),
        ("system", d.system),
        ("verdict", d.verdict),
        ("effects", " + ".join(d.effects)),
        ("ambiguity", " ".join(d.ambiguity)),
        ("probability [-]", float(sum(d.probabilities.get(name, 0.0) for name in _answer(d.verdict, d.effects)))),
        ("largest_reduction [-]", max((g.reduction for g in d.gap.values()), default=0.0)),
        ("seconds [s]", round(d.seconds, 3)),
    ]
    return Outcome(folder.name, 0, verdict_sentences(d, findings.cells)[0], tuple(record.warnings), tuple(row))


def _answer(verdict: str, effects: tuple[str, ...]) -> tuple[str, ...]:
    return effects or {"no_gap": ("none",), "unknown": ("unknown",)}.get(verdict, ())
