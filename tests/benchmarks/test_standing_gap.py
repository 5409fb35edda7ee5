"""Effects of a strap: the finer one has them, the full model has the same term, and the base model sees what it may."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.standing.gap import ENCODERS, NONE, PLANTED_EFFECTS, VALUES, gathered, off_of
from benchmarks.standing.refit import FURTHER, NAMED, StrapWith
from benchmarks.standing.truth import PADS, PLANTED, PaddedStrap
from geocontact.contact.bushing import bushing_force
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import DAMPING, StrapLaw, with_exoskeleton
from geocontact.standing_up.strap import strap_motion
from geocontact.standing_up.trials import StandingTrial, with_noise

POSTURE = np.array([0.0, 0.083, 0.0, -0.4, 1.6, -2.0, -0.42, 1.66, -1.9])
SIZES = {"preload": 20.0, "stiffening": 0.7, "slip": 5.0, "tilt": -0.4}


def at_rest(strap: StrapLaw, further: tuple[str, ...], values: tuple[float, ...]) -> tuple[float, float]:
    """Force that the mat sees and shear of one strap [N]."""
    from casadi import Function

    numbers = tuple(FURTHER[name] for name in further)
    model = with_exoskeleton(Subject(), strap, numbers)
    p = np.r_[PLANTED, [each.searched(value) for each, value in zip(numbers, values, strict=True)]]
    seen = Function("seen", [model.equations.q, model.equations.u, model.equations.p], [model.strap, model.shear])
    normal, shear = seen(POSTURE, np.zeros(9), p)
    return float(normal), float(shear)


@pytest.mark.parametrize("effect", SIZES)
def test_the_full_model_s_term_is_the_effect_by_hand(effect: str) -> None:
    moved, size = strap_motion(Subject(), POSTURE[None], VALUES["strap place"]), SIZES[effect]
    across, along = VALUES["strap normal"] * moved.normal[0], VALUES["strap tangential"] * moved.tangential[0]
    wanted = {
        "preload": (across + size, along),
        "stiffening": (across * (1.0 + size * (moved.normal[0] / 0.01) ** 2), along),
        "slip": (across, size * np.tanh(along / size)),
        "tilt": (across * np.cos(size) + along * np.sin(size), along),
    }
    assert min(abs(across), abs(along)) > 1.0
    assert at_rest(StrapWith(effect), (effect,), (size,)) == pytest.approx(wanted[effect], rel=1e-9)


def test_pads_without_an_effect_carry_what_one_strap_does() -> None:
    """But for the second order of the angle between the thighs."""
    moved = strap_motion(Subject(), POSTURE[None], VALUES["strap place"])
    across, along = at_rest(PaddedStrap(), (), ())
    assert across == pytest.approx(VALUES["strap normal"] * moved.normal[0], rel=1e-6)
    assert along == pytest.approx(VALUES["strap tangential"] * moved.tangential[0], rel=1e-6) and PADS > 1


def test_every_planted_effect_has_a_term() -> None:
    assert {each.term for each in PLANTED_EFFECTS.values()} - {""} == set(FURTHER)
    assert set(NAMED.values()) <= set(FURTHER)


def test_the_base_model_follows_a_strap_and_not_a_preloaded_one(tmp_path: Path) -> None:
    time = np.linspace(0.0, 1.5, 151)
    off = np.outer(np.sin(2.0 * time), [0, 0, 0, 0, 0, 0, 0.01, 0.03, 0.0])
    model, trials = with_exoskeleton(Subject()), []
    for k in range(2):
        q = POSTURE + (1.0 + 0.3 * k) * off
        moved = strap_motion(Subject(), q, VALUES["strap place"]).normal
        force = bushing_force(moved, np.gradient(moved, time), VALUES["strap normal"], DAMPING)
        none = np.zeros(len(time))
        trials.append(StandingTrial(time, q, 0.0 * q, np.zeros((len(time), 2)), none, f"t{k}", None, force))
    noisy = [with_noise(each, model, replace(NONE, angle=ENCODERS.angle), k) for k, each in enumerate(trials)]
    loaded = [replace(each, strap=each.strap + 20.0) for each in noisy if each.strap is not None]
    assert off_of(gathered(tmp_path / "plain", tuple(noisy), 1)) < 1.0
    assert off_of(gathered(tmp_path / "loaded", tuple(loaded), 1)) == pytest.approx(20.0, abs=0.5)
