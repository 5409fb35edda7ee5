"""One unit for each kind of quantity in everything that is written, as the reference lists it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.io.text.results import CASES, RESULTS, misfits, write_table
from geocontact.io.text.units import si_unit

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "reference" / "written_files.md").read_text(encoding="utf-8")
COLUMN = re.compile(r"\S.* \[[^\[\]]+\]")
MAKES_TABLES = re.compile(r"\bpd\.(DataFrame|concat)\(|\bDataFrame\(")
"""What a module that makes tables has."""
OF_FIGURES = "[°]"
"""Degrees on the axes of figures; columns have deg, and one in ° could not be written."""
IN_SI = (
    "area/pose_error.py",
    "cop/foot.py",
    "gap/diagnose/answer.py",
    "gap/discriminability/answer.py",
    "mat/loads.py",
    "prosthesis/stance_files.py",
    "shoulder/compare/result.py",
    "sit_to_stand/exports.py",
    "virtual_markers/result.py",
)
"""Modules that have columns in SI as well: of tables that are read, of gap cases, of the table beside a .trc."""


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
        if isinstance(text, str) and COLUMN.fullmatch(text) and len(text) < 50 and not text.endswith(OF_FIGURES):
            yield text


def test_no_analysis_names_a_column_in_another_unit() -> None:
    modules = (ROOT / "geocontact" / "analyses").rglob("*.py")
    files = [file for file in modules if MAKES_TABLES.search(file.read_text(encoding="utf-8"))]
    odd = {}
    for file in files:
        names = misfits(columns_in(file), RESULTS)
        if file.as_posix().endswith(IN_SI):
            names = misfits(names, CASES)
        if names:
            odd[file.as_posix()] = names
    assert sum(1 for file in files for _ in columns_in(file)) > 100 and odd == {}


def test_the_page_lists_the_units() -> None:
    rows = re.findall(r"^\| ([^|]+) \| `([^`|]+)` \| `([^`|]+)` \|$", PAGE, re.MULTILINE)
    told = {known[0]: result for _, result, case in rows if (known := si_unit(case)) and case == known[0]}
    assert told == dict(RESULTS), "kind of quantity, unit of results, unit in gap cases (SI)"
