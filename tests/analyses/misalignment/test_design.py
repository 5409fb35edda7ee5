"""Offsets and strokes that keep a force under a limit, held against the base model of the diagnosis."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.axis_misalignment.explicit import deflect
from tests.analyses.misalignment.trials import quietly

PAPER: dict[str, Any] = {
    "k": 222.43,
    "l": gc.mm(169),
    "z": gc.mm(127),
    "range": gc.deg(0, 120),
    "limit": 5.0,
    "offset": gc.mm(48, 59),
    "step": gc.mm(10),
}
CENTRED = {"offset": (0.0, 0.0)}


def design(**changes: Any) -> Any:
    """The exoskeleton of the source, or another."""
    return quietly(lambda _, **options: gc.misalignment.design(**options), **PAPER | changes)


def elbow_force(degrees: np.ndarray, x: float = 0.048, y: float = 0.059) -> np.ndarray:
    """Force of the source's values by the gap's base model."""
    numbers = np.array([0.169, 0.127, x, y, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0])
    return 222.43 * deflect(np.radians(degrees), np.zeros(len(degrees)), numbers)[0]


@pytest.mark.slow
def test_the_exoskeleton_of_the_source() -> None:
    result = design(stroke=gc.mm(0, 60), uncertainty=gc.mm(10))
    course = result.table("force")
    want = elbow_force(course["beta [deg]"].to_numpy())
    beyond = np.minimum(want, 0.0) + np.maximum(want - 222.43 * 0.06, 0.0)
    np.testing.assert_allclose(course["force [N]"], beyond, rtol=0.0, atol=1e-9)
    m = result.summary
    assert m["offset"]["peak_N"] == pytest.approx(-want.min(), abs=1e-3) and not m["offset"]["admissible"]
    stroke = m["needed_stroke"]
    assert stroke["lower_end_to_be_decreased_by_mm"] == pytest.approx(-stroke["lower_end_at_most_mm"])
    assert stroke["upper_end_at_least_mm"] == pytest.approx(stroke["free_of_force_mm"][1] - 5e3 / 222.43)
    assert "the lower end must be decreased by 27.48 mm" in str(result)


def test_the_map_is_that_of_the_model() -> None:
    result = design()
    rows = result.table("map")
    assert len(rows) == 13**2 and set(rows["state"]) == {"ok"}
    for row in rows.iloc[::17].to_dict(orient="records"):
        force = elbow_force(np.linspace(0.0, 120.0, 2001), row["x [mm]"] / 1e3, row["y [mm]"] / 1e3)
        assert row["peak_force [N]"] == pytest.approx(np.abs(force).max(), abs=1e-4)
        assert row["least_deflection [mm]"] == pytest.approx(force.min() / 0.22243, abs=1e-4)
        assert (row["admissible"] == "yes") == (row["peak_force [N]"] <= 5.0)
        assert row["lower_end_at_most [mm]"] == pytest.approx(row["least_deflection [mm]"] + 5e3 / 222.43)
    assert result.summary["map"]["admissible"] == (rows["admissible"] == "yes").sum() > 0


def test_robust_radius_and_boundary() -> None:
    result = design(**CENTRED)
    radius = result.summary["admissible_radius"]
    edge = result.table("boundary")
    assert radius["radius_mm"] == pytest.approx(edge["distance [mm]"].min()) and radius["exceeded_within_map"]
    x, y = radius["exceeded_first_at_mm"]
    assert np.hypot(x, y) == pytest.approx(radius["radius_mm"])
    force = elbow_force(np.linspace(0.0, 120.0, 2001), x / 1e3, y / 1e3)
    assert np.abs(force).max() == pytest.approx(5.0, abs=1e-4)
    assert any("no sensitivities" in line for line in result.warnings)
    assert result.summary["sensitivity"][0]["peak_slope"] is None


@pytest.mark.parametrize(("limit", "verdict", "verb"), [(5.0, "exceeded", "exceeds"), (9.0, "kept", "keeps")])
def test_the_verdict_on_the_limit_cannot_be_misread(tmp_path: Path, limit: float, verdict: str, verb: str) -> None:
    """The source's offsets need 8.64 N: over 5 N "passed" reads as if the limit were kept."""
    result = design(stroke=gc.mm(0, 60), limit=limit, map=gc.mm(20))
    assert result.summary["offset"]["limit"] == verdict
    assert f"|F| up to 8.64 N {verb} the limit of {limit:g} N" in str(result)
    page = result.page(tmp_path / "page.html").read_text(encoding="utf-8")
    assert f"limit of {limit:g} N" in page and f">{verdict}<" in page and "passed" not in page


def test_a_map_that_does_not_reach_the_limit_says_so() -> None:
    result = design(**CENTRED, map=gc.mm(5), step=gc.mm(1))
    assert not result.summary["admissible_radius"]["exceeded_within_map"]
    assert any("up to its edge only" in line for line in result.warnings)
    assert set(result.table("boundary")["passed"]) == {"no"}


def test_sensitivity_in_the_units_of_the_table() -> None:
    rows = design().table("sensitivity").set_index("number")
    for other in ("peak", "rms"):
        assert rows.loc["k", f"{other}_elasticity"] == pytest.approx(1.0)
        assert rows[f"{other}_elasticity"].sum() == pytest.approx(2.0, abs=1e-5)
    a, b = (np.abs(elbow_force(np.array([120.0]), x=0.048 + side * 1e-4)).max() for side in (1.0, -1.0))
    assert rows.loc["x", "peak_slope"] == pytest.approx((a - b) / 0.2, rel=1e-4)


def test_a_drift_by_coefficients_by_table_and_over_the_joints_angle(tmp_path: Path) -> None:
    angle = np.arange(-10.0, 131.0, 10.0)
    t = np.radians(angle)
    rows = "\n".join(f"{a},{-8 * b},{5 * b + 2 * b * b}" for a, b in zip(angle, t, strict=True))
    files = {name: tmp_path / f"{name}.csv" for name in ("beta", "alpha")}
    for name, file in files.items():
        file.write_text(f"{name} [deg],x [mm],y [mm]\n{rows}\n")
    drifts = ({"x": gc.mm(0, -8), "y": gc.mm(0, 5, 2)}, *files.values())
    found = [design(drift=drift).design.force for drift in drifts]
    np.testing.assert_allclose(found[1], found[0], rtol=0.0, atol=1e-9)
    assert 0.1 < np.abs(found[2] - found[0]).max() < 5.0
    assert np.abs(found[0] - elbow_force(np.linspace(0.0, 120.0, 121))).max() > 1.0


def test_a_table_that_ends_early_is_held_and_says_so(tmp_path: Path) -> None:
    file = tmp_path / "short.csv"
    file.write_text("beta [deg],x [mm],y [mm]\n" + "\n".join(f"{a},0,{a}" for a in range(0, 91, 30)))
    warnings = design(drift=file).warnings
    assert any("angles from 0 to 90 deg, asked for 0 to 120" in line for line in warnings)


def test_an_instant_centre_that_stays_is_an_offset(tmp_path: Path) -> None:
    file = tmp_path / "c.csv"
    rows = "\n".join(f"{a},48,59" for a in range(-20, 141, 20))
    file.write_text(f"alpha [deg],instant_centre_x [mm],instant_centre_y [mm]\n{rows}\n")
    result = design(**CENTRED, drift=file)
    np.testing.assert_allclose(result.design.force, elbow_force(np.linspace(0.0, 120.0, 121)), rtol=0.0, atol=1e-9)
    assert [entry["tells"] for entry in result.record.inputs] == ["instant centre"]


@pytest.mark.slow
@pytest.mark.long
def test_a_knee_orthosis_with_one_hinge_is_pushed_by_a_centre_that_wanders(tmp_path: Path) -> None:
    """A hinge where the centre begins is pushed, one amid its path less, and one whose joint stayed not at all.

    The centre is synthetic: it moves backwards by 16 mm and up by 9 mm while the knee bends to 120°.
    """
    t = np.linspace(0.0, 1.0, 14)
    rows = "\n".join(f"{-5 + 130 * s},{-16 * s},{9 * s * s}" for s in t)
    file = tmp_path / "knee.csv"
    file.write_text(f"alpha [deg],instant_centre_x [mm],instant_centre_y [mm]\n{rows}\n")
    knee = {"k": 400.0, "l": gc.mm(250), "z": gc.mm(60), "limit": 10.0, "map": gc.mm(10)}
    begins, amid, stays = (
        float(np.abs(design(**knee, drift=drift, offset=offset).design.force).max())
        for drift, offset in ((file, (0.0, 0.0)), (file, gc.mm(8, -4)), (None, (0.0, 0.0)))
    )
    assert 0.1 < amid < 0.8 * begins and begins > 1.0 and stays < 1e-9


def test_a_hip_that_extends_too() -> None:
    """From 20° of extension to 110° of flexion: the law of the elbow at negative angles as well."""
    hip = {"k": 500.0, "l": gc.mm(300), "z": gc.mm(90), "range": gc.deg(-20, 110), "offset": gc.mm(15, -20)}
    table = design(**hip).table()
    degrees = table["beta [deg]"].to_numpy()
    numbers = np.array([0.3, 0.09, 0.015, -0.02, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0])
    wanted = 500.0 * deflect(np.radians(degrees), np.zeros(len(degrees)), numbers)[0]
    assert degrees[0] == pytest.approx(-20.0) and degrees[-1] == pytest.approx(110.0)
    np.testing.assert_allclose(table["force [N]"], wanted, rtol=0.0, atol=1e-9)


def test_poles_and_folds_of_the_map_are_counted_and_named() -> None:
    result = design(l=gc.mm(60), **CENTRED, map=gc.mm(80), step=gc.mm(20))
    rows = result.table("map")
    assert (rows.loc[rows["x [mm]"].abs() > 60, "state"] == "fold").all()
    assert {"pole", "fold", "ok"} == set(rows["state"])
    counts = result.summary["map"]
    assert counts["pole"] == (rows["state"] == "pole").sum() and counts["fold"] == (rows["state"] == "fold").sum()
    assert rows.loc[rows["state"] != "ok", "peak_force [N]"].isna().all()
    assert any("tan γ has a pole" in line for line in result.warnings)
    assert any("longer than the link" in line for line in result.warnings)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"range": (0.0, 120.0)},
            "6875.49 deg cannot be an angle of a joint: that is -720 to 720 deg; is 120 deg meant?",
        ),
        ({"range": gc.deg(120, 0)}, "`range`: has no room between its ends"),
        ({"l": 169.0}, "169000 mm cannot be a link of an exoskeleton: that is 20 to 2000 mm; is 169 mm meant?"),
        ({"stroke": gc.mm(20, -20)}, "`stroke`: its upper end is below the lower one"),
        ({"uncertainty": gc.mm(-1)}, "`uncertainty`: -1 mm cannot be how far things are off"),
        ({"drift": {"z": (0.0, 1.0)}}, "`drift`: 'z' is neither x nor y"),
        ({"step": gc.mm(0.01)}, "`step`: 0.01 mm makes 144024001 points"),
    ],
)
def test_what_cannot_be_is_refused_in_si(changes: dict, said: str) -> None:
    with pytest.raises(gc.InputError) as refused:
        design(**changes)
    assert said in str(refused.value)


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
    file = tmp_path / "drift.csv"
    file.write_text(text)
    with pytest.raises(gc.InputError) as refused:
        design(drift=file)
    assert said in str(refused.value) and "drift.csv" in str(refused.value)
