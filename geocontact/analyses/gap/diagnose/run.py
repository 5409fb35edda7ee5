"""The diagnosis of one gap case: reads, computes, writes, says what it found."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

from geocontact.analyses.gap.diagnose.words import verdict_sentences
from geocontact.analyses.gap.diagnose.write import write_results
from geocontact.analyses.progress import stages
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.cli.gap_diagnose import DiagnoseOptions
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.version import VERSION
from geocontact.gap.attribute import Listener, nobody
from geocontact.gap.diagnose import Findings, diagnose
from geocontact.io.cases.case_cells import cells_file
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.systems.catalogue import system_of

COMMAND = "gap diagnose"


def diagnose_one(folder: Path, o: DiagnoseOptions) -> int:
    """Run the whole diagnosis of one case."""
    if o.workers is not None:
        raise InputError("", "--workers", "does nothing without --many", "leave it out")
    record = Record(COMMAND, {"case": folder, **asdict(o)})
    with record.catching_warnings(), written_whole(o.out) as draft:
        with stages(folder.resolve().name) as at:
            findings = diagnosed(record, folder, draft, o, at)
        written = sorted(file.name for file in draft.iterdir())
    for sentence in verdict_sentences(findings.diagnosis, findings.cells):
        record.say(sentence)
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def diagnosed(record: Record, folder: Path, draft: Path, o: DiagnoseOptions, at: Listener = nobody) -> Findings:
    """Diagnosis of the case in a folder, its results in `draft`; `at` is told what is being done."""
    at("reading")
    case = read_gap_case(folder, run_programs=o.run_simulator)
    system = system_of(case)
    add_inputs(record, folder, case)
    findings = diagnose(case, system, VERSION, at)
    record.results["diagnosis"] = {
        "verdict": findings.diagnosis.verdict,
        "effects": list(findings.diagnosis.effects),
        "seconds": round(findings.diagnosis.seconds, 3),
    }
    at("figures and page" if not o.bare else "tables")
    write_results(record, case, findings, draft, pictures=not o.bare)
    record.write(draft)
    return findings


def add_inputs(record: Record, folder: Path, case: GapCase) -> None:
    """What was read: case.toml, the tables that lie beside it, the trials, and the meshes."""
    record.add_input("case", folder / "case.toml", system=case.system)
    for side, trials in (("calibration", case.calibration), ("evaluation", case.evaluation)):
        for trial in trials:
            record.add_input(side, folder / "trials" / f"{trial.name}.csv", samples=len(trial))
    for file in sorted(folder.glob("*.csv")):
        record.add_input("table", file)
    for site, cells in case.cells.items():
        for name in cells.trials:
            record.add_input(f"cells {site}", cells_file(folder, name, site), cells=len(cells.ids))
    for name, one in case.meshes.items():
        record.add_input(f"mesh {name}", one.mesh.name, sha256=one.mesh.sha256, unit=one.mesh.unit)
