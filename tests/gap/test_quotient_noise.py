"""Noise of a centre of pressure grows as one over the force that it is divided by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.parameter import Parameter
from geocontact.gap.case.noise_sources import noise_spread
from geocontact.systems.elastic_joint import JOINT

PLAIN = JOINT.build((Parameter("k", "N m/rad", 60.0, 10.0, 200.0),), {}, {})
SYSTEM = replace(PLAIN, balance=replace(PLAIN.balance, outputs=("force_y", "cop_x")), quotients={"cop_x": "force_y"})


def test_few_samples_at_small_forces_do_not_outweigh_the_others() -> None:
    """A foot that leaves the ground: a centre of pressure of 20 N may be 50 mm off and tells next to nothing."""
    rng = np.random.default_rng(2)
    force = np.concatenate([np.full(400, 1000.0), np.full(20, 20.0)])
    moment = 0.1 * force * np.sin(np.linspace(0.0, 6.0, 420)) + rng.normal(0.0, 0.5, 420)
    cop = moment / force
    (spread,) = noise_spread(SYSTEM, [np.column_stack([force, cop])], np.array([5.0, 5e-4]))
    assert spread[:, 0] == pytest.approx(1.0)
    assert np.median(spread[:400, 1]) == pytest.approx(1.0)
    assert np.median(spread[400:, 1]) == pytest.approx(50.0, rel=0.5), "as the force is fifty times smaller"
    off = (cop - 0.1 * np.sin(np.linspace(0.0, 6.0, 420))) / (5e-4 * spread[:, 1])
    assert (off[400:] ** 2).sum() < 0.2 * (off[:400] ** 2).sum()


def test_where_nothing_was_measured_nothing_is_spread() -> None:
    (spread,) = noise_spread(SYSTEM, [np.full((5, 2), np.nan)], np.array([5.0, 5e-4]))
    assert (spread == 1.0).all()
