"""Base models and every effect run on the practice cases beside the repository."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import least_squares

from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.effects.catalogue import candidates
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.systems.catalogue import system_of

PRACTICE = Path(__file__).resolve().parents[2].parent / "shared" / "gap" / "practice"
NAMES = [f"{system}_{number:02d}" for system in ("elbow", "foot") for number in range(1, 5)]


@pytest.fixture(scope="module")
def practice() -> Path:
    if not PRACTICE.is_dir():
        pytest.skip("no practice cases: ../shared/gap/practice is absent")
    return PRACTICE


@pytest.mark.parametrize("name", NAMES)
def test_base_and_every_effect_run(practice: Path, name: str) -> None:
    case = read_gap_case(practice / name)
    system = system_of(case)
    trials = case.calibration + case.evaluation
    for model in (system, *(one.apply(system) for one in candidates(system))):
        values = {p.name: p.start for p in model.parameters}
        for trial in trials:
            outputs = model.simulate(trial, values)
            forces = [i for i, channel in enumerate(model.outputs) if channel.startswith("force")]
            assert outputs.shape == (len(trial), len(model.outputs))
            assert np.isfinite(outputs[:, forces]).all(), model.effects


@pytest.mark.parametrize("name", NAMES)
def test_base_is_of_the_measured_size(practice: Path, name: str) -> None:
    """From the starting values alone: within a factor of ten of what was measured, and alike in shape."""
    case = read_gap_case(practice / name)
    system = system_of(case)
    channel = "force" if name.startswith("elbow") else "force_y"
    for trial in case.evaluation:
        got = system.simulate(trial, system.start)[:, system.outputs.index(channel)]
        assert np.corrcoef(got, trial.column(channel))[0, 1] > 0.8
        assert 0.1 < got.max() / trial.column(channel).max() < 10.0


PLANTED = [
    ("elbow_02", ("damping",), {"damping.b": 22.0}),
    ("elbow_03", ("sensor_drift.force",), {"sensor_drift.force.rate": 0.06}),
    ("elbow_04", ("dry_friction.rate", "time_shift"), {"dry_friction.rate.limit": 1.6, "time_shift.delay": 0.12}),
    ("foot_01", ("series_compliance",), {"series_compliance.compliance": 3e-6}),
    ("foot_03", ("sensor_gain.force_x",), {"sensor_gain.force_x.gain": -0.25}),
]
"""What labels.json says in words; the simulator behind these cases shares no code with this one."""
STARTS = {"elbow": {"k": 260.0, "x": 0.035, "y": 0.05}, "foot": {}}
FLOOR = {"force": 0.25, "force_x": 5.0, "force_y": 15.0, "cop_x": 0.001}


def fitted(case: GapCase, system: System) -> dict[str, float]:
    """Least squares over the calibration trials, every channel over its floor."""
    free = [p for p in system.parameters if not p.fixed]
    start = {**system.start, **STARTS[case.system]}
    scale = np.array([abs(p.start) or p.upper for p in free])
    floor = [FLOOR[name] for name in system.outputs]

    def residual(u: np.ndarray) -> np.ndarray:
        values = dict(zip([p.name for p in free], u * scale, strict=True))
        gaps = []
        for trial in case.calibration:
            measured = np.column_stack([trial.column(name) for name in system.outputs])
            gaps.append(np.nan_to_num((system.simulate(trial, values) - measured) / floor).ravel())
        return np.concatenate(gaps)

    low, high = (np.array([getattr(p, side) for p in free]) / scale for side in ("lower", "upper"))
    first = np.clip([start[p.name] for p in free] / scale, low + 1e-9, high - 1e-9)
    fit = least_squares(residual, first, bounds=(low, high), x_scale="jac")
    return dict(zip([p.name for p in free], fit.x * scale, strict=True))


@pytest.mark.parametrize(("name", "labels", "planted"), PLANTED, ids=lambda v: v if isinstance(v, str) else "")
def test_planted_effects_have_the_size_that_was_planted(
    practice: Path, name: str, labels: tuple[str, ...], planted: dict[str, float]
) -> None:
    case = read_gap_case(practice / name)
    system = system_of(case)
    offered = {one.label: one for one in candidates(system)}
    for label in labels:
        system = offered[label].apply(system)
    found = fitted(case, system)
    assert {key: found[key] for key in planted} == pytest.approx(planted, rel=0.05)
