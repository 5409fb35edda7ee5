"""Base model of the knee: Hertz's law per side, written out again; sides, radius and memory."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.effects.catalogue import candidates
from geocontact.systems import knee as knee_implant
from tests.systems.examples import KNEE_CONSTANTS, example, knee

SYSTEM, TRIALS = example("knee")
E_STAR, R = 1.3e7, KNEE_CONSTANTS["R"]


def hertz(area: np.ndarray, radius: np.ndarray | float = R) -> np.ndarray:
    return 4.0 / 3.0 * E_STAR * (area / np.pi) ** 1.5 / radius


def with_effect(name: str, **values: float) -> np.ndarray:
    one = next(each for each in candidates(SYSTEM) if each.label == name)
    given = {p.name: values[p.name.split(".")[-1]] for p in one.parameters}
    return one.apply(SYSTEM).simulate(TRIALS[0], {"E_star": E_STAR, **given})


def test_each_side_presses_as_one_hertzian_circle() -> None:
    force = SYSTEM.simulate(TRIALS[0], {"E_star": E_STAR})
    for column, name in enumerate(("area_medial", "area_lateral")):
        np.testing.assert_allclose(force[:, column], hertz(TRIALS[0].column(name)), rtol=1e-12)


def test_without_area_there_is_no_force() -> None:
    signals = TRIALS[0].signals
    values = signals.values.copy()
    values[10:20, signals.channels.index("area_medial")] = 0.0
    trial = replace(TRIALS[0], signals=replace(signals, values=values))
    force = SYSTEM.simulate(trial, {"E_star": E_STAR})
    assert (force[10:20, 0] == 0.0).all()
    assert (force[10:20, 1] > 0.0).all()


def test_sides_differ_about_their_mean() -> None:
    force = with_effect("asymmetry", difference=0.12)
    np.testing.assert_allclose(force[:, 0], 1.12 * hertz(TRIALS[0].column("area_medial")), rtol=1e-12)
    np.testing.assert_allclose(force[:, 1], 0.88 * hertz(TRIALS[0].column("area_lateral")), rtol=1e-12)


def test_the_radius_follows_flexion() -> None:
    force = with_effect("axis_migration", slope=0.004, curvature=-0.002)
    angle = TRIALS[0].column("flexion") - SYSTEM.scale.centre["flexion"]
    radius = R + 0.004 * angle - 0.002 * angle**2
    np.testing.assert_allclose(force[:, 1], hertz(TRIALS[0].column("area_lateral"), radius), rtol=1e-12)


def test_rates_are_those_of_the_deflection() -> None:
    one = next(each for each in candidates(SYSTEM) if each.label == "axis_migration")
    system = one.apply(SYSTEM)
    values = {**system.known, "E_star": E_STAR, "axis_migration.slope": 0.01, "axis_migration.curvature": 0.004}
    movement = system.motion.seen(TRIALS[0], values)
    u, rate = system.geometry.deflection(movement, values)
    np.testing.assert_allclose(rate[5:-5], np.gradient(u, movement.time, axis=0)[5:-5], atol=2e-3 * np.abs(rate).max())


def test_sides_remember_apart() -> None:
    force = with_effect("relaxation", ratio=0.5, tau=0.3)
    swapped = TRIALS[0].signals.values[:, [0, 1, 3, 2, 4, 5]]
    other = replace(TRIALS[0], signals=replace(TRIALS[0].signals, values=swapped))
    one = next(each for each in candidates(SYSTEM) if each.label == "relaxation")
    values = {"E_star": E_STAR, "relaxation.ratio": 0.5, "relaxation.tau": 0.3}
    np.testing.assert_allclose(one.apply(SYSTEM).simulate(other, values), force[:, ::-1], rtol=1e-12)


def test_a_number_that_is_missing_is_named() -> None:
    with pytest.raises(ValueError, match="R is missing"):
        knee_implant.build(knee().parameters, {}, {})
