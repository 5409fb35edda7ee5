"""`--no-figures`: no .png and .svg, everything else as without it; a page draws what it shows all the same."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import geocontact as gc
from tests.cli.calls import PLATE, SPHERE, Call, area, call, done, inventory, poses
from tests.cli.gap_cases import damped_elbow, known
from tests.unchecked import unchecked


def pictures(out: Path) -> set[str]:
    return {name for name in inventory(out) if name.endswith((".png", ".svg"))}


def others(out: Path) -> dict[str, bytes]:
    """Files that are no pictures, without the record."""
    return {name: file for name, file in inventory(out).items() if name not in {*pictures(out), "run.json"}}


@pytest.mark.drawn
def test_all_but_the_figures_stays(tmp_path: Path) -> None:
    motion, out = poses(tmp_path, (0, 20, 0), (0, 21, 0)), tmp_path / "out"

    def run(*options: object) -> Call:
        return done(area(out, *options, moving=SPHERE, fixed=PLATE, motion=motion, picture=True))

    run()
    drawn = others(out)
    assert pictures(out) == {"area.png", "area.svg"}
    less = run("--no-figures")
    assert pictures(out) == set() and others(out) == drawn, "figures of the run before are taken away"
    assert less.record()["options"]["no_figures"] is True and "area.png" not in less.out
    again = done(call("rerun", out, "--out", tmp_path / "again")).out
    assert "2 of 2 files of the results are equal" in again and pictures(tmp_path / "again") == set()
    result = gc.area(SPHERE, PLATE, unit="mm", motion=motion)
    result.write(tmp_path / "python", figures=False)
    assert pictures(tmp_path / "python") == set()
    assert "2 of 2 files of the results are equal" in done(call("rerun", tmp_path / "python")).out
    result.write(tmp_path / "python")
    assert pictures(tmp_path / "python") == {"area.png", "area.svg"}


@pytest.mark.slow
@pytest.mark.drawn
def test_a_page_that_shows_drawings_still_has_them(tmp_path: Path) -> None:
    """That of a diagnosis, and those of several cases, which processes of their own may write."""
    case, out = damped_elbow(tmp_path / "cases" / "elbow"), tmp_path / "out"
    with known(), unchecked():
        done(call("gap", "diagnose", case, "--out", out))
        drawn = others(out)
        assert "gap_map.svg" in pictures(out) and b"data:image/svg+xml;base64" in drawn["report.html"]
        done(call("gap", "diagnose", case, "--no-figures", "--out", out))
        assert pictures(out) == set() and others(out) == drawn
        many = tmp_path / "many"
        done(call("gap", "diagnose", case.parent, "--many", "--no-figures", "--workers", 1, "--out", many))
    assert pictures(many) == set() and "elbow/report.html" in inventory(many)
    assert json.loads((many / "elbow" / "run.json").read_text("utf-8"))["options"]["no_figures"] is True


@pytest.mark.slow
def test_the_diagnosis_of_an_injected_effect_draws_none_either(tmp_path: Path) -> None:
    case, out = damped_elbow(tmp_path / "elbow", damping=0.0), tmp_path / "out"
    words = ("--effect", "damping", "--value", "damping.b=12.5", "--no-figures")
    with known(), unchecked():
        done(call("gap", "inject", case, "--out", out, *words))
    assert pictures(out) == set() and "diagnosis/report.html" in inventory(out)
    inner = json.loads((out / "diagnosis" / "run.json").read_text("utf-8"))
    assert inner["options"]["no_figures"] is True
