"""The table of peers: what it reads, how it writes, and that a side that fails is no figure."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from benchmarks.peers_table import (
    COLUMNS,
    FACTORS,
    FITTED,
    TURNING,
    Job,
    Side,
    angles_off,
    fit_job,
    mass_centres,
    measure,
    motion,
    ratios,
    renewed,
    scale_job,
    stretched,
    swing,
    text_of,
)

ROOT = Path(__file__).resolve().parents[2]


def side(name: str, whole: list[float], again: list[float]) -> Side:
    return Side(name, "def job():\n    pass\n", [], lambda _: 0.0, off=0.25, whole=whole, again=again)


def test_ratios_are_of_the_same_round() -> None:
    """A busy third round slows both alike."""
    job = Job("a job", "mm", side("ours", [1.0, 2.0, 30.0], [1.0] * 3), side("peer", [3.0, 6.0, 90.0], [0.5] * 3))
    assert ratios(job) == (3.0, 0.5)
    row = text_of([job], []).splitlines()[-1]
    assert row == "| a job | `ours` | peer | 2.00 / 6.00 | 3.0 | 1.00 / 0.50 | 0.5 | 0.2 / 0.2 (mm) |"


def test_the_swing_is_drawn_out(tmp_path: Path) -> None:
    drawn = swing(tmp_path / "swing.mot", 401)
    read = motion(tmp_path / "swing.mot")
    np.testing.assert_allclose(read, drawn, atol=1e-9)
    assert read.shape == (401, 12) and read[-1, 0] == pytest.approx(4.0)
    shipped = motion(ROOT / "meshes" / "leg_swing.mot")
    moving = [k for k, column in enumerate(shipped.T) if k and np.ptp(column) > 0.0]
    assert len(moving) == 4
    np.testing.assert_allclose(read[::4, moving], shipped[:, moving], atol=1e-8)
    assert np.ptp(read[:, [COLUMNS.index(each) for each in TURNING]], axis=0).min() > 2.0, "every angle moves"


def test_the_drawn_out_swing_has_no_spikes(tmp_path: Path) -> None:
    """Its accelerations change from frame to frame by little of their range; by straight lines they are spikes."""
    drawn = swing(tmp_path / "swing.mot", 1001)[:, 1:]
    second = np.diff(drawn, n=2, axis=0)
    of = np.ptp(second, axis=0) > 1e-9
    assert of.sum() == 8
    assert (np.abs(np.diff(second, axis=0)).max(axis=0) < 0.1 * np.ptp(second, axis=0))[of].all()


@pytest.mark.parametrize("name", TURNING)
def test_an_angle_that_is_wrong_is_an_error(tmp_path: Path, name: str) -> None:
    truth = swing(tmp_path / "swing.mot", 21)
    assert angles_off(tmp_path / "swing.mot", truth) < 1e-8
    truth[7, COLUMNS.index(name)] += 0.25
    assert angles_off(tmp_path / "swing.mot", truth) == pytest.approx(0.25)


def test_a_stretched_model_is_longer_in_what_belongs_to_the_body() -> None:
    model = (ROOT / "meshes" / "leg.osim").read_text(encoding="utf-8")
    changed = [
        (a, b)
        for a, b in zip(model.splitlines(), stretched(model, {"femur_r": 2.0}).splitlines(), strict=True)
        if a != b
    ]
    assert [b.split("<location>")[-1].split("<")[0] for _, b in changed if "location" in b] == [
        "0.2 0 0.06",
        "-0.16 0.1 0",
        "0 -0.4 0.16",
        "0.1 -0.2 -0.14",
    ]
    assert any("<mass_center>0 -0.3 0<" in b for _, b in changed) and any(
        "<translation>0 -0.8 0<" in b for _, b in changed
    )
    assert len(changed) == 6


@pytest.mark.slow
def test_scaling_is_to_a_person_of_other_size(tmp_path: Path) -> None:
    """What the command writes is the person's; a model that is left as it was is 15 mm off."""
    job = scale_job(tmp_path, ROOT / "meshes" / "leg.osim")
    assert job.ours.error("") < 1e-4
    (tmp_path / "s" / "scaled.osim").write_text((ROOT / "meshes" / "leg.osim").read_text(encoding="utf-8"))
    assert job.ours.error("") == pytest.approx(150.0 * (FACTORS["femur_r"] - 1.0), abs=1e-6)


def test_mass_centres_are_read_in_the_order_of_the_file(tmp_path: Path) -> None:
    file = tmp_path / "model.osim"
    file.write_text("<a><mass_center>1 2 3</mass_center></a><b><mass_center>0 -1 4.5</mass_center></b>")
    np.testing.assert_array_equal(mass_centres(file), [[1, 2, 3], [0, -1, 4.5]])


def test_the_script_with_scipy_finds_the_radii(tmp_path: Path) -> None:
    for shape, name, radius in (("sphere", "sphere_r18.stl", 18.0), ("cylinder", "cylinder_r15_l40.stl", 15.0)):
        peer = fit_job(tmp_path, shape, name, radius).peer
        assert peer.program == FITTED
        measure(peer, tmp_path)
        assert len(peer.whole) == len(peer.again) == 1 and 0.0 < peer.again[0] < peer.whole[0]
        assert re.search(r"radius \d+", peer.said) and peer.error(peer.said) < 1e-4
        assert fit_job(tmp_path, shape, name, radius + 1.0).peer.error(peer.said) == pytest.approx(1.0, abs=1e-4)


def test_a_side_that_fails_stops_the_measurement(tmp_path: Path) -> None:
    failing = Side("failing", "def job():\n    raise SystemExit('no')\n", [], lambda _: 0.0)
    with pytest.raises(RuntimeError, match="failing: no"):
        measure(failing, tmp_path)
    assert not failing.whole


def test_figures_of_the_page_are_those_of_the_results() -> None:
    told = json.loads((ROOT / "benchmarks" / "results" / "peers_table.json").read_text(encoding="utf-8"))["figures"]
    page = (ROOT / "docs" / "reference" / "peers.md").read_text(encoding="utf-8")
    rows = [
        line.strip("| ").split(" | ") for line in page.split("## What slow")[0].splitlines() if line.startswith("| `")
    ]
    assert len(rows) == len(told["jobs"]) == 5
    for (_, _, whole, whole_ratio, again, again_ratio, error), job in zip(rows, told["jobs"], strict=True):
        for cell, ratio, key in ((whole, whole_ratio, "whole"), (again, again_ratio, "again")):
            medians = [f"{np.median(job[side][key]):.2f}" for side in ("ours", "peer")]
            assert (cell, ratio) == (" / ".join(medians), f"{job[f'ratio_{key}']:.1f}")
        sizes = {float(each) for each in re.findall(r"\d[\d.]*(?:e-?\d+)?", error)}
        assert sizes == {float(f"{job[side]['off']:.1g}") for side in ("ours", "peer")}
    slower = [a / b for job in told["jobs"] for a, b in zip(job["ours"]["whole"], job["peer"]["whole"], strict=True)]
    assert 1.75 < min(slower) < 1.85 and round(max(slower)) == 6
    for text in (page, (ROOT / "README.md").read_text(encoding="utf-8")):
        assert "take 1.8 to 6 times as long" in text
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    medians = {
        (side, key): [f"{np.median(job[side][key]):.2f}" for job in told["jobs"]]
        for side in ("ours", "peer")
        for key in ("whole", "again")
    }
    assert f"| whole command | {' | '.join(medians['ours', 'whole'])} |" in readme
    assert f"| script with OpenSim, scipy | {' | '.join(medians['peer', 'whole'])} |" in readme
    both = zip(medians["ours", "again"], medians["peer", "again"], strict=True)
    assert f"| the job again / peer again | {' | '.join(map(' / '.join, both))} |" in readme
    found = {row["engine"].replace(",", "").split()[0]: row["ratio"] for row in told["distances"]}
    words = {"warp": "warp 2.3", "fcpw": "fcpw 3.6", "libigl": "libigl 34", "open3d": "open3d 35", "VTK": "VTK 213"}
    for name, said in words.items():
        assert said.replace("\n", " ") in page.replace("\n", " ") and said in readme
        assert float(said.split()[1]) == pytest.approx(found[name], rel=0.03)


def test_a_row_that_is_run_again_stands_in_place_of_the_earlier_one() -> None:
    kept = [{"engine": "ours", "ratio": 1.0}, {"engine": "a", "ratio": 2.0}, {"engine": "b", "ratio": 3.0}]
    found = renewed(kept, [{"engine": "ours", "ratio": 1.0, "cpu_s": 0.4}, {"engine": "a", "ratio": 5.0}])
    assert [(each["engine"], each["ratio"]) for each in found] == [("ours", 1.0), ("b", 3.0), ("a", 5.0)]
    assert found[-1]["ours_cpu_s"] == 0.4 and found[-1]["run"]["commit"] and "run" not in found[1]
