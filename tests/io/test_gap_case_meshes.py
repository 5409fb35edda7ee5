"""Surfaces of a gap case: read in their unit from inside its folder, refused in one line when they cannot be."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from geocontact.data.errors import InputError
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.cases.gap_case_writer import write_gap_case
from geocontact.io.mesh.meshes import read_mesh
from tests.io.gap_case_files import CASE, case_in

SPHERE = Path(__file__).resolve().parents[2] / "meshes" / "sphere_r18.stl"


def with_mesh(folder: Path, lines: str) -> Path:
    """A case whose case.toml says `lines` under [mesh.ball], a sphere of 18 mm beside it."""
    home = case_in(folder, case=f"{CASE['case.toml']}\n[mesh.ball]\n{lines}\n")
    (home / "surfaces").mkdir()
    shutil.copy(SPHERE, home / "surfaces" / "ball.stl")
    return home


def test_a_mesh_comes_in_metres_with_its_region_and_hash(tmp_path: Path) -> None:
    home = with_mesh(tmp_path, 'file = "surfaces/ball.stl"\nunit = "mm"\nregion = "nz > 0.5"')
    one = read_gap_case(home).meshes["ball"]
    same = read_mesh(SPHERE, "mm")
    assert one.mesh.vertices.max() == pytest.approx(0.018, rel=1e-3)
    assert (one.region, one.metres_per_number, one.mesh.sha256) == ("nz > 0.5", 1e-3, same.sha256)


def test_a_case_without_meshes_has_none(tmp_path: Path) -> None:
    assert read_gap_case(case_in(tmp_path)).meshes == {}


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ('file = "surfaces/ball.stl"', r"mesh.ball: no key 'unit'; keys here are file, unit, region"),
        (
            'file = "surfaces/ball.stl"\nunit = "mm"\nface = "x"',
            r"unknown key 'face'; keys here are file, unit, region",
        ),
        (
            'file = "surfaces/ball.stl"\nunit = "furlong"',
            r"mesh.ball.unit: is 'furlong'; input should be 'm', 'cm', 'mm' or 'in'",
        ),
        ('file = "surfaces/ball.stl"\nunit = "m"', r"ball.stl: .* looks like millimetres"),
        ('file = "surfaces/none.stl"\nunit = "mm"', r"none.stl"),
        ('file = "../ball.stl"\nunit = "mm"', r"\[mesh.ball\] file: '../ball.stl' cannot be used; name a .stl"),
        ('file = "trials/t01.csv"\nunit = "mm"', r"'trials/t01.csv' cannot be used; name a .stl .ply"),
        ('file = 3\nunit = "mm"', r"mesh.ball.file"),
    ],
)
def test_what_is_no_mesh_is_refused_in_one_line(tmp_path: Path, lines: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        read_gap_case(with_mesh(tmp_path, lines))
    assert "\n" not in str(caught.value)


def test_a_mesh_that_leads_out_of_the_folder_is_refused(tmp_path: Path) -> None:
    home = with_mesh(tmp_path, 'file = "out.stl"\nunit = "mm"')
    (home / "out.stl").symlink_to(SPHERE)
    with pytest.raises(InputError, match="leads out of the folder of the case"):
        read_gap_case(home)


def test_a_case_with_meshes_is_not_written_without_them(tmp_path: Path) -> None:
    case = read_gap_case(with_mesh(tmp_path, 'file = "surfaces/ball.stl"\nunit = "mm"'))
    with pytest.raises(ValueError, match="a case with meshes is not written"):
        write_gap_case(case, tmp_path / "copy")
    assert not (tmp_path / "copy").exists()
