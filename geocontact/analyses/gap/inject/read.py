"""The case that an effect is put into."""

from __future__ import annotations

from pathlib import Path

from geocontact.analyses.gap.case_with_model import CaseWithModel, read_case
from geocontact.analyses.gap.inject.options import InjectOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError


def read(o: InjectOptions, record: Record) -> CaseWithModel:
    """Case and base model; results do not go into the folder that is copied."""
    out = record.options.get("out")
    if isinstance(out, Path) and o.case.resolve() in (out.resolve(), *out.resolve().parents):
        raise InputError(out, "", "lies inside the case that is copied there", "`out` names a folder beside the case")
    return read_case(o.case, o.run_simulator, record)
