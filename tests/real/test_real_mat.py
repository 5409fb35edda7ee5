"""`geocontact mat` on a whole body of real size: synthetic recordings on the front and the back of a thigh."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.geometry.drape.lay import lay
from geocontact.geometry.drape.mat import Mat
from geocontact.geometry.drape.spread import Anchor, Geodesics
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import read_mesh
from tests.cli.calls import call, done, written

SIDE = float(np.sqrt(2e-4))
ROWS, COLUMNS, FRAMES = 16, 8, 151


def thigh(body: Surface, ahead: float) -> np.ndarray:
    """The foremost (or hindmost) point of one thigh; y is up and z ahead."""
    low, high = body.vertices.min(axis=0), body.vertices.max(axis=0)
    height = low[1] + 0.38 * (high[1] - low[1])
    slab = body.vertices[np.abs(body.vertices[:, 1] - height) < 0.02]
    leg = slab[(slab[:, 0] > 0.0) & (slab[:, 0] < 0.25)]
    return leg[np.argmax(ahead * leg[:, 2])]


def recording(folder: Path) -> tuple[Path, np.ndarray]:
    """A pad that comes and goes [kPa], frames x rows x columns."""
    t = np.arange(FRAMES) / 50.0
    r, c = np.meshgrid(np.arange(ROWS) + 0.5, np.arange(COLUMNS) + 0.5, indexing="ij")
    pad = np.maximum(1.0 - ((r - 8.0) / 6.0) ** 2 - ((c - 4.0) / 3.5) ** 2, 0.0)
    pressure = np.round(20.0 * np.sin(np.pi * t / t[-1])[:, None, None] ** 2 * pad, 4)
    names = [f"r{i}c{j}" for i in range(ROWS) for j in range(COLUMNS)]
    rows = [",".join(f"{v:.10g}" for v in (when, *p.ravel())) for when, p in zip(t, pressure, strict=True)]
    return written(folder / "frames.csv", "\n".join([",".join(["time [s]", *names]), *rows]) + "\n"), pressure


@pytest.mark.parametrize("side", ["front", "back"])
@pytest.mark.parametrize("file", ["human_man.obj", "human_woman.obj"])
def test_a_mat_on_a_thigh_of_a_whole_body(data_dir: Path, tmp_path: Path, file: str, side: str) -> None:
    scan = data_dir / "body_meshes" / file
    body, ahead = Surface.of(read_mesh(scan, "m")), 1.0 if side == "front" else -1.0
    sheet = Geodesics(body)
    anchor = Anchor.at(sheet, thigh(body, ahead), np.array([0.0, -1.0, 0.0]))
    truth = lay(sheet, Mat(ROWS, COLUMNS, (SIDE, SIDE)), anchor)
    places = [(0, 0), (0, COLUMNS), (ROWS, 0), (ROWS, COLUMNS), (ROWS // 2, COLUMNS // 2)]
    lines = [f"L{k},{i},{j}," + ",".join(f"{x:.9f}" for x in truth.nodes[i, j]) for k, (i, j) in enumerate(places)]
    marks = written(tmp_path / "marks.csv", "\n".join(["id, row, column, x [m], y [m], z [m]", *lines]) + "\n")
    layout = f'rows = {ROWS}\ncolumns = {COLUMNS}\npitch_mm = {1e3 * SIDE!r}\nunit = "kPa"\norder = "row"\n'
    frames, pressure = recording(tmp_path)
    begin = time.perf_counter()
    result = done(call(
        "mat", frames, "--layout", written(tmp_path / "layout.toml", layout), "--surface", scan, "--unit", "m",
        "--landmarks", marks, "--cutoff", "0", "--registration", "1mm,2deg", "--out", tmp_path / "out",
        folder=tmp_path / "out",
    ))  # fmt: skip
    seconds = time.perf_counter() - begin
    told = result.record()["results"]["mat"]
    assert (told["cells"], told["uncovered_cells"], told["folded_cells"]) == (128, [], [])
    # its marks hold the mat while it is evened out; that alone moves it by 1 to 10 mm on faces of 20 mm
    assert max(told["landmark_residual_mm"].values()) < 0.2
    ours = pd.read_csv(result.folder / "wrench.csv")
    np.testing.assert_allclose(ours["normal [N]"], 1e3 * pressure.sum(axis=(1, 2)) * 2e-4, rtol=1e-9, atol=1e-12)
    loaded = ours[ours["normal [N]"] > 5.0]
    assert len(loaded) > 100 and np.isfinite(loaded.to_numpy(float)).all()
    k = int(ours["normal [N]"].argmax())
    force = ours.loc[k, [f"f{a} [N]" for a in "xyz"]].to_numpy(float)
    assert 0.75 * ours.loc[k, "normal [N]"] < np.linalg.norm(force) < ours.loc[k, "normal [N]"]
    assert force[2] * ahead < -0.7 * np.linalg.norm(force), "the front is pushed back, the back forward"
    centre = 1e-3 * ours.loc[k, [f"cop_{a} [mm]" for a in "xyz"]].to_numpy(float)
    assert np.linalg.norm(centre - truth.nodes[8, 4]) < 0.02
    assert seconds < 60.0, f"{seconds:.1f} s"
