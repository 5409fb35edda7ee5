"""A semi-active foot over two strides: stance for stance what a fixed fulcrum gives, numbers by hand, refusals."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.prosthesis.foot_writer import write_foot
from geocontact.analyses.prosthesis.simulate.result import ProsthesisSimulateResult
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.analyses.prosthesis.strides_trial import TRIAL, written

GIVEN: dict[str, Any] = {
    "static": TRIAL / "standing.trc",
    "mass": 77.3,
    "other_plate": "other_force",
    "plate": "own_force",
    "socket_turns": 0,
}
ONE = {"markers": TRIAL / "walking.trc", "plates": TRIAL / "plates.mot"}


def schedule(folder: Path, text: str) -> Path:
    (folder / "schedule.csv").write_text(text)
    return folder / "schedule.csv"


def simulated(files: dict[str, Path], **more: Any) -> ProsthesisSimulateResult:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        return gc.prosthesis.simulate(files["markers"], plates=files["plates"], **(GIVEN | more))


@pytest.fixture(scope="module")
def strides(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return written(tmp_path_factory.mktemp("strides"))


@pytest.mark.slow
def test_each_stride_is_that_of_its_fixed_fulcrum(strides: dict[str, Path], tmp_path: Path) -> None:
    """Low, then medium, beside both settings alone over the same two strides, to the bit."""
    two = simulated(strides, schedule=schedule(tmp_path, "stride [-],setting\n1,low\n2,medium\n"))
    for k, setting in enumerate(("low", "medium")):
        fixed = simulated(strides, schedule=schedule(tmp_path, f"stride [-],setting\n1,{setting}\n"))
        np.testing.assert_array_equal(two.strides[k].limb.stance.force, fixed.strides[k].limb.stance.force)
        np.testing.assert_array_equal(two.strides[k].limb.stance.stored, fixed.strides[k].limb.stance.stored)
    table = two.table("strides")
    assert list(table["setting"]) == ["low", "medium"]
    assert table["touch-down [s]"].diff()[1] == pytest.approx(1.2, abs=2e-3)
    assert table["moved [mm]"].tolist() == pytest.approx([0.0, 1e3 * (two.strides[1].walk.fulcrum - 0.066)])
    swing = table["touch-down [s]"][1] - table["toe-off [s]"][0]
    assert table["needed speed [mm/s]"][1] == pytest.approx(table["moved [mm]"][1] / swing)
    s = two.strides[0].limb.stance
    lost, peak = 0.002 * np.concatenate([[0.0], np.cumsum(_damping(s))]), int(np.argmax(s.stored))
    returned = s.stored[peak] - s.stored[-1] - lost[-1] + lost[peak]
    assert table["returned [J]"][0] == pytest.approx(returned, rel=1e-6)
    pressing, x = s.force[:, 1] >= 20.0, s.poses.rotation.apply([1.0, 0.0, 0.0])
    way = np.einsum("ti,ti->t", s.centre("ground") - s.poses.translation, x)[pressing]
    assert table["cop travel [mm]"][0] == pytest.approx(1e3 * np.ptp(way), rel=1e-9)
    assert table["returned [J]"][0] > 1.5 * table["returned [J]"][1]  # a softer keel stores more


def _damping(s: Any) -> np.ndarray:
    """Mean power of the keel's dampers between samples [W], 2 ms stiffnesses."""
    power = (s.found.u[:, 8:] ** 2 * (0.002 * s.foot.keel.stiffness(s.fulcrum))).sum(axis=1)
    return np.asarray(0.5 * (power[1:] + power[:-1]))


@pytest.mark.slow
def test_a_constant_schedule_is_the_fixed_fulcrum(tmp_path: Path) -> None:
    """Every table but that of the strides, to the bit."""
    fixed = simulated(ONE, setting="low")
    found = simulated(ONE, schedule=schedule(tmp_path, "speed [m/s],setting\n0,low\n"))
    assert set(found.tables()) - set(fixed.tables()) == {"strides"}
    for name, table in fixed.tables().items():
        assert table.equals(found.table(name)), name
    found.write(tmp_path / "out")
    assert (tmp_path / "out" / "strides.csv").is_file()


@pytest.mark.parametrize(
    ("rows", "more", "words"),
    [
        ("time [s],setting\n-1,low\n0.4,medium\n", {}, "schedule.csv time: moves the fulcrum to medium at 0.40 s, in"),
        ("stride [-],setting\n1,low\n2,middle\n", {}, "row 2: 'middle' is none of the settings"),
        ("stride [-],fulcrum [mm]\n1,40\n", {}, "row 1: .* 66 to 151 mm"),
        ("stride [-],setting\n1,low\n", {"setting": "high"}, "in place of `setting`"),
        ("stride [-],setting\n1,low\n", {"plate": None}, "`schedule`: has no effect"),
    ],
)
def test_refused(tmp_path: Path, rows: str, more: dict[str, Any], words: str) -> None:
    with pytest.raises(gc.InputError, match=words):
        simulated(ONE, schedule=schedule(tmp_path, rows), **more)


def test_an_actuator_that_is_too_slow_is_refused(strides: dict[str, Path], tmp_path: Path) -> None:
    """51 mm from low to medium in 0.46 s ask for 111 mm/s."""
    write_foot(tmp_path, vsf_foot())
    file = tmp_path / "foot.toml"
    file.write_text(file.read_text() + '\n[actuator]\nspeed = { value = 100, unit = "mm/s" }\n')
    rows = schedule(tmp_path, "stride [-],setting\n1,low\n2,medium\n")
    with pytest.raises(gc.InputError, match=r"stride 2: 51 mm to medium in 0.46 s of swing need 111 mm/s.*does 100"):
        simulated(strides, schedule=rows, foot=file)
