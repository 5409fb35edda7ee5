"""Which side of the mat and of the scan: what is refused, what is told, what `inwards` does. Synthetic recordings."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import trimesh

from geocontact.analyses.mat.result import MatResult
from geocontact.data.errors import InputError
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.lay import lay
from tests.analyses.mat.samples import FORCE, MOMENT, THIGH, called, refusal
from tests.cli.calls import MESHES, written


@pytest.fixture(scope="module")
def shells(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The front of the thigh as open scans: as it is, and with its faces turned over; and five frames of the mat."""
    folder = tmp_path_factory.mktemp("shells")
    whole = trimesh.load(MESHES / "thigh.stl", process=True)
    front = whole.triangles_center[:, 0] > -0.02e3
    for name, faces in (("outwards", whole.faces[front]), ("inwards", whole.faces[front][:, ::-1])):
        trimesh.Trimesh(whole.vertices, faces, process=False).export(folder / f"{name}.stl")
    pd.read_csv(THIGH / "frames.csv").iloc[70:75].to_csv(folder / "frames.csv", index=False)
    return folder


def mat(shells: Path, scan: str, **options: Any) -> MatResult:
    files = {"layout": THIGH / "layout.toml", "landmarks": THIGH / "landmarks.csv", "surface": shells / f"{scan}.stl"}
    return called(shells / "frames.csv", **{**files, **options})


def hollow(result: MatResult) -> list[str]:
    return [line for line in result.warnings if "hollow under the mat" in line]


def test_a_scan_that_looks_inwards_is_refused_and_turned_over_when_it_is_said(shells: Path) -> None:
    right = mat(shells, "outwards").table()[FORCE + MOMENT]
    with pytest.raises(InputError, match=r"do the faces look inwards\?.* `inwards` where faces look into the body"):
        mat(shells, "inwards")
    turned = mat(shells, "inwards", inwards=True)
    np.testing.assert_array_equal(turned.force, turned.table()[FORCE])
    np.testing.assert_allclose(1e6 * turned.area, turned.table()["area [mm^2]"])
    np.testing.assert_array_equal(turned.normal_force, turned.table()["normal [N]"])
    np.testing.assert_allclose(turned.table()[FORCE + MOMENT], right, rtol=1e-6, atol=1e-6)
    assert not hollow(turned)


def test_a_scan_that_is_hollow_under_the_mat_is_told(shells: Path) -> None:
    """The wrong way out of the refusal: the mat is said to be seen from the body."""
    (line,) = hollow(mat(shells, "inwards", seen_from="body"))
    assert line.endswith("pass `inwards` then")


def test_landmarks_on_one_line_do_not_show_the_side(shells: Path, tmp_path: Path) -> None:
    head, *rows = (THIGH / "landmarks.csv").read_text("utf-8").splitlines()
    edge = [row for row in rows if row.split(",")[2].strip() == "0"]
    line = written(tmp_path / "line.csv", "\n".join([head, *edge]) + "\n")
    (said,) = (text for text in mat(shells, "outwards", landmarks=line).warnings if "on one line of the mat" in text)
    assert said.endswith("`seen_from` outside is used")
    assert not [text for text in mat(shells, "outwards").warnings if "one line" in text]


def test_inwards_has_no_effect_on_a_closed_scan(shells: Path) -> None:
    with refusal("`inwards`: has no effect on a closed scan: its sides are known"):
        mat(shells, "outwards", surface=MESHES / "thigh.stl", inwards=True)


def test_a_mark_that_is_far_off_is_refused_beside_one_that_hangs_over_the_edge(
    shells: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A mark over the edge has no distance; it must not hide how far another is missed."""

    def laid(*given: object) -> Drape:
        found = lay(*given)
        return replace(found, misses=np.array([np.nan, 0.2, *found.misses[2:]]))

    monkeypatch.setattr("geocontact.analyses.mat.placed.lay", laid)
    with refusal("landmark L2 is missed by 200 mm"):
        mat(shells, "outwards")
