"""Many gap cases at once, a process each, as many at a time as there are cores.

A case that cannot be used costs the others nothing: it is one line, and the exit code is 2. Cases are independent, so
the results are those of one call per case. Each is written as it is done: a run that is ended keeps what it has.
"""

from __future__ import annotations

import shutil
import traceback
import uuid
from collections.abc import Mapping
from functools import partial
from pathlib import Path

from geocontact.analyses.gap.diagnose.many_result import FAILED, SUMMARY, ManyResult, Outcome
from geocontact.analyses.gap.diagnose.options import ManyOptions
from geocontact.analyses.gap.diagnose.read import read
from geocontact.analyses.gap.diagnose.result import DiagnoseResult
from geocontact.analyses.gap.diagnose.run import run
from geocontact.analyses.results_folder import Scratch, written_whole
from geocontact.analyses.run_record import Record
from geocontact.analyses.stale_results import RUN
from geocontact.analyses.table_forms import TableForms
from geocontact.analyses.workers import each
from geocontact.data.errors import InputError
from geocontact.io.cases.gap_case import gap_case_folders

WRONG = 2


def read_folders(o: ManyOptions, record: Record) -> list[Path]:
    """Folders of the cases; what is in them is read case by case, so that a wrong one does not stop the others."""
    folders = gap_case_folders(o.case)
    record.inputs += [{"role": "case", "file": str(folder), "folder": folder.name} for folder in folders]
    return folders


def run_many(folders: list[Path], o: ManyOptions, record: Record) -> ManyResult:
    """Diagnose every case; InputError where none can be."""
    record.results["run"] = uuid.uuid4().hex
    scratch = Scratch()
    outcomes = _all(folders, scratch.folder, o, record)
    for one in outcomes:
        for line in one.warnings:
            record.warn(line)
        if one.code:
            record.listener.fail(one.line)
    result = ManyResult(record=record, options=o, outcomes=tuple(outcomes), scratch=scratch)
    if not result.done:
        raise InputError(o.case, "", f"none of the {len(folders)} cases could be diagnosed", "see the lines above")
    record.results["cases"] = {one.name: "done" if one.code == 0 else one.line for one in outcomes}
    for one in result.done:
        record.say(f"{one.name}: {one.line}")
    record.say(f"{len(result.done)} of {len(folders)} cases diagnosed")
    return result


def _all(folders: list[Path], draft: Path, o: ManyOptions, record: Record) -> list[Outcome]:
    """Outcomes in the order of the folders."""
    found = {}
    options, run_id = dict(record.options), str(record.results["run"])
    work = partial(outcome, draft=draft, o=o, options=options, run_id=run_id, forms=record.forms)
    with record.listener.progress("cases", len(folders)) as step:
        for folder, became in each(work, folders, o.workers):
            found[folder.name] = one = _outcome_of(folder, became, draft, record)
            if one.code == 0 and record.out is not None:
                _keep(draft / one.name, record.out / one.name)
            step()
    return [found[folder.name] for folder in folders]


def _keep(done: Path, place: Path) -> None:
    """Results of a case where they will be, whole, before the other cases are done."""
    with written_whole(place) as draft:
        shutil.copytree(done, draft, dirs_exist_ok=True)


def _outcome_of(folder: Path, became: Outcome | BaseException, draft: Path, record: Record) -> Outcome:
    if isinstance(became, Outcome):
        return Outcome(became.name, became.code, record.spell(became.line), became.warnings, became.row)
    shutil.rmtree(draft / folder.name, ignore_errors=True)  # a process that was killed leaves what it had written
    return Outcome(folder.name, FAILED, f"{folder}: {type(became).__name__}: {became}")


def outcome(
    folder: Path, draft: Path, o: ManyOptions, options: Mapping[str, object], run_id: str, forms: TableForms
) -> Outcome:
    """Diagnosis of one case into draft/<case>; what is wrong is told, not raised.

    Parameters
    ----------
    options
        As they were given for all cases.
    run_id
        Marks the results of one run.
    forms
        Further forms of the tables.
    """
    place = draft / folder.name
    one = ManyOptions(folder, many=True, bare=o.bare, workers=o.workers, run_simulator=o.run_simulator)
    record = Record("gap diagnose", {**options, "case": folder}, one.in_si(), results={"run": run_id}, forms=forms)

    def kept(code: int, line: str) -> Outcome:
        shutil.rmtree(place, ignore_errors=True)
        return Outcome(folder.name, code, line, tuple(record.warnings))

    try:
        if folder.name in (RUN, f"{SUMMARY}.csv"):
            raise InputError(folder, "", "has the name of a result", "rename the folder")
        place.mkdir()
        with record.catching_warnings():
            result = run(read(one, record), one, record)
            result.put(place)
    except InputError as error:
        return kept(WRONG, str(error))
    except Exception as error:  # the others shall be diagnosed all the same
        last = traceback.extract_tb(error.__traceback__)[-1]
        return kept(FAILED, f"{folder}: {type(error).__name__}: {error} ({Path(last.filename).name} {last.lineno})")
    return Outcome(folder.name, 0, result.sentences[0], result.warnings, _row(result))


def _row(result: DiagnoseResult) -> tuple[tuple[str, str | float], ...]:
    d = result.diagnosis
    answer = d.effects or {"no_gap": ("none",), "unknown": ("unknown",)}.get(d.verdict, ())
    return (
        ("case", d.case),
        ("system", d.system),
        ("verdict", d.verdict),
        ("effects", " + ".join(d.effects)),
        ("ambiguity", " ".join(d.ambiguity)),
        ("probability [-]", float(sum(d.probabilities.get(name, 0.0) for name in answer))),
        ("largest_reduction [-]", max((g.reduction for g in d.gap.values()), default=0.0)),
        ("seconds [s]", round(d.seconds, 3)),
    )
