"""File names are text: whatever is in them, they are found, shown as they are, and never run."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.cli.calls import PLATE, SPHERE, area, call, done, inventory, poses, shifted, written
from tests.contract import FILES

NAMES = [
    r"$\frac$",
    "<script>alert(1)</script>".replace("/", "∕"),
    "膝関節 🦵",
    "line\nbreak",
]
"""Names that break most programs."""

MORE = [
    "two words",
    "it's 5'",
    'say "cheese"',
    "cost $5 or $x",
    "$HOME `id` $(id)",
    "a&b;c|d",
    "100% {name} %s {0}",
    "Ünïcode – Ελλάδα ≤ Ж",
    "\u202egpj.exe",
    "-x",
    "--unit=m",
    "#1,2;3=4",
    "[a]*?",
    ".hidden",
    "x" * 200,
]


@pytest.mark.filterwarnings("default:Glyph .* missing from font")
@pytest.mark.parametrize("name", [*NAMES, *(pytest.param(name, marks=pytest.mark.slow) for name in MORE)])
def test_any_file_name_will_do(tmp_path: Path, name: str) -> None:
    """Meshes, motion, model, placement and result folder of that name, with the picture whose title shows it."""
    try:
        moving, fixed = (shutil.copy(mesh, tmp_path / f"{name}{k}.stl") for k, mesh in enumerate((SPHERE, PLATE)))
    except OSError as error:
        pytest.skip(f"no file system for this name: {error.strerror}")
    place = shifted(tmp_path, (0, 20, 0), f"{name}.txt")
    motion = poses(tmp_path, (0, 0, 0), name=f"{name}.csv")
    out = tmp_path / "results" / name
    result = done(
        area(out, f"--place-moving={place}", moving=Path(moving), fixed=Path(fixed), motion=motion, picture=True)
    )
    assert result.warnings == []
    assert set(inventory(tmp_path / "results")) == {
        name,
        *(f"{name}/{f}" for f in FILES),
    }
    inputs = result.record()["inputs"]
    assert [Path(entry["file"]).name for entry in inputs if entry["role"] == "moving"] == [f"{name}0.stl"]
    assert b"<script" not in result.bytes("area.svg")
    assert b"<script>alert" not in result.bytes("report.html")


@pytest.mark.parametrize("name", ["two words", "$x$", "line\nbreak", "-x", "膝"])
def test_refusals_name_the_file_in_one_line(tmp_path: Path, name: str) -> None:
    moving = written(tmp_path / f"{name}.stl", "")
    result = area(tmp_path / "out", moving=moving, fixed=PLATE, motion=poses(tmp_path, (0, 20, 0)))
    assert result.code == 2
    (line,) = result.complaints
    assert " ".join(f"{name}.stl".split()) in line


@pytest.mark.slow
def test_relative_names_that_look_like_options(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(SPHERE, "-x.stl")
    shutil.copy(PLATE, "--unit.stl")
    poses(Path(), (0, 20, 0), name="-m.csv")
    arguments = ["area", "./-x.stl", "./--unit.stl", "--unit=mm", "--motion", "./-m.csv", "--out", "./-out"]
    done(call(*arguments))
    assert "area.csv" in inventory(Path("-out"))


def test_motion_names_cannot_leave_the_result_folder(tmp_path: Path) -> None:
    """Sub-folders are named after the files, not after the paths that were typed."""
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    first = poses(tmp_path / "a", (0, 20, 0), name="..csv")
    second = poses(tmp_path / "b", (0, 20, 0), name="...csv")
    third = poses(tmp_path, (0, 20, 0), name="run.json.csv")
    before = set(inventory(tmp_path))
    given = [f"--motion={tmp_path}/a/../b/{second.name}", f"--motion={first}", f"--motion={third}"]
    result = area(tmp_path / "out/deep", *given, moving=SPHERE, fixed=PLATE)
    after = {p for p in inventory(tmp_path) if not p.startswith("out/deep")} - {"out"}
    assert after == before, "something was written beside the result folder"
    assert result.code in (0, 2), result.err
    assert len(result.complaints) == (1 if result.code else 0)
