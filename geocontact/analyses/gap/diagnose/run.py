"""The diagnosis of one gap case."""

from __future__ import annotations

from geocontact.analyses.gap.case_with_model import CaseWithModel
from geocontact.analyses.gap.diagnose.options import DiagnoseOptions
from geocontact.analyses.gap.diagnose.result import DiagnoseResult
from geocontact.analyses.gap.diagnose.words import untried_law, verdict_sentences
from geocontact.analyses.run_record import Record
from geocontact.data.version import VERSION
from geocontact.gap.diagnose import diagnose


def run(given: CaseWithModel, o: DiagnoseOptions, record: Record) -> DiagnoseResult:
    """Diagnosis, and what is found in words."""
    with record.listener.stages(o.case.resolve().name) as at:
        findings = diagnose(given.case, given.system, VERSION, at)
    record.results["diagnosis"] = {
        "verdict": findings.diagnosis.verdict,
        "effects": list(findings.diagnosis.effects),
        "seconds": round(findings.diagnosis.seconds, 3),
    }
    for sentence in verdict_sentences(findings.diagnosis, findings.cells):
        record.say(sentence)
    untried = untried_law(findings.diagnosis, given.system)
    if untried is not None:
        record.warn(untried)
    return DiagnoseResult(record=record, options=o, case=given.case, findings=findings)
