"""Point and frame above a table of forces."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.io.text.wrench_head import read_wrench_head

TABLE = "time [s],fx [N]\n0,1\n"


def head(folder: Path, text: str) -> tuple[list[float] | None, str | None]:
    path = folder / "model.csv"
    path.write_text(text, encoding="utf-8")
    found = read_wrench_head(path)
    return None if found.point is None else found.point.tolist(), found.frame


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", (None, None)),
        ("# point_mm = 1, -20, 3e2\n# frame = of thigh.stl; forces are those of the mat on the body\n",
         ([0.001, -0.02, 0.3], "of thigh.stl")),
        ("#frame=ground\n#  point_mm=0,0,0\n", ([0.0, 0.0, 0.0], "ground")),
        ("# made by hand\n# frame = pelvis\n", (None, "pelvis")),
        ("# frame =\n", (None, None)),
    ],
)  # fmt: skip
def test_what_is_said_is_read(tmp_path: Path, text: str, expected: tuple[list[float] | None, str | None]) -> None:
    point, frame = head(tmp_path, text + TABLE)
    assert frame == expected[1]
    assert point == (None if expected[0] is None else pytest.approx(expected[0], rel=1e-12))


def test_a_line_below_the_columns_says_nothing(tmp_path: Path) -> None:
    assert head(tmp_path, TABLE + "# frame = pelvis\n") == (None, None)


@pytest.mark.parametrize("text", ["1, 2", "here", "1, 2, nan", ""])
def test_a_point_that_is_none_is_refused_with_its_line(tmp_path: Path, text: str) -> None:
    with pytest.raises(InputError, match="line 2: point_mm is"):
        head(tmp_path, f"# frame = a\n# point_mm = {text}\n{TABLE}")


def test_a_byte_order_mark_is_no_part_of_the_line(tmp_path: Path) -> None:
    point, _ = head(tmp_path, "\ufeff# point_mm = 7, 8, 9\n" + TABLE)
    np.testing.assert_allclose(point or [], [0.007, 0.008, 0.009])


def test_run_json_beside_the_table_says_it_where_no_line_does(tmp_path: Path) -> None:
    told = {"tables": {"model.csv": {"point_mm": [-4.0, 45.0, 0.0], "frame": "thigh"}}}
    (tmp_path / "run.json").write_text(json.dumps(told), encoding="utf-8")
    point, frame = head(tmp_path, TABLE)
    assert point == pytest.approx([-0.004, 0.045, 0.0]) and frame == "thigh"
    assert head(tmp_path, "# frame = pelvis\n" + TABLE) == (None, "pelvis")


@pytest.mark.parametrize("text", ["", "{", "[]", '{"tables": {}}', '{"tables": {"model.csv": 3}}'])
def test_a_run_json_of_something_else_says_nothing(tmp_path: Path, text: str) -> None:
    (tmp_path / "run.json").write_text(text, encoding="utf-8")
    assert head(tmp_path, TABLE) == (None, None)
