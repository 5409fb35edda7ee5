"""The case of a diagnosis."""

from __future__ import annotations

from geocontact.analyses.gap.case_with_model import CaseWithModel, read_case
from geocontact.analyses.gap.diagnose.options import DiagnoseOptions
from geocontact.analyses.run_record import Record


def read(o: DiagnoseOptions, record: Record) -> CaseWithModel:
    """Case and base model."""
    return read_case(o.case, o.run_simulator, record)
