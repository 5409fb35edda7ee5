"""Every term of the cost of every phase against plain NumPy, by the formula of docs/theory/sit_to_stand.md.

J = ∫ (f/100) Σ ((h - y)/σ)² + Σ (j/σ_j)² dt + (1/100) Σ ((p - p₀)/s)², each channel with a noise and each number with a
value of its own, so that one that counts twice, or in another's noise, is seen.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest

from geocontact.dynamics.collocation.blocks import sparse_program
from geocontact.dynamics.collocation.motion import scheme
from geocontact.dynamics.collocation.problem import ControlledSystem
from geocontact.dynamics.collocation.transcription import Transcription, scales_from
from geocontact.standing_up.chain import FOOT_PARAMETERS, SOUGHT, SOUGHT_WORN, Subject, feet_on_ground
from geocontact.standing_up.exoskeleton import strapped, with_exoskeleton
from geocontact.standing_up.phase import PhaseProblem
from geocontact.standing_up.phases import phase_a, phase_b, phase_c
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import STRAP_SITES
from geocontact.standing_up.trials import StandingNoise, StandingTrial
from tests.standing_up.by_hand import Foot, Springs, ground, strap

casadi = pytest.importorskip("casadi")
SUBJECT, RNG = Subject(), np.random.default_rng(7)
NOISE = StandingNoise(length=1.5e-3, angle=0.013, rate=0.037, force=7.0, centre=2.3e-3, torque=3.1, strap=1.7)
RATE, COUNT = 40.0, 21
AT = 10
"""Sample at which the cost is looked at; channels are given exactly there."""
FOOT = Foot(5e6, -0.04, 0.13, 0.09, 0.03, 1.2, 1.1)
SPRINGS = {
    "thigh": Springs(4e3, 2.2e3, 31.0, 0.21),
    "shank": Springs(3.1e3, 1.7e3, 19.0, 0.26),
    "pelvis": Springs(5.3e3, 2.9e3, 23.0, 0.08),
}
LEGS = {"thigh": 2, "shank": 2, "pelvis": 1}
VALUES = [*FOOT, *SPRINGS["thigh"], *SPRINGS["shank"], *SPRINGS["pelvis"]]


@dataclass(frozen=True)
class Place:
    """Numbers of every symbol of a phase."""

    q: np.ndarray
    u: np.ndarray
    jerk: np.ndarray
    torque: np.ndarray


def place(model: StandingModel) -> Place:
    """A foot that slides and turns on the ground, all else anyhow."""
    n = model.count
    q = np.r_[0.05, 0.082, 0.02, RNG.normal(size=n - 3) * 0.2]
    u = np.r_[0.03, -0.02, 0.1, RNG.normal(size=n - 3)]
    return Place(q, u, 50.0 * RNG.normal(size=n), 40.0 * RNG.normal(size=n - 3))


def trial(model: StandingModel, name: str = "T1") -> StandingTrial:
    """Any numbers in all channels, of a size that differs from entry to entry; the shank has no mat."""
    n, time = model.count, np.arange(COUNT) / RATE
    size = 1.0 + np.arange(n)
    sites = {site: 10.0 * RNG.normal(size=COUNT) for site in model.elsewhere}
    if "shank" in sites:
        sites["shank"] = np.full(COUNT, np.nan)
    return StandingTrial(
        time,
        0.05 * size * RNG.normal(size=(COUNT, n)) + np.r_[0.0, 0.08, np.zeros(n - 2)],
        0.3 * size * RNG.normal(size=(COUNT, n)),
        np.array([20.0, 700.0]) + np.array([5.0, 40.0]) * RNG.normal(size=(COUNT, 2)),
        0.05 + 0.01 * RNG.normal(size=COUNT),
        name,
        10.0 * np.arange(1, n - 2) * RNG.normal(size=(COUNT, n - 3)),
        12.0 * RNG.normal(size=COUNT) if n > 6 else None,
        elsewhere=sites,
    )


def searched(model: StandingModel) -> np.ndarray:
    """Of `VALUES`."""
    pairs = zip(model.parameters, VALUES, strict=False)
    return np.array([np.log(v / each.usual) if each.logarithm else v for each, v in pairs])


def squares(off: np.ndarray | float, size: np.ndarray | float) -> float:
    """Σ (off/size)²."""
    return float(np.sum((np.asarray(off) / size) ** 2))


def expected(model: StandingModel, seen: StandingTrial, at: Place) -> dict[str, float]:
    """Terms of the formula."""
    n, share = model.count, RATE / 100.0
    force, centre = ground(at.q, at.u, FOOT)
    sites = ("thigh", *model.elsewhere) if n > 6 else ()
    worn = {site: strap(at.q, at.u, SPRINGS[site], site) for site in sites}
    mats = {"thigh": seen.strap, **seen.elsewhere}
    off = [float(mats[site][AT]) - worn[site].normal for site in sites]  # type: ignore[index]
    unseen = sum(LEGS[site] * worn[site].unseen for site in sites)
    whole = unseen + sum(LEGS[site] * worn[site].seen for site in sites)
    noise_q = np.r_[NOISE.length, NOISE.length, np.full(n - 2, NOISE.angle)]
    torque = seen.torque
    assert torque is not None
    return {
        "coordinates": share * squares(at.q - seen.q[AT], noise_q),
        "rates": share * squares(at.u - seen.u[AT], NOISE.rate),
        "force": share * squares(force - seen.force[AT], NOISE.force),
        "centre": share * squares(centre - seen.centre[AT], NOISE.centre),
        "torque": share * squares(at.torque - torque[AT], NOISE.torque),
        "strap": share * squares(np.array(off)[np.isfinite(off)], NOISE.strap),
        "jerk": squares(at.jerk, np.r_[20.0, 20.0, 20.0, np.full(n - 3, 60.0)]),
        "torques": 1e-6 * squares(at.torque, 1.0),
        "energy": 1e-3 * unseen**2,
        "whole energy": 1e-3 * whole**2,
    }


def belief(model: StandingModel, free: tuple[str, ...], p: np.ndarray) -> float:
    """(1/100) Σ ((p - p₀)/s)², p₀ = 0 where the logarithm of a part of the usual value is searched."""
    total = 0.0
    for each, value in zip(model.parameters, p, strict=True):
        if each.name in free:
            total += ((value - (0.0 if each.logarithm else each.usual)) / each.sd) ** 2
    return total / 100.0


def costs(system: ControlledSystem, terms: dict, w: np.ndarray, at: Place, p: np.ndarray) -> tuple[np.ndarray, float]:
    """Values of terms and of the whole cost."""
    both = casadi.Function(
        "c", [system.x, system.u, system.w, system.p], [casadi.vertcat(*terms.values()), system.cost]
    )
    x = np.r_[at.q, at.u, np.zeros(len(at.q))]
    values, total = both(x, np.r_[at.jerk, at.torque], w, p)
    return values.full().ravel(), float(total)


A, B, C = (
    ("coordinates", "rates", "force", "centre", "torques", "jerk"),
    ("coordinates", "rates", "force", "centre", "torque", "strap", "energy", "jerk"),
    ("force", "centre", "torque", "whole energy", "jerk"),
)
MODELS = {
    "alone": lambda: feet_on_ground(SUBJECT),
    "worn": lambda: with_exoskeleton(SUBJECT),
    "three sites": lambda: strapped(SUBJECT, STRAP_SITES),
}
STRAPS = tuple(name for site in STRAP_SITES for name in site.names)


def built(phase: str, model: StandingModel, seen: StandingTrial) -> tuple[PhaseProblem, tuple[str, ...]]:
    """The phase, and what is free in it."""
    p = searched(model)
    if phase == "A":
        free = SOUGHT_WORN if model.count > 6 else SOUGHT
        return phase_a(model, SUBJECT, [seen], NOISE, free=free, start=p), free
    if phase == "B":
        free = tuple(each.name for each in model.parameters[len(FOOT_PARAMETERS) :])
        return phase_b(model, SUBJECT, [seen], NOISE, p[:7], free=free), free
    return phase_c(model, SUBJECT, seen, NOISE, p), ()


@pytest.mark.parametrize(
    ("phase", "kind", "names"),
    [
        ("A", "alone", A),
        ("A", "worn", A),
        ("B", "worn", B),
        ("B", "three sites", B),
        ("C", "worn", C),
        ("C", "three sites", C),
    ],
)
def test_each_term_is_that_of_the_formula(phase: str, kind: str, names: tuple[str, ...]) -> None:
    model = MODELS[kind]()
    seen, at, p = trial(model), place(model), searched(model)
    one, free = built(phase, model, seen)
    control = one.control
    w = control.trials[0].inputs(np.array([AT / RATE]))[0]
    terms, total = costs(control.system, dict(one.terms), w, at, p)
    wanted = expected(model, seen, at)
    assert tuple(one.terms) == tuple(name.removeprefix("whole ") for name in names)
    for name, value in zip(names, terms, strict=True):
        assert value == pytest.approx(wanted[name], rel=1e-6), name
        assert value > 0.0, name
    assert total == pytest.approx(sum(wanted[name] for name in names), rel=1e-6)
    prior = casadi.Function("prior", [control.system.p], [control.system.prior])
    assert float(prior(p)) == pytest.approx(belief(model, free, p), rel=1e-12)


def test_the_problem_adds_the_terms_over_time_and_trials_and_the_belief_once() -> None:
    """Two trials of two uneven intervals each, anywhere: J by Radau's weights, which are exact for 1 … t²."""
    model = feet_on_ground(SUBJECT)
    seen = [trial(model), trial(model, "T2")]
    one = phase_a(model, SUBJECT, seen, NOISE, free=SOUGHT, start=searched(model))
    points, mesh = scheme("radau", 2), np.array([0.0, 0.3, 1.0])
    on = Transcription(one.control, points, (mesh, mesh), scales_from(one.control))
    program = sparse_program(on.blocks(), on.size)
    still = np.r_[0.05, 0.082, np.zeros(16)]
    seconds = [each.guessed_duration for each in one.control.trials]
    resting = [lambda time: np.tile(still, (len(time), 1))] * 2, [lambda time: np.zeros((len(time), 9))] * 2
    z = on.packed(one.control.guess_p, seconds, *resting)
    moves = np.ones(on.size, bool)
    moves[on.first[:-1]] = False
    z[moves] += 0.1 * RNG.normal(size=int(moves.sum()))
    p, motions = on.unpacked(z)
    radau = np.array([1.0 / 3.0, 1.0]), np.array([0.75, 0.25])
    total, s = belief(model, SOUGHT, p), one.control.system
    for motion, of, long in zip(motions, one.control.trials, seconds, strict=True):
        for k, (begin, end) in enumerate(pairwise(mesh)):
            for j, (tau, weight) in enumerate(zip(*radau, strict=True)):
                w = of.inputs(np.array([long * (begin + tau * (end - begin))]))[0]
                x, u = motion.states[k, 1 + j], motion.controls[k, j]
                at = Place(x[:6], x[6:12], u[:6], u[6:])
                total += long * (end - begin) * weight * costs(s, dict(one.terms), w, at, p)[1]
    assert float(program.value(z, [])[0]) == pytest.approx(total, rel=1e-9)


def test_the_energy_of_straps_counts_by_its_weight() -> None:
    """In phases B and C: twice the weight is twice the term, and the sizes of the jerk are the study's."""
    from casadi import Function

    from geocontact.standing_up.chain import EVERY_PLANTED, Subject
    from geocontact.standing_up.exoskeleton import STRAP_PLANTED, with_exoskeleton
    from geocontact.standing_up.phases import phase_b, phase_c
    from geocontact.standing_up.trials import SHIPPED, CostWeights, StandingNoise, StandingTrial

    model, time = with_exoskeleton(Subject()), np.linspace(0.0, 1.0, 41)
    flat = np.tile(np.r_[0.05, 0.082, np.zeros(7)], (41, 1))
    force, none = np.tile([20.0, 700.0], (41, 1)), np.zeros(41)
    trial = StandingTrial(time, flat, 0.0 * flat, force, none + 0.06, torque=np.zeros((41, 6)), strap=none)
    p, x = np.r_[EVERY_PLANTED, STRAP_PLANTED], np.r_[flat[0] + 0.02 * np.arange(9), np.zeros(18)]
    values = {}
    for name, weights in (("shipped", SHIPPED), ("own", CostWeights(energy=2e-3, foot_jerk=10.0, joint_jerk=30.0))):
        for phase in (
            phase_b(model, Subject(), [trial], StandingNoise(), EVERY_PLANTED, weights=weights),
            phase_c(model, Subject(), trial, StandingNoise(), p, weights=weights),
        ):
            s, terms = phase.control.system, phase.terms
            at = Function("at", [s.x, s.u, s.p], [terms["energy"], terms["jerk"]])
            values.setdefault(name, []).append([float(each) for each in at(x, np.ones(15), p)])
    energies, jerks = (np.array([values[name] for name in ("shipped", "own")])[:, :, k] for k in (0, 1))
    assert (energies[0] > 0.0).all() and np.allclose(energies[1], 2.0 * energies[0])
    assert np.allclose(jerks, [[3 / 20.0**2 + 6 / 60.0**2] * 2, [3 / 10.0**2 + 6 / 30.0**2] * 2])
