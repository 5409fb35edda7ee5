"""Loops of a prosthetic ankle as a gap case with an own model: nobody labelled them, so what is checked is evidence.

The foot was designed to run along one cam while it dorsiflexes and along another on the way back, so its loops cross:
around the neutral angle turning up takes more torque than turning down, towards dorsiflexion it is the other way round.
Recordings with either cam alone are the control.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat

from benchmarks.devices import desr
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.identify.optimise.least_squares import fit
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.systems.catalogue import system_of


@pytest.fixture(scope="module")
def file(data_dir: Path) -> Path:
    found = data_dir / desr.FILE
    if not found.is_file():
        pytest.skip(f"no real data: {found} is absent")
    return found


@pytest.fixture(scope="module")
def case(file: Path, tmp_path_factory: pytest.TempPathFactory) -> GapCase:
    return read_gap_case(desr.write_case(file, tmp_path_factory.mktemp("desr") / "ankle"))


def torque(trial: Trial) -> np.ndarray:
    return trial.column("torque")[:, None]


def held_out(case: GapCase, system: System, starts: list[dict[str, float]]) -> tuple[float, dict[str, float]]:
    """RMSE [N m] at the settings that were not used, and the values that were fitted at the others."""
    measured = [torque(trial) for trial in case.calibration]
    found = fit(
        lambda values: [system.simulate(trial, values) for trial in case.calibration],
        measured,
        system.parameters,
        np.ones(1),
        starts,
    )
    errors = [torque(trial) - system.simulate(trial, found.values) for trial in case.evaluation]
    return float(np.sqrt(np.mean([np.mean(error**2) for error in errors]))), found.values


def test_case_holds_the_recordings(case: GapCase, file: Path) -> None:
    raw = loadmat(file, simplify_cells=True)["DESR_N"]
    trials = case.calibration + case.evaluation
    assert {trial.name for trial in trials} == set(raw)
    for trial in trials:
        given = raw[trial.name]
        assert len(trial) == 667
        assert trial.covariates == {"setting": float(trial.name[1:])}
        for channel, name, share in (("angle", "angleJIM", 1e-3), ("torque", "torque", 0.02)):  # of its range
            off = trial.column(channel) - np.interp(trial.time, given["timeJIM"], given[name])
            assert np.sqrt(np.mean(off**2)) < share * np.ptp(given[name])


def test_nothing_is_left_to_fold_back(file: Path) -> None:
    """A tone of 30 Hz, above half of the new rate, does not come back as a slower one."""
    time = np.arange(12000) * 0.0012
    tone = {"timeJIM": time, "angleJIM": time, "torque": np.sin(2.0 * np.pi * 30.0 * time)}
    kept = desr.thinned(tone)["torque [N m]"].to_numpy()[10:-10]
    assert np.abs(kept).max() < 0.01


def apart(at: np.ndarray, time: np.ndarray, angle: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Torque turning up less that turning down, at some angles > 0, over the largest torque."""
    up = slice(int(angle.argmin()), int(angle.argmax()))
    down = slice(int(angle.argmax()), int(np.searchsorted(time, 11.9)))
    return np.asarray(np.interp(at, angle[up], load[up]) - np.interp(-at, -angle[down], load[down])) / load.max()


def test_loops_cross_at_every_setting(file: Path) -> None:
    """Turning up takes more torque near 0 and less at 0.1 rad: neither friction nor damping can do both."""
    for name, table in desr.loops(file).items():
        near, far = apart(np.array([0.02, 0.1]), *table.to_numpy().T)
        assert near > 0.05, name
        assert far < -0.05, name


@pytest.mark.parametrize("cam", ["DESR_N_CAM1", "DESR_N_CAM2"])
def test_loops_do_not_cross_with_one_cam(file: Path, cam: str) -> None:
    """The control: without the switching, turning up takes more torque than turning down everywhere."""
    (table,) = desr.loops(file, cam).values()
    width = apart(np.linspace(0.01, 0.19, 50), *table.to_numpy().T)
    assert width.min() > 0.0


def test_the_two_cams_explain_more_of_the_loops_than_friction_or_damping(case: GapCase) -> None:
    system = system_of(case)
    before, base = held_out(case, system, [{}])
    left = {}
    for one in candidates(system):
        if one.label in ("cam_switch", "dry_friction.stroke", "damping"):
            left[one.label], values = held_out(case, one.apply(system), [{**base, **start} for start in one.starts])
            if one.label == "cam_switch":
                assert 0.3 < values["cam_switch.share"] < 1.2  # 1 as designed
                assert 0.8 < values["cam_switch.stretch"] < 1.2
    assert left.pop("cam_switch") < 0.6 * before
    assert min(left.values()) > 0.85 * before, left
