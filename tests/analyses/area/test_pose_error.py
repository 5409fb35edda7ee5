"""Error of poses carried into the area, as the analysis gives it: a plate that comes up to a ball."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from tests.analyses.area.calls import area, page_of, pressed
from tests.cli.calls import PLATE, SPHERE, poses, written

SD = (0.0, 0.3e-3, 0.0, 0.0, 0.0, 0.0)


@pytest.mark.slow
def test_both_intervals_agree_but_where_contact_vanishes(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, -21.5, 0), (0, -23.9, 0), (0, -30, 0))
    result = area(PLATE, SPHERE, motion, threshold=4e-3, pose_sd=SD, draws=100)
    table = result.tables()["pose_error"]
    assert table["agree"][0] == table["agree"][2] == "yes"
    assert table["agree"][1].startswith("no: contact vanishes in")
    rate = 2.0 * np.pi * 20.0  # mm^2/mm
    assert table["first_order_sd [mm^2]"][0] == pytest.approx(0.3 * rate, rel=0.01)
    assert table["drawn_sd [mm^2]"][0] == pytest.approx(0.3 * rate, rel=0.25)
    assert table["slope_ty [mm^2/mm]"][0] == pytest.approx(rate, rel=0.01)
    assert table["drawn_lower [mm^2]"][0] < table["area_fixed [mm^2]"][0] < table["drawn_upper [mm^2]"][0]
    again = area(PLATE, SPHERE, motion, threshold=4e-3, pose_sd=SD, draws=100, workers=2)
    assert table.equals(again.tables()["pose_error"])
    turned = area(PLATE, SPHERE, motion, threshold=4e-3, pose_sd=SD, draws=20, pose_axes="moving")
    assert turned.tables()["pose_error"]["slope_ty [mm^2/mm]"][0] == pytest.approx(rate, rel=0.01)
    result.write(tmp_path / "out")
    assert (tmp_path / "out" / "pose_error.csv").read_text().count("no: contact vanishes") == 1


def test_the_deviation_of_few_draws_is_said_with_its_own_error(tmp_path: Path) -> None:
    """The area's rate times the error's 0.3 mm, which no draw has a say in, lies in the interval about the drawn SD.

    (The 50 draws of the default seed are among the one in forty that miss below: by numpy alone their SD is 0.236 mm.)
    """
    motion = poses(tmp_path, (0, -21.5, 0), (0, -22, 0))
    result = area(PLATE, SPHERE, motion, threshold=4e-3, pose_sd=SD, draws=50, seed=3)
    table = result.tables()["pose_error"]
    true = 0.3 * 2.0 * np.pi * 20.0
    for _, row in table.iterrows():
        lower, sd, upper = (row[f"drawn_sd{end} [mm^2]"] for end in ("_lower", "", "_upper"))
        assert lower < true < upper
        assert (upper - lower) / sd == pytest.approx(4 / np.sqrt(2 * 49), rel=0.05)  # four errors of SD, to first order
    (line,) = [line for line in result.sentences if "standard deviation of the area" in line]
    assert line.startswith("largest standard deviation of the area ") and ": 50 draws give " in line
    summary = result.record.results["pose_error"]["at_4_mm"]
    page, peak = page_of(result), summary["largest_area_ci95_mm2"]
    span = f"{peak[0]:.0f} … {peak[1]:.0f} mm²"
    assert page.headline[1] == f"With the error of the pose the largest area is {span} (95 %, 50 draws)."
    assert dict(page.facts)["Largest area with the pose's error, 95 %"] == span
    assert dict(page.facts)["Largest SD of the area"].endswith("50 draws)")
    assert summary["largest_sd_ci95_mm2"] == pytest.approx(
        [table[f"drawn_sd_{end} [mm^2]"].max() for end in ("lower", "upper")], abs=1e-3
    )


def test_markers_in_one_line_are_refused(tmp_path: Path) -> None:
    markers = written(tmp_path / "markers.csv", "x [mm], y [mm], z [mm]\n0, 0, 0\n10, 0, 0\n20, 0, 0\n")
    with pytest.raises(InputError, match="lie in one line"):
        area(PLATE, SPHERE, poses(tmp_path, (0, -21.5, 0)), markers=markers, marker_sd=5e-4)


def test_the_error_of_the_pose_reaches_forces_and_the_medial_share(tmp_path: Path) -> None:
    """A ball pressed 0.3 mm into a plate, its height known to 0.05 mm: intervals are quantiles of forces at 20 heights.

    Each is that of an analysis of its own at the drawn height. A shift along z takes load from one side to the other.
    """
    layer = {
        "modulus": 1e6,
        "poisson": 0.4,
        "thickness": 5e-3,
        "piece": 1e-3,
        "rule": "clip",
        "split": "z",
        "side": "right",
    }
    sd = {"pose_sd": (0.0, 5e-5, 5e-4, 0.0, 0.0, 0.0), "draws": 20}
    found = pressed(SPHERE, PLATE, poses(tmp_path, (0, 19.7, 0)), **layer, **sd)
    (row,) = found.table("pressure_error").to_dict(orient="records")
    shifts = np.random.default_rng(1).standard_normal((20, 6)) * np.array(sd["pose_sd"])
    heights = [(0.0, 19.7 + 1e3 * dy, 1e3 * dz) for _, dy, dz, *_ in shifts]
    (tmp_path / "drawn").mkdir()
    each = pressed(SPHERE, PLATE, poses(tmp_path / "drawn", *heights), **layer).table("pressure")
    low, high = np.quantile(each["force [N]"], (0.025, 0.975))
    assert (row["force_lower [N]"], row["force_upper [N]"]) == pytest.approx((low, high), rel=1e-6)
    share = np.quantile(each["force_medial [N]"] / each["force [N]"], (0.025, 0.975))
    assert (row["medial_share_lower [-]"], row["medial_share_upper [-]"]) == pytest.approx(tuple(share), rel=1e-6)
    assert share[0] < 0.5 < share[1] and row["force_sd [N]"] == pytest.approx(each["force [N]"].std(), rel=1e-6)
    assert "of it medial where the force is largest" in str(found)
