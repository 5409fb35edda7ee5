"""A synthetic mat that goes once around a body and meets itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import trapezoid

from geocontact.analyses.mat.result import MatResult
from geocontact.analyses.mat.show import mat_page
from meshes.segments import TORSO
from tests.analyses.mat.samples import FORCE, MOMENT, called, frames, refusal
from tests.cli.calls import MESHES, written

ROUND, WIDE = 32, 6
WIDTH = 15.0  # mm, of a cell across the belt
LEVEL = -40.0  # mm, height of the belt's middle


def ring(y: float) -> tuple[np.ndarray, float]:
    """Points of the torso's smooth skin at a height, and their length once around [mm]."""
    theta = np.linspace(0.0, 2.0 * np.pi, 20001)
    points = TORSO.points(np.column_stack([theta, np.full_like(theta, y)]))
    return points, float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def section(y: float) -> float:
    """Area that the torso's smooth skin encloses at a height [mm^2]."""
    theta = np.linspace(0.0, 2.0 * np.pi, 20001)
    r = TORSO.radius(np.column_stack([theta, np.full_like(theta, y)]))[:, 0]
    return float(trapezoid(0.5 * r**2, theta))


def marks(folder: Path, way: str) -> Path:
    """Four places of the belt on its middle line, at quarters of the way around from the front to the right."""
    points, length = ring(LEVEL)
    gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]) / length
    rows = []
    for k in range(4):
        x, y, z = (np.interp(k / 4, gone, points[:, a]) for a in range(3))
        # theta grows to the right of the subject, which is to the left of who looks at it: against the columns
        place = (WIDE / 2, ROUND * (1 - k / 4)) if way == "columns" else (ROUND * (1 - k / 4), WIDE / 2)
        rows.append(f"m{k},{place[0]:g},{place[1]:g},{x:.6f},{y:.6f},{z:.6f}")
    return written(folder / "marks.csv", "\n".join(["id, row, column, x [mm], y [mm], z [mm]", *rows]) + "\n")


def belt(folder: Path, pressure: np.ndarray, way: str = "columns", longer: float = 1.0, **options: Any) -> MatResult:
    """A belt of ROUND x WIDE cells whose cells share the girth (`longer` times), with `pressure` [kPa] over them."""
    pitch = longer * ring(LEVEL)[1] / ROUND
    shape, pitches = ((WIDE, ROUND), (WIDTH, pitch)) if way == "columns" else ((ROUND, WIDE), (pitch, WIDTH))
    layout = f'rows = {shape[0]}\ncolumns = {shape[1]}\npitch_mm = [{pitches[0]!r}, {pitches[1]!r}]\nunit = "kPa"\n'
    return called(
        frames(folder, np.repeat(pressure.reshape(1, *shape), 3, axis=0)),
        layout=written(folder / "layout.toml", layout + 'order = "row"\n'),
        surface=MESHES / "torso.stl",
        landmarks=marks(folder, way),
        seen_from="outside" if way == "columns" else "body",
        **{"belt": way, **options},
    )


@pytest.mark.parametrize("way", ["columns", "rows"])
def test_a_belt_under_uniform_pressure_pushes_along_the_body_only(tmp_path: Path, way: str) -> None:
    """p over a band is what closes it: p times the difference of the sections at its edges, along y; nothing else."""
    result = belt(tmp_path, np.full((WIDE, ROUND), 10.0), way)
    told, length = result.record.results, ring(LEVEL)[1]
    assert told["belt"]["around"] == way
    assert told["belt"]["way_around_mm"] == pytest.approx(length, rel=5e-3)
    assert told["mat"]["uncovered_cells"] == [] and told["mat"]["folded_cells"] == []
    assert told["load"]["interface_normal"] is None
    ours = result.table().iloc[0]
    pressing = 10e3 * WIDE * WIDTH * length * 1e-6
    assert ours["normal [N]"] == pytest.approx(pressing, rel=1e-9)
    low, high = (section(LEVEL + s * WIDE / 2 * WIDTH) for s in (-1.0, 1.0))
    force = ours[FORCE].to_numpy(float)
    assert force[1] == pytest.approx(10e3 * 1e-6 * (high - low), rel=0.05)
    assert np.hypot(force[0], force[2]) < 1e-3 * pressing
    assert np.linalg.norm(ours[MOMENT].to_numpy(float)) < 3e-4 * pressing
    facts = dict(mat_page(result, np.arange(3), b"<svg/>").facts)
    assert facts["Largest force"] == f"{pressing:.1f} N at 0.00 s (sum of pressure × area)"
    assert not any("mean normal" in name for name in facts), "a belt has no side that it looks to"


def test_the_seam_is_no_gap(tmp_path: Path) -> None:
    """A cell at either side of the seam, both in front, where the normal is x."""
    pressure = np.zeros((WIDE, ROUND))
    pressure[:, [0, -1]] = 20.0
    ours = belt(tmp_path, pressure).table().iloc[0]
    assert ours["fx [N]"] == pytest.approx(-ours["normal [N]"], rel=0.02)
    assert abs(ours["fz [N]"]) < 0.01 * ours["normal [N]"]
    assert ours["cop_z [mm]"] == pytest.approx(0.0, abs=1.5)


@pytest.mark.parametrize(
    ("longer", "options", "said"),
    [
        (0.85, {}, "too short"),
        (1.18, {}, "too long"),
        (1.0, {"lay": "closest"}, "`belt`: has no effect with `lay` closest"),
    ],
)
def test_a_belt_that_cannot_be_one_is_refused(tmp_path: Path, longer: float, options: dict, said: str) -> None:
    with refusal(said):
        belt(tmp_path, np.full((WIDE, ROUND), 10.0), longer=longer, **options)
