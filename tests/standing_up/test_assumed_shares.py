"""What an interval owes to what is given: derivatives against problems solved again, and straps of another model."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.standing.other_world import World, own_trials
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.dynamics.collocation.solve import CollocationResult, SolverOptions, solve
from geocontact.standing_up.assumed_shares import JERK_KNOWN, AssumedShares, assumed_shares
from geocontact.standing_up.chain import EVERY_PLANTED, FOOT_PARAMETERS, Subject
from geocontact.standing_up.contact_numbers import ContactNumber, ContactNumbers, contact_numbers, held_covariance
from geocontact.standing_up.exoskeleton import STRAP, with_exoskeleton
from geocontact.standing_up.phase import PhaseProblem, standing_phase
from geocontact.standing_up.phases import TRACKS_B, phase_b
from geocontact.standing_up.strap_sites import searched, usual
from geocontact.standing_up.trials import FOOT_JERK, JOINT_JERK, LITTLE_ENERGY, StandingNoise, with_noise
from tests.cli.calls import MESHES

FEET = len(FOOT_PARAMETERS)
OPTIONS = SolverOptions("radau", 3, 1, 1e-9)


def test_covariances_add_as_the_formula_says() -> None:
    """Two numbers sought, one held with an sd of 0.1, two sizes of the jerk."""
    by_held, by_jerk, known = np.zeros((3, 3)), np.zeros((3, 2)), np.zeros((3, 3))
    by_held[:2, 2], by_jerk[:2], known[2, 2] = [3.0, -1.0], [[0.2, 0.0], [0.3, 0.4]], 0.1**2
    shares = AssumedShares(by_held, by_jerk, known)
    size = np.log(JERK_KNOWN)
    np.testing.assert_allclose(shares.sd, [np.hypot(0.3, 0.2 * size), np.hypot(0.1, 0.5 * size), 0.0])


def test_what_another_phase_did_not_tell_is_known_as_believed() -> None:
    """Two that the trials tell with their correlation; one on its bound and one that was held with the belief's sd."""
    names = [each.name for each in FOOT_PARAMETERS]

    def number(name: str) -> ContactNumber:
        verdict = {"heel": "on its bound", "dissipation": "held"}.get(name, "known")
        return ContactNumber(name, "m", 1.0, 0.9, 1.1, 1.0, 0.02 if verdict == "known" else np.inf, verdict)  # type: ignore[arg-type]

    kept = tuple(name for name in names if name not in ("heel", "dissipation"))
    correlation = np.full((5, 5), 0.4) + 0.6 * np.eye(5)
    numbers = ContactNumbers(tuple(map(number, names)), kept, correlation, None, np.ones(5))
    found = held_covariance(numbers, FOOT_PARAMETERS)
    sizes = [0.02 if name in kept else each.sd for name, each in zip(names, FOOT_PARAMETERS, strict=True)]
    np.testing.assert_allclose(np.sqrt(np.diag(found)), sizes)
    assert found[0, 2] == pytest.approx(0.4 * 0.02**2) and found[0, 1] == found[1, 5] == 0.0


def solved_again(
    warm: CollocationResult | None, feet: np.ndarray, sizes: tuple[float, float]
) -> tuple[PhaseProblem, CollocationResult]:
    """The strap of the shortest shipped trial."""
    study = standing_trials(Path(MESHES) / "standing_up_exoskeleton" / "study.toml", "study")
    trial = min(study.trials, key=lambda each: each.time[-1])
    model = with_exoskeleton(study.subject)
    phase = standing_phase(
        model,
        study.subject,
        [trial],
        study.noise,
        free=STRAP,
        tracks=TRACKS_B,
        small={"energy": LITTLE_ENERGY * model.energy**2},
        held=np.r_[feet, usual(model.parameters[FEET:])],
        start=np.r_[feet, usual(model.parameters[FEET:]) if warm is None else warm.p[FEET:]],
        jerk_sizes=sizes,
    )
    mesh = np.linspace(0.0, 1.0, round(8.0 * float(trial.time[-1])) + 1)
    found = solve(phase.control, OPTIONS, meshes=(mesh,), warm=warm)
    assert found.solved
    return phase, found


@pytest.mark.slow
def test_derivatives_are_those_of_problems_solved_again() -> None:
    """By the place of the heel, and by the size of the jerk of all joints, the exoskeleton's among them."""
    phase, found = solved_again(None, EVERY_PLANTED, (FOOT_JERK, JOINT_JERK))
    known = np.diag(np.r_[np.full(FEET, 1e-4), np.zeros(4)])
    shares, sides = assumed_shares(phase, found, known, [False] * 11), []
    heel = [each.name for each in FOOT_PARAMETERS].index("heel")
    for sign in (1.0, -1.0):
        moved = EVERY_PLANTED + sign * 1e-3 * np.eye(FEET)[heel]
        sides.append(solved_again(found, moved, (FOOT_JERK, JOINT_JERK))[1].p[FEET:])
    change = (sides[0] - sides[1]) / 2e-3
    np.testing.assert_allclose(shares.by_held[FEET:, heel], change, rtol=0.02, atol=0.02 * np.abs(change).max())
    assert not shares.by_held[:FEET].any() and not shares.by_held[:, FEET:].any()
    sides = [
        solved_again(found, EVERY_PLANTED, (FOOT_JERK, times * JOINT_JERK))[1].p[FEET:] for times in (1.05, 1 / 1.05)
    ]
    change = (sides[0] - sides[1]) / (2.0 * np.log(1.05))
    np.testing.assert_allclose(
        shares.by_jerk[FEET:, 1:].sum(axis=1), change, rtol=0.02, atol=0.02 * np.abs(change).max()
    )


@pytest.mark.slow
def test_straps_of_another_model_are_inside_their_intervals() -> None:
    """A controller drives the person; Laplace's interval alone is 3 and more standard deviations off.

    The feet are held at what is planted: the bias is that of the jerk's size.
    """
    world = World()
    subject, noise = Subject(world.mass, world.height), StandingNoise()
    model = with_exoskeleton(subject)
    trials = [with_noise(each, model, noise, k) for k, each in enumerate(own_trials(world, [2]))]
    numbers = (world.modulus, world.heel, world.toe, world.bottom, world.radius, world.dissipation, world.friction)
    phase = phase_b(model, subject, trials, noise, searched(FOOT_PARAMETERS, numbers))
    meshes = tuple(np.linspace(0.0, 1.0, round(10.0 * float(t.time[-1])) + 1) for t in trials)
    found = solve(phase.control, SolverOptions("radau", 3, 1, 1e-7), meshes=meshes)
    told = contact_numbers(phase, found, held=np.zeros((11, 11))).numbers[FEET:]
    normal = told[0]
    off = np.log(normal.value / world.normal)
    assert abs(off) > 3.0 * normal.by_trials
    for number, planted in zip(told, world.strap, strict=True):
        assert number.verdict == "known" and number.lower < planted < number.upper, number
    assert normal.upper / normal.lower < 1.3
