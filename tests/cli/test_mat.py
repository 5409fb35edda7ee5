"""`geocontact mat`: files, run.json, lines and exit codes, as users and outside checks meet them. All synthetic.

What is computed is tested in tests/analyses/mat.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.analyses.mat.samples import LAYOUT, THIGH, flat, frames, marks, on_plane, shipped, uniform, unpictured
from tests.cli.calls import MESHES, Call, call, done, inventory, written

COLUMNS = [
    "time [s]",
    *(f"f{a} [N]" for a in "xyz"),
    *(f"m{a} [N m]" for a in "xyz"),
    "normal [N]",
    "perpendicular [N]",
    "area [mm^2]",
    "peak [Pa]",
    "mean [Pa]",
    *(f"cop_{a} [mm]" for a in "xyz"),
    "saturated [-]",
]
TABLES = {"wrench.csv", "uncertainty.csv", "cells.csv", "frames_cells.csv"}
FILES = TABLES | {"mat_on_surface.vtp", "mat.png", "mat.svg", "report.html", "run.json"}
STILL = ("--cutoff", "0")


def mat(
    folder: Path,
    pressure: np.ndarray,
    *options: object,
    layout: str = LAYOUT,
    unit: str = "mm",
    landmarks: tuple[str, ...] = (),
) -> Call:
    """`geocontact mat` on a plane, into `folder`/out."""
    files = on_plane(folder, layout) | {"landmarks": marks(folder, *landmarks)}
    given = [part for option, file in files.items() for part in (f"--{option}", file)]
    arguments = ("mat", frames(folder, pressure), *given, "--unit", unit, "--out", folder / "out", *options)
    return call(*arguments, folder=folder / "out")


def refused(result: Call, said: str) -> None:
    """One line, exit code 2, nothing left behind."""
    assert result.code == 2, result.err
    assert len(result.complaints) == 1 and said in result.complaints[0], result.err
    assert not result.folder.exists()


def test_contract(tmp_path: Path) -> None:
    result = done(mat(tmp_path, uniform(), *STILL))
    assert {file.name for file in result.folder.iterdir()} == FILES
    told = result.record()["tables"]
    assert set(told) == {"wrench.csv", "uncertainty.csv"}
    assert (told["wrench.csv"]["point_mm"], told["wrench.csv"]["frame"]) == ([0.0, 0.0, 0.0], "of skin.obj")
    ours = pd.read_csv(result.folder / "wrench.csv")
    assert list(ours.columns) == COLUMNS
    np.testing.assert_allclose(ours["fz [N]"], -12.0, rtol=1e-9)
    assert result.bytes("report.html").startswith(b"<!doctype html>") and b"<svg" in result.bytes("mat.svg")
    record = result.record()
    assert (record["command"], set(record["files"])) == ("mat", FILES)
    assert record["results"]["mat"]["uncovered_cells"] == []
    assert (record["options"]["touched"], record["options_si"]["touched [Pa]"]) == ("1kPa", 1000.0)
    assert [each["role"] for each in record["inputs"]] == ["--layout", "frames", "surface", "--landmarks"]
    assert result.out.splitlines()[0].startswith("force up to 12.0 N at 0 s")


def test_python_writes_what_the_command_writes(tmp_path: Path) -> None:
    pressure = uniform(60, 10.0) * np.sin(np.linspace(0.0, 2.0 * np.pi, 60))[:, None, None] ** 2
    model = written(tmp_path / "model.csv", "# frame = thigh\ntime [s],fz [N]\n0,-6\n2,-6\n")
    phases = written(tmp_path / "phases.csv", "name, start [s], end [s]\nfirst, 0, 0.5\n")
    corners = [f"{k},{x},{y},0,{x},{y},5" for k, (x, y) in enumerate(((20, 30), (60, 30), (20, 60)))]
    head = "id, x [mm], y [mm], z [mm], body_x [mm], body_y [mm], body_z [mm]"
    pairs = written(tmp_path / "pairs.csv", "\n".join([head, *corners]) + "\n")
    typed = (
        *("--cutoff", "5", "--unloaded", "0:0.06", "--touched", "2kPa", "--accuracy", "8%", "--gain", "0.03"),
        *("--registration", "1mm,2deg", "--point", "-4,45,0", "--frame", "thigh", "--body-landmarks", pairs),
        *("--segment", "near=x < 40", "--segment", "far=x > 40", "--compare", model, "--phases", phases, "--parquet"),
    )
    by_command = done(mat(tmp_path / "c", pressure, *typed))
    result = flat(
        tmp_path / "p",
        pressure,
        cutoff=5.0,
        unloaded=((0.0, 0.06),),
        touched=2e3,
        accuracy=0.08,
        gain=0.03,
        registration=(1e-3, np.radians(2.0)),
        point="-4,45,0",
        frame="thigh",
        body_landmarks=pairs,
        segment=("near=x < 40", "far=x > 40"),
        compare=model,
        phases=phases,
    )
    with unpictured():
        result.write(tmp_path / "p" / "out")
    theirs, ours = inventory(by_command.folder), inventory(tmp_path / "p" / "out")
    names = {name for name in ours if name.endswith((".csv", ".vtp"))}
    assert names == {*TABLES, "segments.csv", "registration.csv", "agreement.csv", "mat_on_surface.vtp"}
    assert {name: ours[name] for name in names} == {name: theirs[name] for name in names}
    told = by_command.record()
    assert told["tables"]["wrench.csv"]["point_mm"] == [-4.0, 45.0, 0.0]
    assert {each["frame"] for each in told["tables"].values()} == {"thigh"}
    assert set(told["tables"]) == {"wrench.csv", "uncertainty.csv", "segments.csv"}
    assert told["results"]["uncertainty"]["place"] == "--registration"
    assert {**told["results"], "uncertainty": None} == {**result.record.results, "uncertainty": None}
    assert [line.replace("`unloaded`", "--unloaded") for line in result.warnings] == told["warnings"]
    pd.testing.assert_frame_equal(pd.read_parquet(by_command.folder / "segments.parquet"), result.table("segments"))


def test_the_page_alone_can_be_written(tmp_path: Path) -> None:
    page = shipped().page(tmp_path / "mat.html").read_text(encoding="utf-8")
    assert "Laid along the surface, and pushed straight down" in page
    assert len(page) < 5_000_000


def test_warnings_name_options_as_they_are_typed(tmp_path: Path) -> None:
    """The window holds load, which is then missing from every frame."""
    pressure = np.zeros((200, 4, 3))
    pressure[:60] = 20.0
    with unpictured():
        result = done(mat(tmp_path, pressure, *STILL, "--unloaded", "0:0.5"))
    line = "cells that read below 0 sum to -24.0 N in one frame: check --unloaded and the offset"
    assert result.warnings == [line] == result.record()["warnings"]


TWICE = "--scan-with-mat: with --landmarks says twice where the mat lies"
REFUSED = {
    "another unit": (("--unit", "m"), "the file looks like millimetres, pass --unit mm"),
    "a window without frames": (("--unloaded", "7:8"), "--unloaded: 7 … 8 s holds 0 frames"),
    "a window without end": (("--unloaded", "1"), "--unloaded: '1' is not a time from"),
    "a filter above its limit": (("--cutoff", "30"), "needs to lie between"),
    "a cutoff that is none": (("--cutoff", "-1"), "--cutoff: -1 Hz cannot be a cut-off frequency"),
    "a part without a name": (("--segment", "x < 40"), "has no name"),
    "a part without faces": (("--segment", "far=x > 400"), "--segment: 'x > 400' holds for no face"),
    "half a registration": (("--registration", "2deg"), "--registration: '2deg' is not a length and an angle"),
    "a length for a pressure": (("--touched", "3mm"), "--touched: '3mm' is not a pressure"),
    "per cent without a sign": (("--accuracy", "10"), "--accuracy: '10' may be meant in per cent"),
    "no such mat": (("--sensor", "left"), "--sensor: there is no mat 'left'"),
    "a negative gate": (("--gate", "-1"), "--gate: -1 N cannot be the force"),
    "half a point": (("--point", "1,2"), "--point: '1,2' is neither a fit.json nor three numbers"),
    "the other side": (("--seen-from", "body"), "check landmarks, unit and --seen-from"),
    "no such way": (("--dead", "bury"), "bury"),
    "a belt pushed down": (("--belt", "rows", "--lay", "closest"), "--belt: has no effect with --lay closest"),
    "a belt on a plane": (("--belt", "columns"), "--belt columns: "),
    "two ways to find it": (("--scan-with-mat", "x.stl"), TWICE),
    "a corner of nothing": (("--first-corner", "1,2,3"), "--first-corner: has no effect without --scan-with-mat"),
    "an edge of nothing": (("--mat-edge", "3mm"), "--mat-edge: has no effect without --scan-with-mat; leave it out"),
    "a model of no motion": (("--osim", "x.osim"), "--osim: has no effect without --motion; give --motion"),
    "a map of no motion": (("--map", "rz=a"), "--map: has no effect without --motion"),
    "a parent of no joint": (
        ("--motion", "x.csv", "--moving", "parent"),
        "--moving: has no effect without --osim; give --osim and --joint",
    ),
    "a map and a model": (
        ("--motion", "x.mot", "--osim", "x.osim", "--joint", "k", "--map", "rz=a"),
        "--map: with --osim names the columns twice; give one",
    ),
    "a shape without landmarks": (("--icp", "--body", "x.stl"), "--body-landmarks: is missing with --icp"),
    "a shape without a body": (("--icp", "--body-landmarks", "x.csv"), "--body: is missing with --icp"),
    "a body without a shape": (("--body", "x.stl"), "--body: has no effect without --icp; give --icp, or leave it out"),
    "a unit of no body": (("--body-unit", "mm"), "--body-unit: has no effect without --body"),
    "an engine of no search": (("--icp-engine", "own"), "--icp-engine: has no effect without --icp"),
    "phases of nothing": (("--phases", "x.csv"), "--phases: has no effect without --compare; leave it out"),
}


@pytest.mark.parametrize(("options", "said"), REFUSED.values(), ids=REFUSED.keys())
def test_what_makes_no_sense_is_one_line(tmp_path: Path, options: tuple[str, ...], said: str) -> None:
    unit = options[1] if options[0] == "--unit" else "mm"
    rest = () if options[0] == "--unit" else options
    refused(mat(tmp_path, uniform(), *rest, unit=unit), said)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (("a,0,0,20,30,0",), "1 landmark is too few"),
        (("a,0,0,20,30,0", "a,4,0,60,30,0"), "id a occurs twice"),
        (("a,0,0,20,30,0", "b,5,0,70,30,0"), "off a mat of 4 × 3"),
        (("a,0,0,20,30,0", "b,four,0,60,30,0"), "row is 'four'"),
        (("a,0,0,20,30,0", "b,4,0,20,30,0"), "all landmarks are at one point"),
    ],
)
def test_landmarks_that_cannot_be_are_one_line(tmp_path: Path, rows: tuple[str, ...], said: str) -> None:
    refused(mat(tmp_path, uniform(), landmarks=rows), said)


def test_one_of_the_ways_is_needed(tmp_path: Path) -> None:
    arguments = ("mat", THIGH / "frames.csv", "--layout", THIGH / "layout.toml", "--surface", MESHES / "thigh.stl")
    result = call(*arguments, "--unit", "mm", "--out", tmp_path / "out", folder=tmp_path / "out")
    refused(result, "--landmarks: is missing: nothing says where the mat lies; give --landmarks, or a second scan")
