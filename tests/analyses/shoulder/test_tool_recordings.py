"""Recordings of the tool: samples of a current are evenly spaced, events come when they come."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.frame.collector import collecting
from geocontact.analyses.frame.record import Record
from geocontact.analyses.shoulder.recordings import tool_current, tool_runs

TIME = np.linspace(0.0, 30.0, 3001)
AT = [0.0, 2.0, 2.5, 4.0, 4.2, 6.0, 7.5, 9.0, 10.0, 20.0, 21.0, 25.0, 29.5]
"""s, of thirteen events with nothing in between."""


def warned(reads: str, folder: Path, column: str) -> list[str]:
    """What is said of thirteen samples of a column that alternates between 0 and 1 [A, -]."""
    file = folder / "tool.csv"
    pd.DataFrame({"time [s]": AT, column: [float(k % 2) for k in range(len(AT))]}).to_csv(file, index=False)
    with collecting(Record("test", {})) as record:
        if reads == "current":
            tool_current(file, TIME)
        else:
            tool_runs(file, 0.5, TIME)
    return [str(each) for each in record.warnings]


@pytest.mark.parametrize("reads", ["current", "runs"])
def test_events_are_not_samples(reads: str, tmp_path: Path) -> None:
    """The same thirteen times are too few for a current."""
    assert not warned(reads, tmp_path, "event [-]")
    assert [line for line in warned(reads, tmp_path, "current [A]") if "samples in a second" in line]
