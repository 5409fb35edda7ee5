"""Noise of a centre of pressure grows as one over the force that it is divided by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.parameter import Parameter
from geocontact.gap.case.noise_sources import noise_spread, quotient_noise
from geocontact.systems.elastic_joint import JOINT

PLAIN = JOINT.build((Parameter("k", "N m/rad", 60.0, 10.0, 200.0),), {}, {})
SYSTEM = replace(PLAIN, balance=replace(PLAIN.balance, outputs=("force_y", "cop_x")), quotients={"cop_x": "force_y"})


def test_few_samples_at_small_forces_do_not_outweigh_the_others() -> None:
    """A foot that leaves the ground: a centre of pressure of 20 N may be 50 mm off and tells next to nothing."""
    rng = np.random.default_rng(2)
    force = np.concatenate([np.full(400, 1000.0), np.full(20, 20.0)])
    moment = 0.1 * force * np.sin(np.linspace(0.0, 6.0, 420)) + rng.normal(0.0, 0.5, 420)
    cop = moment / force
    outputs = [np.column_stack([force, cop])]
    (spread,) = noise_spread(SYSTEM, outputs, quotient_noise(SYSTEM, outputs, np.array([5.0, 5e-4])))
    assert spread[:, 0] == pytest.approx(1.0)
    assert np.median(spread[:400, 1]) == pytest.approx(1.0)
    assert np.median(spread[400:, 1]) == pytest.approx(50.0, rel=0.5), "as the force is fifty times smaller"
    off = (cop - 0.1 * np.sin(np.linspace(0.0, 6.0, 420))) / (5e-4 * spread[:, 1])
    assert (off[400:] ** 2).sum() < 0.2 * (off[:400] ** 2).sum()


def test_where_nothing_was_measured_nothing_is_spread() -> None:
    outputs = [np.full((5, 2), np.nan)]
    (spread,) = noise_spread(SYSTEM, outputs, quotient_noise(SYSTEM, outputs, np.array([5.0, 5e-4])))
    assert (spread == 1.0).all()


def recorded(constant: float, moment: float, count: int = 2000) -> list[np.ndarray]:
    """Two trials of a foot that sways, its centre of pressure with noise of these two kinds."""
    time, rng, found = 0.005 * np.arange(count), np.random.default_rng(4), []
    for start in (0.0, 2.0):
        force = np.maximum(700.0 + 660.0 * np.sin(2.0 * np.pi * time + start), 25.0)
        noise = np.hypot(constant, moment / force) * rng.standard_normal(count)
        found.append(np.column_stack([force, 0.1 * np.sin(5.0 * time) + noise]))
    return found


@pytest.mark.parametrize(
    ("constant", "moment", "share"),
    [(1e-3, 0.0, 0.0), (0.0, 0.7, 1.0), (5e-4, 0.35, 0.5)],
    ids=["even", "grown", "both"],
)
def test_a_recording_shows_how_much_of_the_noise_grows(constant: float, moment: float, share: float) -> None:
    """Shares of the variance at the median force, 700 N, where the noise of both kinds is what is stated."""
    outputs = recorded(constant, moment)
    whole = float(np.hypot(constant, moment / 700.0))
    one = quotient_noise(SYSTEM, outputs, np.array([0.1, whole]))["cop_x"]
    assert (one.moment / 700.0 / whole) ** 2 == pytest.approx(share, abs=0.12)
    assert (one.constant / whole) ** 2 == pytest.approx(1.0 - share, abs=0.12)


def test_noise_of_the_force_moves_the_moment_at_the_least() -> None:
    """3 N at 0.1 m from the middle of the foot make 0.3 N m, also where few samples show no more."""
    one = quotient_noise(SYSTEM, [each[:20] for each in recorded(1e-3, 0.0)], np.array([3.0, 1e-3]))["cop_x"]
    low, high = np.quantile(np.concatenate([each[:20, 1] for each in recorded(1e-3, 0.0)]), [0.025, 0.975])
    assert one.moment == pytest.approx(3.0 * 0.5 * (high - low), rel=0.2)
    assert one.constant == 1e-3
