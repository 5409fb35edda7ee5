"""Cases of the shoulder's diagnosis: what the base model cannot have stays out, what is named is fitted as planted."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.shoulder_gap import DEVICE, TRIALS, in_plane, left_out, refitted, regressor
from benchmarks.shoulder_trials import dominant_arm, wearer_of
from benchmarks.shoulder_truth import Measured
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, simulate_arm
from geocontact.shoulder_exoskeleton.synthetic.design import condition, participant, task
from geocontact.shoulder_exoskeleton.synthetic.trial import OverheadTrial, synthetic_trial


def simulated(name: str) -> tuple[OverheadTrial, ArmSimulation]:
    work, worn = TRIALS[name]
    trial = synthetic_trial(participant("P1"), task(work), condition(worn))
    wearer = wearer_of(trial.participant)
    motion = in_plane(dominant_arm(trial), DEVICE, wearer)
    return trial, simulate_arm(motion, DEVICE, wearer, float(trial.condition.level or 0.0))


def test_an_arm_in_the_plane_keeps_its_elevation_and_leaves_the_passive_joints() -> None:
    trial, s = simulated("t01")
    upper = s.motion.interface - s.motion.shoulder
    own = dominant_arm(trial)
    assert np.ptp(s.motion.interface[:, 0]) < 1e-12
    np.testing.assert_allclose(np.linalg.norm(upper, axis=1), np.linalg.norm(own.interface - own.shoulder, axis=1))
    np.testing.assert_allclose(upper[:, 2], (own.interface - own.shoulder)[:, 2], atol=1e-12)
    assert np.degrees(np.abs(s.angles[:, :2])).max() < 0.1


def test_a_planted_term_is_found_in_the_full_model() -> None:
    """Of each linear term, two units of it: the held-out error goes to nothing."""
    made = {name: simulated(name) for name in TRIALS}
    for effect in ("event_load", "preload", "dry_friction", "sensor_gain"):
        planted = {}
        for name, (trial, s) in made.items():
            term = regressor(effect, trial, s)
            assert term is not None
            cells = np.zeros((len(term), 0, 0))
            force = s.supporting + 2.0 * term
            planted[name] = (trial, Measured(s.motion.time, s.angles, s.elevation, cells, force, force), s)
        told = refitted([effect], planted)
        assert told["size"] == pytest.approx([2.0]) and told["after_N"] < 1e-9 < 0.1 < told["before_N"]


@pytest.mark.slow
def test_the_base_model_follows_the_full_one_in_the_plane(tmp_path: Path) -> None:
    told = left_out(tmp_path)
    free, still = told["as the study"], told["and the shoulder stays"]
    assert free["exo_deg"] > 4.0 and free["force_N"] > 2.0
    assert still["exo_deg"] < 0.5 and still["force_N"] < 0.5
