"""Calls of the command line in this process, and the small inputs they are given."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from unittest import mock

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from geocontact.cli.main import run
from geocontact.io.mesh.meshes import read_mesh
from meshes.stl import FACET
from tests.drawing import unwritten

ROOT = Path(__file__).resolve().parents[2]
MESHES = ROOT / "meshes"
FEMUR = MESHES / "femoral_component_right_coarse.stl"
INSERT = MESHES / "tibial_insert_right_coarse.stl"
SPHERE = MESHES / "sphere_r20.stl"
PLATE = MESHES / "plate_80x80x12.stl"
KNEE = MESHES / "knee.osim"
FRAMES = (0, 30)
"""Rows of the shipped gait cycle that most tests use."""


@dataclass(frozen=True)
class Call:
    """What one call of the command line returned, said and wrote."""

    code: int
    out: str
    err: str
    folder: Path

    @property
    def warnings(self) -> list[str]:
        """Lines on stderr that warn, without the word."""
        return [line.removeprefix("warning: ") for line in self.err.splitlines() if line.startswith("warning: ")]

    @property
    def complaints(self) -> list[str]:
        """Lines on stderr that do not warn, nor say how far a long run is."""
        lines = self.err.splitlines()
        return [line for line in lines if not line.startswith("warning: ") and not line.endswith(" done …")]

    def bytes(self, name: str = "area.csv") -> bytes:
        """Content of a result file."""
        return (self.folder / name).read_bytes()

    def table(self, name: str = "area.csv") -> pd.DataFrame:
        """A result table."""
        return pd.read_csv(self.folder / name)

    def record(self) -> dict:
        """`run.json`."""
        return json.loads((self.folder / "run.json").read_text(encoding="utf-8"))


def call(*arguments: object, folder: Path = Path()) -> Call:
    """Run the command line in this process, without the lines that say every half minute how far it is."""
    out, err = StringIO(), StringIO()
    patient = mock.patch("geocontact.cli.show.PAUSE", math.inf)
    with patient, redirect_stdout(out), redirect_stderr(err):
        code = run([str(argument) for argument in arguments])
    return Call(code, out.getvalue(), err.getvalue(), folder)


def area(
    folder: Path,
    *options: object,
    moving: Path = FEMUR,
    fixed: Path = INSERT,
    motion: Path | None = None,
    unit: str = "mm",
    picture: bool = False,
) -> Call:
    """`geocontact area` into `folder`; most of its time are figure and page, which only some tests look at."""
    given = [] if motion is None else ["--motion", motion]
    arguments = ["area", moving, fixed, "--unit", unit, "--out", folder, *given, *options]
    if picture:
        return call(*arguments, folder=folder)
    with unpictured():
        return call(*arguments, folder=folder)


@contextmanager
def unpictured() -> Iterator[None]:
    """Neither figure nor page are made."""
    with ExitStack() as stack:
        for name in ("area_figure", "pressure_figure"):
            stack.enter_context(mock.patch(f"geocontact.analyses.area.motion_outputs.{name}", return_value=b""))
        stack.enter_context(unwritten())
        yield


def done(result: Call) -> Call:
    """The same call, which must have succeeded without a word on stderr but warnings."""
    assert (result.code, result.complaints) == (0, []), result.err
    return result


def contradicting(result: Call) -> Call:
    """The same call, whose result contradicts its data: it is written, and the command ends with 1."""
    assert (result.code, result.complaints) == (1, []), result.err
    assert result.out.startswith("the result contradicts its data"), result.out
    return result


def process(*arguments: object, cwd: Path = ROOT) -> subprocess.CompletedProcess[str]:
    """The program as a user starts it from a checkout."""
    command = [sys.executable, str(ROOT / "cli.py"), *map(str, arguments)]
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    return subprocess.run(command, cwd=cwd, env=environment, capture_output=True, encoding="utf-8", timeout=300)


def gait(folder: Path, frames: Iterable[int] = FRAMES, name: str = "gait.csv") -> Path:
    """Some frames of the shipped cycle, poses of the femoral component in the insert."""
    head, *rows = (MESHES / "gait.csv").read_text(encoding="utf-8").splitlines()
    return written(folder / name, "\n".join([head, *(rows[k] for k in frames)]) + "\n")


def storage(folder: Path, frames: Sequence[int] = FRAMES, name: str = "gait.mot") -> Path:
    """The same frames for OpenSim: coordinates of the joint whose child is the insert."""
    lines = (MESHES / "gait.mot").read_text(encoding="utf-8").splitlines()
    start = lines.index("endheader") + 2
    head = "\n".join(lines[:start]).replace("nRows=101", f"nRows={len(frames)}")
    return written(folder / name, "\n".join([head, *(lines[start + k] for k in frames)]) + "\n")


def poses(folder: Path, *rows: Sequence[float], name: str = "poses.csv", head: str = "") -> Path:
    """Poses at 0, 1, 2 … s: tx, ty, tz [mm] and a quaternion, 1 0 0 0 when only three numbers are given."""
    head = head or "time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz"
    cells = [[k, *row, *((1, 0, 0, 0) if len(row) == 3 else ())] for k, row in enumerate(rows)]
    return written(folder / name, "\n".join([head, *(",".join(map(repr, map(float, row))) for row in cells)]) + "\n")


def placement(folder: Path, turn: Rotation, shift: Sequence[float], name: str) -> Path:
    """A 4x4 matrix for --place-…; shift in the mesh unit."""
    rows = np.vstack([np.column_stack([turn.as_matrix(), shift]), [0, 0, 0, 1]])
    return written(folder / name, "# pose\n" + "\n".join(" ".join(map(repr, row)) for row in rows.tolist()) + "\n")


def shifted(folder: Path, shift: Sequence[float], name: str = "place.txt") -> Path:
    """A placement that only shifts, in the mesh unit."""
    return placement(folder, Rotation.identity(), shift, name)


def written(file: Path, content: str | bytes) -> Path:
    """The file, with this content."""
    file.write_bytes(content.encode() if isinstance(content, str) else content)
    return file


def facets(file: Path) -> np.ndarray:
    """Facets of a binary STL file, free to be changed."""
    return np.frombuffer(file.read_bytes(), FACET, offset=84).copy()


def corners(file: Path) -> np.ndarray:
    """Corners (m, 3, 3) of a binary STL file, in its unit."""
    return facets(file)["corners"].astype(float)


def stl(content: np.ndarray) -> bytes:
    """Binary STL of facets, or of corners (m, 3, 3)."""
    if content.dtype != FACET:
        records = np.zeros(len(content), FACET)
        records["corners"] = content
        content = records
    return b"\0" * 80 + np.uint32(len(content)).astype("<u4").tobytes() + content.tobytes()


def inventory(folder: Path) -> dict[str, bytes | None]:
    """Everything below a folder, hidden files included; None for folders."""
    return {p.relative_to(folder).as_posix(): None if p.is_dir() else p.read_bytes() for p in folder.rglob("*")}


def agree(ours: pd.DataFrame, theirs: pd.DataFrame, areas: float = 1e-6, lengths: float = 1e-6) -> None:
    """Tables are the same: areas to a relative, lengths [mm] to an absolute tolerance, words and cells exactly."""
    assert list(ours.columns) == list(theirs.columns)
    for name in ours.columns:
        if name == "signed":
            assert list(ours[name]) == list(theirs[name])
            continue
        rel, atol = (areas, areas) if name.endswith("[mm^2]") else (0.0, lengths)
        np.testing.assert_allclose(ours[name], theirs[name], rtol=rel, atol=atol, err_msg=name)


def in_metres(folder: Path, mesh: Path) -> Path:
    """A mesh in mm written in m with all digits, so that what is read has the same bits."""
    found = read_mesh(mesh, "mm")
    rows = ["v {!r} {!r} {!r}".format(*row) for row in found.vertices.tolist()]
    rows += ["f {} {} {}".format(*row) for row in (found.faces + 1).tolist()]
    return written(folder / f"{mesh.stem}.obj", "\n".join(rows) + "\n")
