"""`geocontact mat --scan-with-mat`: landmarks from a synthetic second scan instead of a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import trimesh

from tests.cli.calls import MESHES, Call, call, done
from tests.geometry.drape.second_scan import corners, with_mat

GIVEN = MESHES / "mat_thigh_16x8"
FORCE, CENTRE = [f"f{a} [N]" for a in "xyz"], [f"cop_{a} [mm]" for a in "xyz"]


@pytest.fixture(scope="module")
def second(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scan with a mat of 3 mm on it, noisy by 0.2 mm."""
    file = tmp_path_factory.mktemp("second") / "thigh_with_mat.stl"
    scan = with_mat(3.0, 0.2)
    trimesh.Trimesh(1e3 * scan.vertices, scan.faces, process=False).export(file)
    return file


def mat(folder: Path, *options: object) -> Call:
    return call(
        "mat", GIVEN / "frames.csv", "--layout", GIVEN / "layout.toml", "--surface", MESHES / "thigh.stl", "--unit",
        "mm", "--cutoff", "0", "--out", folder / "out", *options, folder=folder / "out",
    )  # fmt: skip


def near(corner: int) -> str:
    """Some millimetres beside a true corner."""
    return ",".join(f"{x:.1f}" for x in 1e3 * corners()[corner] + [3.0, -4.0, 2.0])


def test_the_mat_is_found_and_gives_the_wrench_of_its_closed_form(tmp_path: Path, second: Path) -> None:
    result = done(mat(tmp_path, "--scan-with-mat", second, "--first-corner", near(0)))
    told = result.record()["results"]["second scan"]
    assert told["mat_thickness_mm"] == pytest.approx(3.0, abs=0.2)
    assert told["mat_mm"] == pytest.approx([226.27, 113.14], abs=0.01)
    missed = np.linalg.norm(np.array(told["corners_mm"])[:, None] - 1e3 * corners()[None], axis=2).min(axis=1)
    assert missed.max() < 1.0
    ours = pd.read_csv(result.folder / "wrench.csv", comment="#")
    truth = pd.read_csv(GIVEN / "truth.csv", comment="#", skipinitialspace=True)
    k = int(truth["normal [N]"].argmax())
    assert np.linalg.norm(ours.loc[k, FORCE] - truth.loc[k, FORCE]) < 0.01 * truth.loc[k, "normal [N]"]
    assert np.linalg.norm(ours.loc[k, CENTRE] - truth.loc[k, CENTRE]) < 1.5
    listed = {each["role"]: each for each in result.record()["inputs"]}
    assert listed["scan with the mat"]["faces"] == 63720


def test_the_other_end_may_be_the_first(tmp_path: Path, second: Path) -> None:
    """The recording turned by half a turn: the load is at the other end, 40 mm and more away."""
    result = done(mat(tmp_path, "--scan-with-mat", second, "--first-corner", near(2)))
    ours = pd.read_csv(result.folder / "wrench.csv", comment="#")
    truth = pd.read_csv(GIVEN / "truth.csv", comment="#", skipinitialspace=True)
    early = int(np.argmax(truth["normal [N]"].to_numpy() > 10.0))
    assert truth.loc[early, "cop_y [mm]"] < 0.0 < 40.0 < ours.loc[early, "cop_y [mm]"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ((), "the outline does not tell which corner is that of the first cell; it may be "),
        (("--first-corner", "near 1"), "cannot be that of the first cell"),
        (("--first-corner", "near 0", "--seen-from", "body"), "check the corner and --seen-from"),
        (("--first-corner", "near 0", "--mat-edge", "20mm"), "stands off is 187 × 73 mm, the mat 226 × 113"),
        (("--landmarks", GIVEN / "landmarks.csv"), "says twice where the mat lies"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_one_line(tmp_path: Path, second: Path, options: tuple[object, ...], said: str) -> None:
    given = [near(int(str(each)[-1])) if str(each).startswith("near ") else each for each in options]
    refused(mat(tmp_path, "--scan-with-mat", second, *given), said)


def test_one_of_the_ways_is_needed(tmp_path: Path) -> None:
    refused(mat(tmp_path), "nothing says where the mat lies")
    refused(mat(tmp_path, "--scan-with-mat", MESHES / "thigh.stl"), "is the mat on it?")
    refused(
        mat(tmp_path, "--landmarks", GIVEN / "landmarks.csv", "--mat-edge", "3mm"),
        "does nothing without --scan-with-mat",
    )
    refused(mat(tmp_path, "--landmarks", GIVEN / "landmarks.csv", "--first-corner", "1,2,3"), "--first-corner")


def refused(result: Call, said: str) -> None:
    assert result.code == 2, result.err
    assert len(result.complaints) == 1 and said in result.complaints[0], result.err
    assert not result.folder.exists()
