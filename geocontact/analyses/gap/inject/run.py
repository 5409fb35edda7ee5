"""A known effect in somebody's own trials: put in, written, read again, diagnosed."""

from __future__ import annotations

import shutil
from pathlib import Path

from geocontact.analyses.gap.case_with_model import CaseWithModel
from geocontact.analyses.gap.diagnose.options import DiagnoseOptions
from geocontact.analyses.gap.diagnose.read import read as read_diagnosis
from geocontact.analyses.gap.diagnose.result import DiagnoseResult
from geocontact.analyses.gap.diagnose.run import run as run_diagnosis
from geocontact.analyses.gap.inject.answer import answer
from geocontact.analyses.gap.inject.effect import planted
from geocontact.analyses.gap.inject.judged import judged
from geocontact.analyses.gap.inject.options import InjectOptions
from geocontact.analyses.gap.inject.result import CASE, DIAGNOSIS, InjectResult
from geocontact.analyses.gap.inject.words import sentences
from geocontact.analyses.results_folder import Scratch
from geocontact.analyses.run_record import Record
from geocontact.gap.diagnose import diagnose
from geocontact.io.cases.gap_case_writer import write_trials

LEAST = 0.5  # of the size that was asked for, from which a bound of the amplitude deserves a word


def run(given: CaseWithModel, o: InjectOptions, record: Record) -> InjectResult:
    """The case with the effect in it, and its diagnosis as from a folder, to the digits printed there.

    The case without it is diagnosed first: what it lacks anyway is not found because of what was injected.
    """
    one, made = planted(given, o)
    with record.listener.stages("the case without it") as at:
        before = diagnose(given.case, given.system, at=at).diagnosis
    scratch = Scratch()
    shutil.copytree(given.folder, scratch.folder / CASE)
    write_trials(made.case, scratch.folder / CASE)
    if given.case.cells:
        record.warn("cells of mats are left as they were: they do not show the effect")
    found = _diagnosed(scratch.folder / CASE, o, record)
    judgement = judged(one, made, before, found.diagnosis)
    result = InjectResult(
        record=record, options=o, effect=one, planted=made, diagnosed=found, judgement=judgement, scratch=scratch
    )
    record.results["planted"] = answer(one, made, found.diagnosis, judgement)
    for sentence in sentences(one, made, found.diagnosis, judgement):
        record.say(sentence)
    if made.size < LEAST * o.size and not (one.parameters and one.parameters[0].name in o.value):
        record.warn("the amplitude is as large as its bounds admit; base parameters imitate the rest")
    record.say(found.sentences[0])
    return result


def _diagnosed(home: Path, o: InjectOptions, record: Record) -> DiagnoseResult:
    """Diagnosis with a record of its own, which names files as they will lie beside it."""
    out = Path(str(record.options.get("out", "")))
    options = DiagnoseOptions(home, bare=o.bare, run_simulator=o.run_simulator)
    typed = {"case": out / CASE, "out": out / DIAGNOSIS, "bare": o.bare}
    own = Record("gap diagnose", typed, options.in_si() | {"case": out / CASE}, listener=record.listener)
    with own.catching_warnings():
        found = run_diagnosis(read_diagnosis(options, own), options, own)
    for entry in own.inputs:
        entry["file"] = str(entry["file"]).replace(str(home), str(out / CASE), 1)
    return found
