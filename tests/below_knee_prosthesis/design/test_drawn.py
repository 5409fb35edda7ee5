"""Draws of a sweep: mirror images about the recording, errors of the map, and answers that widen with the errors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.prosthesis.forward import forward_run
from geocontact.below_knee_prosthesis.design.choice import choose, interval
from geocontact.below_knee_prosthesis.design.drawn import MEASURED, NONE, MapError, draws, stiffer
from geocontact.below_knee_prosthesis.design.foot_map import FootMap
from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.below_knee_prosthesis.design.knob import AIMS, Knob
from geocontact.below_knee_prosthesis.keel.keel import tip_compliance
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.below_knee_prosthesis.design.tasks import a_task

ENERGY = AIMS.index("energy")
SURE = np.zeros(15)


class StillKnob(Knob):
    """Without the third response, whose motion takes longest and enters no answer: the first in its place."""

    def measured(self, maps: Sequence[FootMap], task: FootTask) -> np.ndarray:
        still = self.measured_still(maps, task)
        return np.concatenate([still, still[:1]])


VALUES = np.array([0.07, 0.11, 0.15])
KNOB = StillKnob("fulcrum", VALUES, 0.11)


def erring(size: float) -> Callable[[np.random.Generator], FootTask]:
    """A foot's turns that are noisy on top of how they were recorded: keels bend and unbend more, never less."""

    def again(rng: np.random.Generator) -> FootTask:
        task = a_task()
        return replace(task, pitch=task.pitch + size * rng.standard_normal(len(task.time)))

    return again


@pytest.fixture(scope="module")
def noisy() -> dict[float, np.ndarray]:
    """Outcomes of energy with angles kept, with small and with large errors of pitch [rad]."""
    found = {}
    for size in (0.002, 0.02):
        given = KNOB, vsf_foot(), a_task(), erring(size), SURE
        drawn = draws(*given, feet=1, walks=12, keel=0.0, model=NONE).drawn
        found[size] = drawn[:, 0, :, ENERGY]
    return found


def test_each_draw_counts_with_its_mirror_image(noisy: dict[float, np.ndarray]) -> None:
    """About what the recording itself has on that foot, so that errors that only add are taken off as often."""
    of_recording = KNOB.measured_still(KNOB.maps(vsf_foot(), a_task()), a_task())[0, :, ENERGY]
    for drawn in noisy.values():
        assert len(drawn) == 24
        np.testing.assert_allclose(0.5 * (drawn[0::2] + drawn[1::2]), np.tile(of_recording, (12, 1)), rtol=6e-3)
    biased = noisy[0.02][0::2].mean(axis=0) - of_recording
    assert np.abs(biased).max() > 0.05 * of_recording.min()  # what the mirror images are for


def test_the_answers_interval_widens_with_the_errors(noisy: dict[float, np.ndarray]) -> None:
    """On both sides; draws alone move to one side instead, as the recording's own error has once already."""
    width, ends = {}, {}
    for size, drawn in noisy.items():
        wanted = float(np.median(drawn[:, 1]))
        chosen = choose(VALUES, np.repeat(drawn[:, None], 3, axis=1), "nearest", wanted, 0.11, 0.95).sides[
            "angles kept"
        ]
        width[size], ends[size] = chosen.upper - chosen.lower, (chosen.lower, chosen.upper)
    assert width[0.02] > 1.5 * width[0.002]
    assert ends[0.02][0] < ends[0.002][0] and ends[0.02][1] > ends[0.002][1]


def test_a_further_alignment_of_nothing_is_the_draw_itself() -> None:
    """With the recorded load, whose error is the same in both."""
    given = KNOB, vsf_foot(), a_task(), erring(0.002), SURE
    found = draws(*given, feet=1, walks=1, keel=0.0, alignments=(0.0,))
    np.testing.assert_allclose(found.beside[:, 0], found.drawn[:, :2], rtol=1e-9)
    assert np.abs(found.free / found.drawn - 1.0)[:, :, [0, 2], ENERGY].min() > 1e-4
    np.testing.assert_allclose(found.free[:, :, 1], found.drawn[:, :, 1])  # the present foot bears what it bore


def test_errors_of_the_map_are_one_for_all_values_and_grow_with_the_stiffness() -> None:
    knob = Knob("fulcrum", np.array([0.066, 0.11, 0.15]), 0.11)
    keel, rng = vsf_foot().keel, np.random.default_rng(3)
    soft = [tip_compliance(f, keel.length, keel.bending, keel.support) for f in knob.settings]
    by_hand = np.log(soft[1] / np.array(soft))
    np.testing.assert_allclose(stiffer(knob, keel), by_hand, atol=1e-12)
    np.testing.assert_allclose(stiffer(Knob("stiffness", np.array([0.6, 1.6]), 0.11), keel), np.log([0.6, 1.6]))
    assert not stiffer(Knob("alignment", np.array([-0.1, 0.1]), 0.11), keel).any()
    model = MapError({"energy": 0.03}, {"energy": 0.2})
    pairs = [model.factors(by_hand, rng) for _ in range(4000)]
    own, load = (np.log([pair[k] for pair in pairs]) for k in (0, 1))
    assert not np.delete(own, ENERGY, axis=1).any() and not np.delete(load, ENERGY, axis=2).any()
    assert own[:, ENERGY].std() == pytest.approx(0.03, rel=0.04)
    np.testing.assert_allclose(load[..., ENERGY].std(axis=0), np.abs(0.2 * by_hand), rtol=0.04)
    np.testing.assert_allclose(load[:, 2, ENERGY] / by_hand[2], load[:, 0, ENERGY] / by_hand[0], atol=1e-12)


@pytest.mark.slow
@pytest.mark.long  # with every change: the draws above; the shipped trial in tests/analyses/prosthesis/test_design.py
@pytest.mark.parametrize("person", [0, 3])
def test_forward_dynamics_is_within_the_bands(person: int) -> None:
    """Energy that the keel returns, on the recorded foot and on three others along the same turns of all joints.

    7.6 J for 9.8 on the recorded foot where the force along the ground did not bend the keel.
    """
    run = forward_run(person, "medium")
    simulated = run.simulated()
    knob = Knob("fulcrum", np.array(sorted(simulated)), run.present)
    sd = np.full(15, 0.05)
    found = draws(knob, vsf_foot(), run.task, lambda _: run.task, sd, feet=6, walks=4, keel=0.01).free
    for k, fulcrum in enumerate(knob.settings):
        median, lower, upper = interval(found[:, 0, k, ENERGY], 0.95)
        energy = simulated[float(fulcrum)]["energy"]
        assert lower < energy < upper, f"{1e3 * fulcrum:.0f} mm: {energy:.2f} J, {lower:.2f} to {upper:.2f}"
        if fulcrum == run.present:
            assert median == pytest.approx(energy, rel=0.10)
            assert upper - lower < 0.4 * median
    assert MEASURED.here["energy"] < 0.06  # the bands hold for what the map knows, not for their width
