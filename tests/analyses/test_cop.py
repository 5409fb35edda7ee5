"""The centre of pressure called from Python: closed forms, tables, and the same bytes as the command."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from tests.cli.calls import call, done, poses, written

K, N = 5e5, 1.5
LAW = {"stiffness": K, "exponent": N, "damping": 0.0, "friction": (0.0, 0.0)}
TYPED = ("--stiffness", K, "--exponent", N, "--damping", 0, "--friction", "0,0")
DEPTHS = np.array([1.0, 2.0, 3.0]) * 1e-3


@pytest.fixture
def foot(tmp_path: Path) -> tuple[Path, Path]:
    """A heel and a toe sphere of 20 mm, and a motion that sinks them 1, 2 and 3 mm into y = 0."""
    rows = "px [m], py [m], pz [m], radius [m], zone\n0,0,0,0.02,heel\n0.2,0,0,0.02,toe\n"
    return written(tmp_path / "spheres.csv", rows), poses(tmp_path, *((0, 20 - 1e3 * d, 0) for d in DEPTHS))


def test_force_and_centre_are_those_of_the_law(foot: tuple[Path, Path]) -> None:
    spheres, motion = foot
    result = gc.centre_of_pressure(spheres, motion=motion, gate=0.0, **LAW)
    np.testing.assert_allclose(result.centre.wrench.force[:, 1], 2 * K * DEPTHS**N, rtol=1e-11)
    np.testing.assert_allclose(result.centre.centre, [[0.1, 0.0, 0.0]] * 3, atol=1e-12)
    np.testing.assert_allclose(result.table("zones")["heel [N]"], K * DEPTHS**N, rtol=1e-11)
    assert result.force is result.centre.wrench.force and result.centre_of_pressure is result.centre.centre
    assert result.free_moment.shape == (3,)
    assert "a centre of pressure in 3 of 3 frames" in str(result) and result.warnings == ()
    assert "<img src=" in result._repr_html_()


def test_python_and_command_write_the_same_tables(foot: tuple[Path, Path], tmp_path: Path) -> None:
    spheres, motion = foot
    typed = done(
        call("cop", spheres, "--motion", motion, *TYPED, "--out", tmp_path / "typed", folder=tmp_path / "typed")
    )
    called = gc.centre_of_pressure(spheres, motion=motion, **LAW).write(tmp_path / "called")
    for name in ("cop.csv", "zones.csv"):
        assert typed.bytes(name) == (called / name).read_bytes(), name


def test_assumed_numbers_are_warned_of(foot: tuple[Path, Path]) -> None:
    spheres, motion = foot
    with pytest.warns(gc.InputWarning, match=r"not given are assumed: n = 1.2, b = 200 N s/m"):
        result = gc.centre_of_pressure(spheres, motion=motion, stiffness=K)
    assert result.foot.law.exponent == 1.2


def test_a_depth_in_millimetres_is_that_of_the_command(foot: tuple[Path, Path], tmp_path: Path) -> None:
    spheres, motion = foot
    law = {"stiffness": K, "exponent": N, "friction": (0.0, 0.0), "full_depth": gc.mm(3), "damping": 100.0}
    words = ("--stiffness", K, "--exponent", N, "--friction", "0,0", "--full-depth", "3", "--damping", 100)
    typed = done(
        call("cop", spheres, "--motion", motion, *words, "--out", tmp_path / "typed", folder=tmp_path / "typed")
    )
    result = gc.centre_of_pressure(spheres, motion=motion, **law)
    assert result.foot.law.full_depth == 3e-3
    assert typed.record()["options"]["full_depth"] == "3" and typed.record()["options_si"]["full_depth [m]"] == 3e-3
    assert (result.write(tmp_path / "called") / "cop.csv").read_bytes() == typed.bytes("cop.csv")


def test_the_page_names_the_foot_and_its_path(foot: tuple[Path, Path], tmp_path: Path) -> None:
    spheres, motion = foot
    page = gc.centre_of_pressure(spheres, motion=motion, **LAW).page(tmp_path / "cop.html")
    text = page.read_text(encoding="utf-8")
    assert "Centre of pressure of spheres.csv" in text and "Path under the foot" in text
