"""What a design starts from beside its numbers."""

from __future__ import annotations

from geocontact.analyses.misalignment.design.options import DesignOptions
from geocontact.analyses.misalignment.drift import axis_drift
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.axis_drift import AxisDrift


def read(o: DesignOptions, record: Record) -> AxisDrift:
    """How the joint's axis drifts."""
    return axis_drift(record, o.drift, o.range)
