"""Planted numbers come back within their intervals; what was never loaded stays unknown."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from geocontact.io.recordings.spheres import read_law
from geocontact.prosthesis.calibration.calibrate import SoleCalibration, calibrate
from geocontact.prosthesis.calibration.known_numbers import knowledge
from geocontact.prosthesis.calibration.sole_residuals import SoleResiduals
from geocontact.prosthesis.keel.vsf_foot import vsf_foot
from tests.cli.calls import call, done
from tests.prosthesis.calibration.stances import laboratory_files, planted, recorded


def test_a_zone_that_is_never_loaded_is_unknown() -> None:
    """The first part of a stance does not load the forefoot."""
    stance = recorded()
    few = slice(0, 20)
    short = replace(
        stance,
        time=stance.time[few],
        poses=stance.poses[few],
        rate=stance.rate[few],
        force=stance.force[few],
        centre=stance.centre[few],
    )
    found = knowledge(SoleResiduals.of([short], vsf_foot()), np.zeros(15))
    verdicts = {each.name: each.verdict for each in found.numbers}
    assert {verdicts[f"{kind}.forefoot"] for kind in ("stiffness", "damping", "friction")} == {"unknown"}
    assert verdicts["stiffness.heel_back"] == "known"
    assert not any("forefoot" in name for name in found.told_apart.names)
    unknown = next(each for each in found.numbers if each.name == "stiffness.forefoot")
    assert (unknown.lower, unknown.upper) == pytest.approx((unknown.value / 12.0, unknown.value * 12.0))


@pytest.fixture(scope="module")
def calibrated() -> SoleCalibration:
    return calibrate([recorded()], vsf_foot(), starts=4, finished=1)


@pytest.mark.slow
def test_planted_numbers_lie_in_their_intervals(calibrated: SoleCalibration) -> None:
    zones, values = planted()
    inside = [n.lower <= value <= n.upper for n, value in zip(calibrated.knowledge.numbers, values, strict=True)]
    assert sum(inside) >= 14, dict(zip(zones.names, inside, strict=True))
    near = np.abs(np.log(zones.values_of(calibrated.law) / values))
    assert near[[0, 3, 4]].max() < 0.1


@pytest.mark.slow
def test_cost_is_no_more_than_at_the_planted_numbers(calibrated: SoleCalibration) -> None:
    zones, values = planted()
    residuals = calibrated.residuals
    off = residuals(np.log(values / zones.values_of(zones.usual)))
    assert calibrated.cost < 0.5 * float(off @ off)


@pytest.mark.slow
def test_command_writes_a_law_that_is_read_again(tmp_path: Path) -> None:
    poses, plate = laboratory_files(tmp_path, recorded())
    out = tmp_path / "out"
    told = done(
        call(
            "prosthesis", "calibrate", poses, "--plates", plate, "--mass", "84", "--starts", "0", "--out", out,
            folder=out,
        )
    )  # fmt: skip
    numbers = told.table("numbers.csv").set_index("number")
    law = read_law(out / "law.toml")
    for zone in ("heel_back", "heel_middle", "heel_front", "midfoot", "forefoot"):
        assert law.zone[zone].k == pytest.approx(numbers.loc[f"stiffness.{zone}", "value"], rel=1e-10)
        assert law.zone[zone].b == pytest.approx(numbers.loc[f"damping.{zone}", "value"], rel=1e-10)
        assert law.zone[zone].mu_k == pytest.approx(numbers.loc[f"friction.{zone}", "value"], rel=1e-10)
    zones, values = planted()
    stiffness = numbers.loc[[f"stiffness.{zone}" for zone in zones.zones], "value"].to_numpy()
    np.testing.assert_allclose(stiffness[[0, 3, 4]], values[[0, 3, 4]], rtol=0.15)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--fulcrum", "200mm"), "out of its range"),
        (("--starts", "-1"), "is not 0 to 1000"),
        (("--level", "100%"), "is not between 0 and 1"),
        (("--force-noise", "0"), "gives samples no limit"),
        (("--setting", "low", "--fulcrum", "100mm"), "tells where the fulcrum is as well"),
        (("--plate", "9"), "9"),
    ],
)
def test_what_is_mistaken_is_told(tmp_path: Path, options: tuple[str, ...], words: str) -> None:
    poses, plate = laboratory_files(tmp_path, recorded())
    told = call("prosthesis", "calibrate", poses, "--plates", plate, "--mass", "84", *options, "--out", tmp_path / "o")
    assert told.code == 2
    assert words in " ".join(told.complaints)


def test_a_plate_that_is_elsewhere_is_refused(tmp_path: Path) -> None:
    stance = recorded()
    poses, plate = laboratory_files(tmp_path, replace(stance, centre=stance.centre + 3.0))
    told = call("prosthesis", "calibrate", poses, "--plates", plate, "--mass", "84", "--out", tmp_path / "o")
    assert told.code == 2
    assert "no plate is under this foot" in told.err
    late = tmp_path / "late.mot"
    late.write_bytes(laboratory_files(tmp_path, replace(stance, time=stance.time + 10.0))[1].read_bytes())
    poses = laboratory_files(tmp_path, stance)[0]
    told = call("prosthesis", "calibrate", poses, "--plates", late, "--mass", "84", "--out", tmp_path / "o")
    assert told.code == 2
    assert "one clock" in told.err
