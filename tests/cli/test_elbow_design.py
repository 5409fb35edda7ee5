"""`geocontact elbow design`: what it writes for an exoskeleton of known force, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

from geocontact.analyses.stale_results import NAMES
from geocontact.axis_misalignment.deflection import deflect
from tests.cli.calls import Call, call, done, inventory, written

FILES = {
    "design.json", "map.csv", "boundary.csv", "sensitivity.csv", "force.csv", "design.png", "design.svg",
    "report.html", "run.json",
}  # fmt: skip
PAPER = {"--k": 222.43, "--l-mm": 169, "--z-mm": 127, "--range": "0:120deg", "--limit": 5, "--offset-mm": "48,59"}


def design(folder: Path, changes: dict[str, object] | None = None, picture: bool = False) -> Call:
    """The command; most of its time are figure and page, which only one test looks at."""
    given = {**PAPER, "--step-mm": 10, "--out": folder / "out", **(changes or {})}
    arguments = [f"{key}={value}" for key, value in given.items() if value is not None]
    with ExitStack() as stack:
        if not picture:
            stack.enter_context(unpictured())
        return call("elbow", "design", *arguments, folder=folder / "out")


@contextmanager
def unpictured() -> Iterator[None]:
    """Neither figure nor page are made."""
    with ExitStack() as stack:
        for name in ("design_figure", "save_both", "write_design_report"):
            stack.enter_context(mock.patch(f"geocontact.analyses.misalignment.design.write.{name}", return_value=b""))
        yield


def told(result: Call) -> dict:
    return json.loads((result.folder / "design.json").read_text(encoding="utf-8"))


def elbow_force(degrees: np.ndarray, x: float = 0.048, y: float = 0.059) -> np.ndarray:
    """Force of the source's values by the gap's base model."""
    numbers = np.array([0.169, 0.127, x, y, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0])
    return 222.43 * deflect(np.radians(degrees), np.zeros(len(degrees)), numbers)[0]


def test_the_exoskeleton_of_the_source(tmp_path: Path) -> None:
    result = done(design(tmp_path, {"--stroke-mm": "0:60", "--uncertainty-mm": 10, "--map-mm": 60}, picture=True))
    assert set(inventory(result.folder)) == FILES <= NAMES
    course = result.table("force.csv")
    want = elbow_force(course["beta [deg]"].to_numpy())
    beyond = np.minimum(want, 0.0) + np.maximum(want - 222.43 * 0.06, 0.0)
    np.testing.assert_allclose(course["force [N]"], beyond, rtol=0.0, atol=1e-9)
    m = told(result)
    assert m["offset"]["peak_N"] == pytest.approx(-want.min(), abs=1e-3) and not m["offset"]["admissible"]
    stroke = m["needed_stroke"]
    assert stroke["lower_end_to_be_decreased_by_mm"] == pytest.approx(-stroke["lower_end_at_most_mm"])
    assert stroke["upper_end_at_least_mm"] == pytest.approx(stroke["free_of_force_mm"][1] - 5e3 / 222.43)
    assert "the lower end must be decreased by 27.48 mm" in result.out
    page = (result.folder / "report.html").read_text(encoding="utf-8")
    assert "the lower end must be decreased by 27.48 mm" in page and "robust radius" in page


def test_the_map_is_that_of_the_model(tmp_path: Path) -> None:
    result = done(design(tmp_path))
    rows = result.table("map.csv")
    assert len(rows) == 13**2 and set(rows["state"]) == {"ok"}
    for row in rows.iloc[::17].to_dict(orient="records"):
        force = elbow_force(np.linspace(0.0, 120.0, 2001), row["x [mm]"] / 1e3, row["y [mm]"] / 1e3)
        assert row["peak_force [N]"] == pytest.approx(np.abs(force).max(), abs=1e-4)
        assert row["least_deflection [mm]"] == pytest.approx(force.min() / 0.22243, abs=1e-4)
        assert (row["admissible"] == "yes") == (row["peak_force [N]"] <= 5.0)
        assert row["lower_end_at_most [mm]"] == pytest.approx(row["least_deflection [mm]"] + 5e3 / 222.43)
    assert told(result)["map"]["admissible"] == (rows["admissible"] == "yes").sum() > 0


def test_robust_radius_and_boundary(tmp_path: Path) -> None:
    result = done(design(tmp_path, {"--offset-mm": None}))
    radius = told(result)["admissible_radius"]
    edge = result.table("boundary.csv")
    assert radius["radius_mm"] == pytest.approx(edge["distance [mm]"].min()) and radius["passed_within_map"]
    x, y = radius["passed_first_at_mm"]
    assert np.hypot(x, y) == pytest.approx(radius["radius_mm"])
    force = elbow_force(np.linspace(0.0, 120.0, 2001), x / 1e3, y / 1e3)
    assert np.abs(force).max() == pytest.approx(5.0, abs=1e-4)
    assert any("no sensitivities" in line for line in result.warnings)
    assert told(result)["sensitivity"][0]["peak_slope"] is None


def test_a_map_that_does_not_reach_the_limit_says_so(tmp_path: Path) -> None:
    result = done(design(tmp_path, {"--offset-mm": None, "--map-mm": 5, "--step-mm": 1}))
    assert not told(result)["admissible_radius"]["passed_within_map"]
    assert any("up to its edge only" in line for line in result.warnings)
    assert set(result.table("boundary.csv")["passed"]) == {"no"}


def test_sensitivity_in_the_units_of_the_table(tmp_path: Path) -> None:
    rows = done(design(tmp_path)).table("sensitivity.csv").set_index("number")
    for other in ("peak", "rms"):
        assert rows.loc["k", f"{other}_elasticity"] == pytest.approx(1.0)
        assert rows[f"{other}_elasticity"].sum() == pytest.approx(2.0, abs=1e-5)
    a, b = (np.abs(elbow_force(np.array([120.0]), x=0.048 + side * 1e-4)).max() for side in (1.0, -1.0))
    assert rows.loc["x", "peak_slope"] == pytest.approx((a - b) / 0.2, rel=1e-4)


def test_a_drift_by_formula_by_table_and_over_the_joints_angle(tmp_path: Path) -> None:
    angle = np.arange(-10.0, 131.0, 10.0)
    t = np.radians(angle)
    rows = "\n".join(f"{a},{-8 * b},{5 * b + 2 * b * b}" for a, b in zip(angle, t, strict=True))
    found = []
    for k, drift in enumerate((
        "x=0:-8,y=0:5:2",
        written(tmp_path / "beta.csv", f"beta [deg],x [mm],y [mm]\n{rows}\n"),
        written(tmp_path / "alpha.csv", f"alpha [deg],x [mm],y [mm]\n{rows}\n"),
    )):  # fmt: skip
        (tmp_path / str(k)).mkdir()
        found.append(done(design(tmp_path / str(k), {"--drift": drift})).table("force.csv")["force [N]"].to_numpy())
    np.testing.assert_allclose(found[1], found[0], rtol=0.0, atol=1e-9)
    assert 0.1 < np.abs(found[2] - found[0]).max() < 5.0
    assert np.abs(found[0] - elbow_force(np.linspace(0.0, 120.0, 121))).max() > 1.0


def test_a_table_that_ends_early_is_held_and_says_so(tmp_path: Path) -> None:
    file = written(
        tmp_path / "short.csv", "beta [deg],x [mm],y [mm]\n" + "\n".join(f"{a},0,{a}" for a in range(0, 91, 30))
    )
    result = done(design(tmp_path, {"--drift": file}))
    assert any("angles from 0 to 90 deg, asked for 0 to 120" in line for line in result.warnings)


def test_an_instant_centre_that_stays_is_an_offset(tmp_path: Path) -> None:
    rows = "\n".join(f"{a},48,59" for a in range(-20, 141, 20))
    file = written(tmp_path / "c.csv", f"alpha [deg],instant_centre_x [mm],instant_centre_y [mm]\n{rows}\n")
    result = done(design(tmp_path, {"--drift": file, "--offset-mm": None}))
    np.testing.assert_allclose(
        result.table("force.csv")["force [N]"], elbow_force(np.linspace(0.0, 120.0, 121)), rtol=0.0, atol=1e-9
    )
    assert [entry["tells"] for entry in result.record()["inputs"]] == ["instant centre"]


KNEE = {
    "--k": 400,
    "--l-mm": 250,
    "--z-mm": 60,
    "--range": "0:120deg",
    "--limit": 10,
    "--offset-mm": None,
    "--map-mm": 10,
}


def knee_centre(folder: Path) -> Path:
    """A synthetic instant centre of a knee: it moves backwards by 16 mm and up by 9 mm while the knee bends to 120°."""
    t = np.linspace(0.0, 1.0, 14)
    rows = "\n".join(f"{-5 + 130 * s},{-16 * s},{9 * s * s}" for s in t)
    return written(folder / "knee.csv", f"alpha [deg],instant_centre_x [mm],instant_centre_y [mm]\n{rows}\n")


def test_a_knee_orthosis_with_one_hinge_is_pushed_by_a_centre_that_wanders(tmp_path: Path) -> None:
    """A hinge where the centre begins is pushed, one amid its path less, and one whose joint stayed not at all."""
    drift, peaks = knee_centre(tmp_path), {}
    for name, offset in (("begins", "0,0"), ("amid", "8,-4")):
        (tmp_path / name).mkdir()
        result = done(design(tmp_path / name, {**KNEE, "--drift": drift, "--offset-mm": offset}))
        peaks[name] = float(result.table("force.csv")["force [N]"].abs().max())
    assert 0.1 < peaks["amid"] < 0.8 * peaks["begins"] and peaks["begins"] > 1.0
    (tmp_path / "stays").mkdir()
    still = done(design(tmp_path / "stays", KNEE)).table("force.csv")["force [N]"].abs().max()
    assert still < 1e-9


def test_a_hip_that_extends_too(tmp_path: Path) -> None:
    """From 20° of extension to 110° of flexion: the law of the elbow at negative angles as well."""
    hip = {"--k": 500, "--l-mm": 300, "--z-mm": 90, "--range": "-20:110deg", "--offset-mm": "15,-20"}
    table = done(design(tmp_path, hip)).table("force.csv")
    degrees = table["beta [deg]"].to_numpy()
    numbers = np.array([0.3, 0.09, 0.015, -0.02, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0])
    wanted = 500.0 * deflect(np.radians(degrees), np.zeros(len(degrees)), numbers)[0]
    assert degrees[0] == pytest.approx(-20.0) and degrees[-1] == pytest.approx(110.0)
    np.testing.assert_allclose(table["force [N]"], wanted, rtol=0.0, atol=1e-9)


def test_poles_and_folds_of_the_map_are_counted_and_named(tmp_path: Path) -> None:
    result = done(design(tmp_path, {"--l-mm": 60, "--offset-mm": None, "--map-mm": 80, "--step-mm": 20}))
    rows = result.table("map.csv")
    assert (rows.loc[rows["x [mm]"].abs() > 60, "state"] == "fold").all()
    assert {"pole", "fold", "ok"} == set(rows["state"])
    counts = told(result)["map"]
    assert counts["pole"] == (rows["state"] == "pole").sum() and counts["fold"] == (rows["state"] == "fold").sum()
    assert rows.loc[rows["state"] != "ok", "peak_force [N]"].isna().all()
    assert any("tan γ has a pole" in line for line in result.warnings)
    assert any("longer than the link" in line for line in result.warnings)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"--range": "0:120"}, "write for example 0:120deg"),
        ({"--range": "0:120rad"}, "are these degrees?"),
        ({"--range": "0:2.1deg"}, "are these radians?"),
        ({"--range": "120:0deg"}, "ends before it begins"),
        ({"--k": 0}, "--k: 0 is not above 0"),
        ({"--l-mm": -169}, "--l-mm: -169 is not above 0"),
        ({"--l-mm": 0.169}, "l = 0.169 mm is no link of an exoskeleton: are these metres?"),
        ({"--limit": "nan"}, "--limit: nan is not above 0"),
        ({"--z-mm": "inf"}, "--z-mm"),
        ({"--stroke-mm": "20:-20"}, "write the lower end first"),
        ({"--stroke-mm": "20"}, "from … to"),
        ({"--offset-mm": "48"}, "not two lengths"),
        ({"--offset-mm": "180,0"}, "x = 180 mm, y = 0 mm: the offset x is longer than the link"),
        ({"--offset-mm": "0,175", "--range": "0:180deg"}, "tan γ has a pole in the range"),
        ({"--uncertainty-mm": -1}, "--uncertainty-mm"),
        ({"--uncertainty-mm": 130}, "tan γ has a pole in the range"),
        ({"--step-mm": 0.01}, "larger step"),
        ({"--drift": "z=0:1"}, "neither x=… nor y=…"),
        ({"--drift": "nowhere.csv"}, "nowhere.csv"),
    ],
)
def test_refused_in_one_line(tmp_path: Path, changes: dict[str, object], said: str) -> None:
    result = design(tmp_path, changes)
    assert result.code == 2
    (line,) = result.complaints
    assert said in line and not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("beta [deg],x [mm]\n0,1\n", "columns are beta [rad], x [m]"),
        ("beta [rad],x [mm],y [mm]\n0,1,1\n40,1,1\n80,1,1\n120,1,1\n", "are these degrees?"),
        ("beta [deg],x [mm],y [mm]\n0,1,1\n40,1,1\n80,1,1\n", "3 rows"),
        ("beta [deg],x [mm],y [mm]\n0,1,1\n40,1,1\n30,1,1\n90,1,1\n", "do not rise"),
    ],
)
def test_a_drift_that_cannot_be_used(tmp_path: Path, text: str, said: str) -> None:
    result = design(tmp_path, {"--drift": written(tmp_path / "drift.csv", text)})
    assert result.code == 2
    (line,) = result.complaints
    assert said in line and "drift.csv" in line
