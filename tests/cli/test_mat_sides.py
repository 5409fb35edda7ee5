"""Which side of the mat and of the scan: what is refused, what is told, what --inwards does. Synthetic recordings."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import trimesh

from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.lay import lay
from tests.cli.calls import MESHES, Call, call, done

HOME = MESHES / "mat_thigh_16x8"
ANSWER = ("fx [N]", "fy [N]", "fz [N]", "mx [N m]", "my [N m]", "mz [N m]")


@pytest.fixture(scope="module")
def shells(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The front of the thigh as open scans: as it is, and with its faces turned over; and five frames of the mat."""
    folder = tmp_path_factory.mktemp("shells")
    whole = trimesh.load(MESHES / "thigh.stl", process=True)
    front = whole.triangles_center[:, 0] > -0.02e3
    found = {}
    for name, faces in (("outwards", whole.faces[front]), ("inwards", whole.faces[front][:, ::-1])):
        found[name] = folder / f"{name}.stl"
        trimesh.Trimesh(whole.vertices, faces, process=False).export(found[name])
    frames = pd.read_csv(HOME / "frames.csv")
    found["frames"] = folder / "frames.csv"
    frames.iloc[70:75].to_csv(found["frames"], index=False)
    return found


def mat(shells: dict[str, Path], scan: str, out: Path, *options: object, marks: Path = HOME / "landmarks.csv") -> Call:
    return call(
        "mat", shells["frames"], "--layout", HOME / "layout.toml", "--surface", shells[scan], "--unit", "mm",
        "--landmarks", marks, "--cutoff", 0, "--out", out, *options,
    )  # fmt: skip


def wrench(result: Call, out: Path) -> np.ndarray:
    done(result)
    return pd.read_csv(out / "wrench.csv", comment="#")[list(ANSWER)].to_numpy(float)


def test_a_scan_that_looks_inwards_is_refused_and_turned_over_when_it_is_said(
    shells: dict[str, Path], tmp_path: Path
) -> None:
    right = wrench(mat(shells, "outwards", tmp_path / "a"), tmp_path / "a")
    wrong = mat(shells, "inwards", tmp_path / "b")
    assert wrong.code == 2 and len(wrong.complaints) == 1
    assert "do the faces look inwards?" in wrong.err and "--inwards where faces look into the body" in wrong.err
    turned = mat(shells, "inwards", tmp_path / "c", "--inwards")
    np.testing.assert_allclose(wrench(turned, tmp_path / "c"), right, rtol=1e-6, atol=1e-6)
    assert not [line for line in turned.warnings if "hollow" in line]


def test_a_scan_that_is_hollow_under_the_mat_is_told(shells: dict[str, Path], tmp_path: Path) -> None:
    """The wrong way out of the refusal: the mat is said to be seen from the body."""
    result = done(mat(shells, "inwards", tmp_path / "a", "--seen-from", "body"))
    assert [line for line in result.warnings if "hollow under the mat" in line and "--inwards" in line]


def test_landmarks_on_one_line_do_not_show_the_side(shells: dict[str, Path], tmp_path: Path) -> None:
    rows = (HOME / "landmarks.csv").read_text("utf-8").splitlines()
    line = tmp_path / "line.csv"
    line.write_text(
        "\n".join([rows[0], *(row for row in rows[1:] if row.split(",")[2].strip() == "0")]) + "\n", "utf-8"
    )
    result = done(mat(shells, "outwards", tmp_path / "a", marks=line))
    (said,) = [text for text in result.warnings if "on one line of the mat" in text]
    assert said.endswith("--seen-from outside is believed")
    assert not [text for text in done(mat(shells, "outwards", tmp_path / "b")).warnings if "one line" in text]


def test_inwards_is_nothing_for_a_closed_scan(shells: dict[str, Path], tmp_path: Path) -> None:
    result = mat(shells | {"closed": MESHES / "thigh.stl"}, "closed", tmp_path / "a", "--inwards")
    assert result.code == 2 and "--inwards: does nothing for a closed scan" in result.err


def test_a_mark_that_is_far_off_is_refused_beside_one_that_hangs_over_the_edge(
    shells: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A mark over the edge has no distance; it must not hide how far another is missed."""

    def laid(*given: object) -> Drape:
        found = lay(*given)
        return replace(found, misses=np.array([np.nan, 0.2, *found.misses[2:]]))

    monkeypatch.setattr("geocontact.analyses.mat.run.lay", laid)
    result = mat(shells, "outwards", tmp_path / "a")
    assert result.code == 2 and "landmark L2 is missed by 200 mm" in result.err
