"""The page of a centre of pressure: outline, path and butterfly of a foot whose loads are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.cop.page import cop_page
from geocontact.analyses.cop.result import CopResult
from geocontact.view.page.content import Curves, Plan, Table
from tests.cli.calls import poses, written

LAW = {"stiffness": 5e5, "exponent": 1.0, "damping": 0.0, "friction": (0.0, 0.0)}
SPHERES = "px [m], py [m], pz [m], radius [m], zone\n0,0,0,0.02,heel\n0.2,0,0.03,0.02,toe\n"


def walked(folder: Path, *places: tuple[float, float, float], **options: object) -> CopResult:
    """A heel and a toe sphere of 20 mm, 200 mm apart, over y = 0."""
    return gc.centre_of_pressure(
        written(folder / "spheres.csv", SPHERES), motion=poses(folder, *places), **{**LAW, **options}
    )


def plans(result: CopResult) -> list[Plan]:
    return [section for section in cop_page(result).sections if isinstance(section, Plan)]


def test_the_path_lies_under_the_foot_wherever_it_stands(tmp_path: Path) -> None:
    """Moved over the ground, a foot loaded alike keeps its centre in its own frame."""
    foot, _ = plans(walked(tmp_path, (0, 19, 0), (100, 18, 50), (300, 17, -20)))
    np.testing.assert_allclose(foot.tracks[0].points, [[100.0, -15.0]] * 3, atol=1e-9)
    assert (foot.across, foot.up) == ("x", "−z"), "x × −z is up: seen from above"
    outline = np.asarray(foot.lines[0])
    assert outline.min(axis=0) == pytest.approx([-20.0, -50.0], abs=0.1)
    assert outline.max(axis=0) == pytest.approx([220.0, 20.0], abs=0.1)
    assert len(foot.lines) == 1 + 2 and [mark.name for mark in foot.marks] == ["heel", "toe"]


def test_the_butterfly_holds_each_force_at_its_centre(tmp_path: Path) -> None:
    result = walked(tmp_path, (0, 19, 0), (40, 18, 0), (80, 17, 0))
    _, forces = plans(result)
    assert (forces.across, forces.up) == ("x", "y")
    lines = np.array(forces.lines)
    np.testing.assert_allclose(lines[:, 0], [[100.0, 0.0], [140.0, 0.0], [180.0, 0.0]], atol=1e-9)
    lengths = lines[:, 1, 1] - lines[:, 0, 1]
    np.testing.assert_allclose(lengths / lengths[0], [1.0, 2.0, 3.0], rtol=1e-9)
    assert f"100 N are {100.0 * lengths[0] / 1000.0:g} mm long" in forces.words, "2 × 5e5 N/m × 1 mm = 1000 N"
    assert [track.told for track in forces.tracks] == [(), ["1000 N", "2000 N", "3000 N"]], "a force is read in N"


def test_the_page_answers_first(tmp_path: Path) -> None:
    page = cop_page(walked(tmp_path, (0, 19, 0), (40, 18, 0), (80, 30, 0)))
    assert page.headline[0] == (
        "The ground presses on the foot with up to 2000 N, at 1 s; its centre of pressure moves 40 mm along x."
    )
    assert page.headline[1].startswith("There is a centre of pressure in 2 of 3 frames")
    assert page.leads == range(1) and isinstance(page.sections[0], Plan) and len(page.facts) <= 5


def test_a_plate_stands_beside_the_spheres(tmp_path: Path) -> None:
    rows = "\n".join(f"{t}\t10\t900\t0\t0.1\t0\t0.015\t0\t0\t0" for t in (0, 1, 2))
    names = [f"ground_force_{n}" for n in ("vx", "vy", "vz", "px", "py", "pz")] + [f"ground_torque_{a}" for a in "xyz"]
    head = "plate\nversion=1\nnRows=3\nnColumns=10\ninDegrees=no\nendheader\n"
    plate = written(tmp_path / "plate.mot", head + "\t".join(["time", *names]) + "\n" + rows + "\n")
    page = cop_page(walked(tmp_path, (0, 19, 0), (0, 19, 0), (0, 19, 0), compare=plate))
    assert page.headline[-1].startswith(
        "Compared with the force plate the force differs by 100 N and the centre of pressure by"
    )
    assert [track.name for track in page.sections[0].tracks] == ["centre of pressure", "force plate"]
    (table,) = [s for s in page.sections if isinstance(s, Table) and s.title.startswith("Difference")]
    assert ["force y", "N", "100", "100", "100", "3"] in [list(row) for row in table.rows]
    (panel,) = [s for s in page.sections if isinstance(s, Curves) and s.title == "Force on the foot, y"]
    assert [curve.values[0] for curve in panel.curves] == pytest.approx([1000.0, 900.0])


def test_a_foot_in_the_air_has_a_page(tmp_path: Path) -> None:
    with pytest.warns(gc.InputWarning, match="no sphere touches"):
        result = walked(tmp_path, (0, 21, 0), (0, 22, 0))
    assert len(plans(result)) == 1 and cop_page(result).headline[0].startswith("No sphere touches")
    assert "Path under the foot" in result.page(tmp_path / "page.html").read_text(encoding="utf-8")
