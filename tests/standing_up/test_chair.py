"""The force of a chair as a load on the trunk: it carries weight, its place counts, and phase A finds the feet."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.dynamics.collocation.solve import SolverOptions, solve
from geocontact.standing_up.chain import PLANTED, Subject, feet_on_ground
from geocontact.standing_up.exoskeleton import STRAP_PLANTED, with_exoskeleton
from geocontact.standing_up.phase import judged
from geocontact.standing_up.phases import phase_a
from geocontact.standing_up.trials import StandingNoise, recorded, standing_up

SUBJECT = Subject()


@pytest.mark.parametrize("worn", [False, True])
def test_a_chair_carries_weight_where_it_stands(worn: bool) -> None:
    """200 N up, 0.3 m behind the ankle, against d(power)/d(rate): along each coordinate F . dx/dq of that point."""
    from casadi import Function

    model = (with_exoskeleton if worn else feet_on_ground)(SUBJECT, seated=True)
    e, n = model.equations, model.count
    assert model.joints == e.names[3:] and model.given == 3 and e.w.numel() == n
    p = np.r_[PLANTED, STRAP_PLANTED] if worn else PLANTED
    balance = Function("balance", [e.q, e.u, e.a, e.w, e.p], [e.balance])
    q = np.zeros(n)
    q[:6] = [0.1, 3.0, 0.1, -0.4, 1.2, -0.7]
    still = np.zeros(n)
    x, force = q[0] - 0.3, np.array([20.0, 200.0])
    with_it, without = (
        balance(q, still, still, np.r_[np.zeros(n - 3), load], p).full().ravel()
        for load in (np.r_[force, x * force[1]], np.zeros(3))
    )
    by = with_it - without
    np.testing.assert_allclose(by[:2], force, atol=1e-9)
    # about the ankle: the force's moment there; the trunk turns with all joints below it
    assert by[3] == pytest.approx((x - q[0]) * force[1] + q[1] * force[0], abs=1e-9)
    assert by[2] == pytest.approx(by[3], abs=1e-9) and np.abs(by[6:]).max(initial=0.0) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.slow
def test_phase_a_of_a_trial_that_begins_on_the_chair() -> None:
    """300 N that the chair lets go in 0.3 s: solved, certified, parameters near; without the load the force is off."""
    noise, model = StandingNoise(), feet_on_ground(SUBJECT, seated=True)

    def chair(time: np.ndarray) -> np.ndarray:
        up = 300.0 * np.clip(1.0 - time / 0.3, 0.0, 1.0) ** 3
        return np.column_stack([0.0 * up, up, -0.35 * up])

    _, truth = standing_up(model, SUBJECT, seconds=1.2, intervals=30, chair=chair)
    assert truth.solved
    trial = recorded(model, truth.motions[0], truth.p, 100.0, noise, 7)
    assert trial.force[0, 1] < 70.0 * 9.81 - 150.0, "the chair carries a part"
    off, residuals = [], []
    for load in (chair(trial.time), np.zeros((len(trial.time), 3))):
        phase = phase_a(model, SUBJECT, [type(trial)(**(vars(trial) | {"chair": load}))], noise)
        found = solve(phase.control, SolverOptions("radau", 4, 36, 1e-7, 300))
        (seen,) = judged(model.stepper, range(3), model.turning, phase, found, certify=found.solved)
        off.append(np.abs(found.p - PLANTED)[:3])
        residuals.append((found.objective, seen.certificate is not None and seen.certificate.converged))
    assert residuals[0][1] and residuals[1][0] > 3.0 * residuals[0][0], residuals
    assert off[0][0] < 0.3 and off[0][1:].max() < 5e-3, off
