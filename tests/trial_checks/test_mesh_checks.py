"""Every check of two surfaces: a pair that it speaks of, one that nearly makes it speak, and what is shipped."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.data.errors import InputWarning
from geocontact.geometry.surface import Surface
from geocontact.trial_checks.mesh_checks import MESH_CHECKS, SurfacePair
from tests.cli.calls import MESHES


def box(name: str, size: tuple[float, float, float], turns: int = 0) -> Surface:
    """A box with its corner at the origin [m]; `turns` renumber its corners."""
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float) * size
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))])
    order = np.roll(np.arange(8), turns)
    return Surface(corners[order], np.argsort(order)[faces], name)


PAIR = SurfacePair(box("femoral_component.stl", (0.06, 0.05, 0.04)), box("tibial_insert.stl", (0.07, 0.05, 0.01)))
Change = Callable[[SurfacePair], SurfacePair]


def scaled(factor: float) -> Change:
    return lambda p: replace(p, moving=Surface(factor * p.moving.vertices, p.moving.faces, p.moving.name))


def twice(shift: float, times: float = 1.0) -> Change:
    return lambda p: replace(p, fixed=Surface(times * p.moving.vertices + shift, p.moving.faces, "copy.stl"))


def named(pair: SurfacePair, side: str) -> SurfacePair:
    """With names that say the side."""
    one, other = (
        Surface(each.vertices, each.faces, each.name.replace(".stl", f"_{side}.stl"))
        for each in (pair.moving, pair.fixed)
    )
    return replace(pair, moving=one, fixed=other)


DAMAGED: dict[str, tuple[str, Change]] = {
    "one surface twice": ("same surface", twice(0.0)),
    "one surface twice, elsewhere": ("same surface", twice(0.3)),
    "one in mm, read as m": ("sizes of two surfaces", scaled(1e3)),
    "one in cm, read as mm": ("sizes of two surfaces", scaled(0.1)),
    "bodies exchanged": ("names of two surfaces", lambda p: replace(p, bodies=("tibia_r", "femur_r"))),
    "surfaces exchanged": (
        "names of two surfaces",
        lambda p: replace(p, moving=p.fixed, fixed=p.moving, layered=True),
    ),
    "a left component": (
        "sides of two surfaces",
        lambda p: replace(p, moving=p.moving, beside=("a_right.csv", "left")),
    ),
    "the other knee's motion": (
        "sides of two surfaces",
        lambda p: replace(named(p, "right"), beside=("gait_left.csv",)),
    ),
    "bodies of the other leg": (
        "sides of two surfaces",
        lambda p: replace(p, bodies=("femur_l", "tibia_l"), beside=("`side` right",)),
    ),
}
NEARLY: dict[str, Change] = {
    "as it is": lambda p: replace(p, bodies=("femur_r", "tibia_r"), layered=True),
    "a copy that is 1 % larger": twice(0.0, 1.01),
    "6 times as large": scaled(6.0),
    "bodies of other names": lambda p: replace(p, bodies=("a", "b"), beside=("`side` right",)),
    "bodies of this leg": lambda p: replace(p, bodies=("femur_r", "tibia_r"), beside=("`side` right",)),
    "all of one side": lambda p: replace(named(p, "right"), beside=("`side` right", "gait.csv", "right_or_left.csv")),
    "without a layer": lambda p: replace(p, moving=p.fixed, fixed=p.moving),
}


def spoke(pair: SurfacePair) -> set[str]:
    return {check.name for check in MESH_CHECKS if list(check.find(pair))}


@pytest.mark.parametrize("damage", DAMAGED)
def test_a_wrong_pair_is_named(damage: str) -> None:
    check, change = DAMAGED[damage]
    assert spoke(change(PAIR)) == {check}


@pytest.mark.parametrize("change", NEARLY.values(), ids=NEARLY)
def test_what_nearly_trips_is_silent(change: Change) -> None:
    assert spoke(change(PAIR)) == set()


def test_every_check_has_a_pair_that_trips_it() -> None:
    assert {check for check, _ in DAMAGED.values()} == {check.name for check in MESH_CHECKS}


def test_commands_warn(tmp_path: Path) -> None:
    """`area` of a ball beside itself."""
    ball, row = MESHES / "sphere_r20.stl", "0,40.5,0,0,0,0,0"
    (tmp_path / "poses.csv").write_text(f"time [s],tx [mm],ty [mm],tz [mm],rx [deg],ry [deg],rz [deg]\n{row}\n")
    with pytest.warns(InputWarning, match="the same surface, edge by edge"):
        gc.area(ball, ball, unit="mm", motion=tmp_path / "poses.csv", order="XYZ", threshold=gc.mm(2))
