"""The finer truth of the shoulder exoskeleton: without friction and tilt it is the package's model, by other code."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.shoulder.truth import Truth, Withheld, measure
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arms_from_markers import arm_motions
from geocontact.shoulder_exoskeleton.device import Wearer, lucy
from geocontact.shoulder_exoskeleton.simulate import simulate_arm
from geocontact.shoulder_exoskeleton.synthetic import condition, participant, synthetic_trial, task

WEARER = Wearer(upper_arm=0.296, shoulder_width=0.385)
FRAMES = slice(60, 160)
"""Lifting, up to 100 degrees; the sphere stays in the cuff."""


@pytest.fixture(scope="module")
def motion() -> ArmMotion:
    trial = synthetic_trial(participant("P1"), task("T1"), condition("S100"))
    arm = next(each for each in arm_motions(trial.markers).arms if each.side == "right")
    cut = {name: getattr(arm, name)[FRAMES] for name in ("time", "interface", "shoulder", "elevation")}
    return replace(arm, **cut, gravity=arm.gravity_at_frames()[FRAMES])


@pytest.mark.slow
@pytest.mark.long
def test_two_codes_agree_where_the_models_do(motion: ArmMotion) -> None:
    """All cells on one ring: no tilt; no friction, little damping of the interface: same forces within 0.1 N."""
    device = lucy().having(mu_s=0.0, mu_k=0.0, b=0.0, passive_1_damping=1.0, passive_2_damping=1.0)
    model, truth = simulate_arm(motion, device, WEARER, 1.0), Truth(device, WEARER, 1.0)
    truth.s = 0.0 * truth.s
    found = measure(truth, motion, 1)
    np.testing.assert_allclose(np.degrees(found.angles), np.degrees(model.angles), atol=0.05)
    np.testing.assert_allclose(found.force, model.supporting, atol=0.1)


@pytest.mark.slow
@pytest.mark.long
def test_what_is_withheld_shows_where_it_should(motion: ArmMotion) -> None:
    """On one ring of cells without friction: a strap presses at rest, a push while the tool runs."""
    device = lucy().having(mu_s=0.0, mu_k=0.0, passive_1_damping=1.0, passive_2_damping=1.0)
    held = {name: getattr(motion, name)[:1].repeat(5, axis=0) for name in ("interface", "shoulder", "elevation")}
    still = replace(motion, time=motion.time[:5], gravity=motion.gravity_at_frames()[:5], **held)

    def force(withheld: Withheld, pushing: float = 0.0) -> float:
        truth = Truth(device, WEARER, 1.0, withheld)
        truth.s = 0.0 * truth.s
        return float(measure(truth, still, 1, np.full(5, pushing)).force[-1])

    nothing = force(Withheld())
    assert force(Withheld(strap=1e-2)) > nothing + 0.5
    assert force(Withheld(push=0.3), pushing=35.0) != pytest.approx(nothing, abs=0.5)
