"""One unit for each kind of quantity in everything that is written, as the reference lists it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.io.text.results import write_table
from geocontact.io.text.units import si_unit
from geocontact.io.text.written_units import CASES, RESULTS, misfits

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "reference" / "written_files.md").read_text(encoding="utf-8")
COLUMN = re.compile(r"\S.* \[[^\[\]]+\]")
SI_FILES = ("gap/diagnose/tables.py", "gap/discriminability/tables.py", "virtual_markers/result.py")
"""Tables about gap cases, and the Python table beside a .trc."""
NAMES = ("tables.py", "result.py", "load_table.py", "recorded.py", "phases.py", "designs.py", "trial_result.py")
"""Modules that make tables."""
BOTH = "mat/tables.py"
"""Has tables of results and of gap cases; which are which is asked when they are written."""


@pytest.mark.parametrize(
    ("column", "fits"),
    [
        ("depth [mm]", True),
        ("depth [m]", False),
        ("area [cm^2]", False),
        ("peak [kPa]", False),
        ("angle [rad]", False),
        ("start [ms]", False),
        ("cycle [%]", True),
        ("share [%]", False),
        ("gain [nats]", True),
        ("side", True),
    ],
)
def test_a_column_fits_or_not(column: str, fits: bool) -> None:
    assert (misfits([column], RESULTS) == []) == fits


def test_tables_of_gap_cases_are_in_si() -> None:
    assert misfits(["x [mm]", "area [m^2]", "c0 [kPa]", "pitch [rad]"], CASES) == ["x [mm]", "c0 [kPa]"]


def test_a_table_in_another_unit_is_not_written(tmp_path: Path) -> None:
    """All commands write through `write_table`, so that every test of a command asks this of its tables."""
    with pytest.raises(ValueError, match=r"depths: depth \[m\]: not the unit"):
        write_table(pd.DataFrame({"depth [m]": np.zeros(2)}), tmp_path, "depths")
    assert list(tmp_path.iterdir()) == []


def columns_in(file: Path) -> Iterator[str]:
    """Texts of a module that look like the header of a column with a unit."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        text = ast.unparse(node)[2:-1] if isinstance(node, ast.JoinedStr) else getattr(node, "value", None)
        if isinstance(text, str) and COLUMN.fullmatch(text) and len(text) < 50:
            yield text


def test_no_analysis_names_a_column_in_another_unit() -> None:
    found = (file for name in NAMES for file in (ROOT / "geocontact" / "analyses").rglob(name))
    files = [file for file in found if not file.as_posix().endswith(BOTH)]
    odd = {
        file.as_posix(): found
        for file in files
        if (found := misfits(columns_in(file), CASES if file.as_posix().endswith(SI_FILES) else RESULTS))
    }
    assert sum(1 for file in files for _ in columns_in(file)) > 100 and odd == {}


def test_the_page_lists_the_units() -> None:
    rows = re.findall(r"^\| ([^|]+) \| `([^`|]+)` \| `([^`|]+)` \|$", PAGE, re.MULTILINE)
    told = {known[0]: result for _, result, case in rows if (known := si_unit(case)) and case == known[0]}
    assert told == dict(RESULTS), "kind of quantity, unit of results, unit in gap cases (SI)"
