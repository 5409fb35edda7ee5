"""The trials of a study, as its description names them."""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.analyses.run_record import Record
from geocontact.study.description.study_file import StudyFile, read_study_file
from geocontact.study.description.trials import CohortTrial, trials_of
from geocontact.study.options import CohortOptions


@dataclass(frozen=True)
class PlannedStudy:
    """The description, and the trials that it comes to."""

    file: StudyFile
    trials: tuple[CohortTrial, ...]


def read(o: CohortOptions, record: Record) -> PlannedStudy:
    """Description and trials; files of the trials are read by whoever evaluates them."""
    study = read_study_file(o.study)
    record.add_input("study", o.study, analysis=study.analysis)
    if study.table:
        record.add_input("table", o.study.parent / study.table)
    return PlannedStudy(study, tuple(trials_of(study)))
