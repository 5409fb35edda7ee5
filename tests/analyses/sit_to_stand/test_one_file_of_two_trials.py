"""One file of two trials: a copy where they are at one time, a whole session's where they follow each other."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.sit_to_stand.standing_trials import _warn_of_copies
from geocontact.io.recordings.standing_study import StandingTrialFiles


def clocked(file: Path, start: float, end: float) -> Path:
    """A table of 100 Hz whose values are of this file alone."""
    time = np.arange(round(100 * start), round(100 * end) + 1) / 100.0
    rows = "\n".join(f"{each},{each + len(file.name)}" for each in time)
    file.write_text(f"time [s],normal [N]\n{rows}\n", encoding="utf-8")
    return file


def said(folder: Path, clocks: list[tuple[float, float]], strap: tuple[float, float], **of_second: float) -> list[str]:
    """Warnings of two trials of one strap file."""
    file = clocked(folder / "strap.csv", *strap)
    trials = [
        StandingTrialFiles.model_construct(
            name=f"T{k}", coordinates=clocked(folder / f"T{k}.csv", *clock), strap=(file,), **(of_second if k else {})
        )
        for k, clock in enumerate(clocks)
    ]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        _warn_of_copies(trials)
    return [str(each.message) for each in caught]


@pytest.mark.parametrize(
    ("clocks", "strap", "of_second", "count"),
    [
        ([(0.0, 2.0), (0.0, 2.5)], (0.0, 2.0), {}, 1),
        ([(0.0, 2.0), (10.0, 12.0)], (0.0, 30.0), {}, 0),
        ([(0.0, 2.0), (0.0, 30.0)], (0.0, 30.0), {"start": 10.0, "end": 12.0}, 0),
        ([(0.0, 2.0), (0.0, 30.0)], (0.0, 2.0), {"start": 10.0, "end": 12.0}, 1),
    ],
    ids=["own clocks", "one session", "one session, cut", "a file of the first alone"],
)
def test_a_session_may_have_one_file(
    tmp_path: Path,
    clocks: list[tuple[float, float]],
    strap: tuple[float, float],
    of_second: dict[str, float],
    count: int,
) -> None:
    assert sum("its strap is that of T0" in line for line in said(tmp_path, clocks, strap, **of_second)) == count
