"""Cases of the shoulder's diagnosis: what the base model cannot have stays out, what is planted is named and fitted."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from benchmarks.shoulder import gap as shoulder_gap
from benchmarks.shoulder.gap import left_out
from benchmarks.shoulder.planted import HELD, PLANTED, STEP, motion_of, trial_of
from benchmarks.shoulder.refit import ADDED, MEANS, NAMED, Seen, fitted, offs, rms
from benchmarks.shoulder.trials import dominant_arm, wearer_of
from benchmarks.shoulder.truth import MAT, Measured
from geocontact.shoulder_exoskeleton.device import Device
from geocontact.shoulder_exoskeleton.plane import armrest_force
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, simulate_arm
from geocontact.shoulder_exoskeleton.support.phase_machine import SCREW
from geocontact.shoulder_exoskeleton.synthetic import OverheadTrial

SMOOTH = HELD.having(mu_s=0.0, mu_k=0.0)
"""Nothing rubs in its cuff."""


def simulated(
    name: str, device: Device = SMOOTH, push: float = 0.0, every: int = 1
) -> tuple[OverheadTrial, ArmSimulation, np.ndarray]:
    """A trial at every so many frames, the full model along it, and the force that presses while the tool runs."""
    trial = trial_of(name)
    motion, kept = motion_of(trial, "held"), slice(None, None, every)
    parts = {key: getattr(motion, key)[kept] for key in ("time", "interface", "shoulder", "elevation")}
    trial = replace(trial, phase=trial.phase[kept])
    pressed = np.where(trial.phase == SCREW, push, 0.0)
    motion, level = replace(motion, **parts), float(trial.condition.level or 0.0)
    return trial, simulate_arm(motion, device, wearer_of(trial.participant), level, pressed=pressed), pressed


def test_an_arm_in_the_plane_keeps_its_elevation_and_leaves_the_passive_joints() -> None:
    _, s, _ = simulated("t01", HELD)
    upper = s.motion.interface - s.motion.shoulder
    own = dominant_arm(trial_of("t01"))
    assert np.ptp(s.motion.interface[:, 0]) < 1e-12
    np.testing.assert_allclose(np.linalg.norm(upper, axis=1), np.linalg.norm(own.interface - own.shoulder, axis=1))
    np.testing.assert_allclose(upper[:, 2], (own.interface - own.shoulder)[:, 2], atol=1e-12)
    assert np.degrees(np.abs(s.angles[:, :2])).max() < 0.1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effect", "size"), [("push force", (8.0,)), ("play", (5.0,)), ("strap", (12.0,)), ("dry seals", (0.7, 0.03))]
)
def test_an_effect_inside_the_model_is_found_again(effect: str, size: tuple[float, ...]) -> None:
    """Planted by the model itself: the size comes back, and the held-out error goes to nothing."""
    what = ADDED[effect]
    numbers = {name: factor * x for (name, factor), x in zip(what.numbers.items(), size, strict=False)}
    seen = []
    for name in ("t01", "t03"):
        trial, s, pressed = simulated(name, SMOOTH.having(**numbers), size[0] if what.pushes else 0.0, every=4)
        shown = armrest_force(s, pressed)
        cells = np.zeros((len(shown), 0, 0))
        seen.append(Seen(trial, s.motion, Measured(s.motion.time, s.angles, s.elevation, cells, shown, shown)))
    found = fitted(seen[:1], SMOOTH, (what,))
    assert found == pytest.approx(size, rel=0.03)
    before, after = (offs(seen[1:], SMOOTH, w, x) for w, x in (((), np.zeros(0)), ((what,), found)))
    for one, other in zip(before, after, strict=True):
        assert rms(other) < 0.05 * rms(one)


def test_every_planted_effect_has_a_term_in_the_model() -> None:
    assert set(MEANS) | {"nothing"} == set(PLANTED) and set(MEANS.values()) == set(ADDED)
    assert set(NAMED.values()) == set(ADDED)


@pytest.mark.slow
@pytest.mark.long
def test_dry_seals_in_the_full_model_are_named_by_the_base_model(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The short form of the benchmark: two trials to fit to, one held out, ten frames a second; some CPU seconds."""
    monkeypatch.setattr(shoulder_gap, "CALIBRATION", ("t01", "t02"))
    monkeypatch.setattr(shoulder_gap, "EVALUATION", ("t03",))
    rng, made = np.random.default_rng(0), {}
    for name in ("t01", "t02", "t03"):
        trial, own, _ = simulated(name, every=10)
        _, s, _ = simulated(name, SMOOTH.having(seal_friction=0.8), every=10)
        mat = np.round((s.supporting + rng.normal(0.0, MAT[0], len(s.supporting))) / MAT[1]) * MAT[1]
        logger, cells = np.round(s.elevation / STEP) * STEP, np.zeros((len(mat), 0, 0))
        made[name] = (trial, Measured(s.motion.time, s.angles, logger, cells, s.supporting, mat), own)
    found = gc.diagnose(shoulder_gap.gathered(tmp_path, made), bare=True)
    assert str(found).startswith("dry_friction is missing")


@pytest.mark.slow
def test_the_base_model_follows_the_full_one_in_the_plane(tmp_path: Path) -> None:
    told = left_out(tmp_path)
    free, still = told["as the study"], told["and the shoulder stays"]
    assert free["exo_deg"] > 4.0 and free["force_N"] > 2.0
    assert still["exo_deg"] < 0.5 and still["force_N"] < 0.5
