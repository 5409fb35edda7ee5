"""What an identified modulus makes least, and its profile, beside loops over plain numbers; areas at frames by hand."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from geocontact.data.parameter import Parameter
from geocontact.elastic_modulus.area_force import Adhesion, AreaForce, ThresholdAreas
from geocontact.elastic_modulus.identify import agreement, fitted, identify, modulus_parameter
from geocontact.elastic_modulus.threshold_calibration import calibrated
from tests.identify.synthetic_contact import LENGTH, READING

RNG = np.random.default_rng(12)
TIME = np.linspace(0.0, 1.0, 12)
AREA = 1e-6 * (400.0 + 300.0 * np.sin(pi * TIME) ** 2 + 40.0 * RNG.normal(size=12))
RADII = 0.037 + 0.002 * RNG.normal(size=12)
FRAMES = np.array([0.05, 0.11, 0.3, 0.34, 0.52, 0.71, 0.88])
FORCE = np.array([210.0, 330.0, 520.0, 610.0, 700.0, 480.0, 260.0])


def model(reading: str, adhesion: Adhesion | None = None) -> AreaForce:
    """Areas within 1.5 mm only; R differs from frame to frame, as where it follows flexion."""
    evolution = ThresholdAreas(TIME, np.array([1.5e-3]), AREA[:, None], RADII, LENGTH)
    return AreaForce(evolution, READING[reading], FRAMES, 0.0, 1.5e-3, adhesion)


def law(reading: str, area: float, R: float) -> float:
    """Force over E* [m²], of the table of docs/theory."""
    if reading == "disc":
        return 4.0 / 3.0 * sqrt(area / pi) ** 3 / R
    if reading == "discs":
        return 2.0 * 4.0 / 3.0 * sqrt(0.5 * area / pi) ** 3 / R
    if reading == "strip":
        return pi / 4.0 * (area / (2.0 * LENGTH)) ** 2 * LENGTH / R
    depth = area / (2.0 * pi * R) - (1.5e-3 if reading == "threshold" else 0.0)
    return 4.0 / 3.0 * sqrt(R) * depth**1.5 if depth > 0.0 else 0.0


def at_frames(curve: list[float]) -> list[float]:
    """Linear between the times of the areas."""
    found = []
    for t in FRAMES:
        k = max(j for j in range(11) if TIME[j] <= t)
        share = (t - TIME[k]) / (TIME[k + 1] - TIME[k])
        found.append((1.0 - share) * curve[k] + share * curve[k + 1])
    return found


@pytest.mark.parametrize("reading", list(READING))
def test_a_modulus_by_hand(reading: str) -> None:
    """E* = Σ m g / Σ g²; half Σ ((E* g - m)/s)² with s the root mean square of the force; R² about the mean."""
    unit = at_frames([law(reading, a, r) for a, r in zip(AREA, RADII, strict=True)])
    found = fitted(model(reading), FORCE, [modulus_parameter()])
    best = sum(m * g for m, g in zip(FORCE, unit, strict=True)) / sum(g * g for g in unit)
    assert found.values["modulus"] == pytest.approx(best, rel=1e-7)
    off = [best * g - m for m, g in zip(FORCE, unit, strict=True)]
    size = sum(m * m for m in FORCE) / 7
    assert found.cost == pytest.approx(0.5 * sum(r * r for r in off) / size, rel=1e-9)
    rms, explained = agreement(FORCE, np.add(FORCE, off))
    mean = sum(FORCE) / 7
    assert rms == pytest.approx(sqrt(sum(r * r for r in off) / 7), rel=1e-12)
    assert explained == pytest.approx(1.0 - sum(r * r for r in off) / sum((m - mean) ** 2 for m in FORCE), rel=1e-12)


@pytest.mark.parametrize("work", [0.05, 2.0])
@pytest.mark.parametrize("kind", ["dmt", "jkr"])
def test_a_modulus_under_adhesion_by_hand(kind: str, work: float) -> None:
    """Hertz's force less 2π w R (DMT), less √(8π w E* a³) (JKR): no E* of a fine grid is nearer to the forces."""
    unit = at_frames([law("disc", a, r) for a, r in zip(AREA, RADII, strict=True)])
    if kind == "dmt":
        pull = at_frames([2.0 * pi * work * r for r in RADII])
    else:
        pull = at_frames([sqrt(8.0 * pi * work * sqrt(a / pi) ** 3) for a in AREA])

    def squares(modulus: float) -> float:
        root = 1.0 if kind == "dmt" else sqrt(modulus)
        return sum((modulus * g - root * p - m) ** 2 for g, p, m in zip(unit, pull, FORCE, strict=True))

    found = fitted(model("disc", Adhesion(kind, work)), FORCE, [modulus_parameter()])
    best = found.values["modulus"]
    assert found.cost == pytest.approx(0.5 * squares(best) / (sum(m * m for m in FORCE) / 7), rel=1e-9)
    assert all(squares(best) <= squares(best * step) for step in (0.3, 0.9, 0.9999, 1.0001, 1.1, 4.0))
    assert all(squares(best) <= squares(each) for each in np.geomspace(1e3, 1e13, 400))


def test_a_profile_by_hand() -> None:
    """With E* alone the sum of squares is a parabola: at either end it is Σ g² half² above its least, half alike."""
    unit = at_frames([law("disc", a, r) for a, r in zip(AREA, RADII, strict=True)])
    found = identify(model("disc"), FORCE, replicates=0)
    profile = found.profiles["modulus"]
    assert profile.upper - found.modulus == pytest.approx(found.modulus - profile.lower, rel=1e-5)
    half, power = profile.upper - found.modulus, sum(g * g for g in unit)

    def squares(modulus: float) -> float:
        return sum((modulus * g - m) ** 2 for g, m in zip(unit, FORCE, strict=True))

    for value, rise in zip(profile.values, profile.rise, strict=True):
        assert rise == pytest.approx((squares(value) - squares(found.modulus)) / (half**2 * power), rel=1e-5, abs=1e-7)


def test_a_threshold_by_hand() -> None:
    """Root of the mean of (area / wanted - 1)², frames outside the table's forces left out; none on a grid has less."""
    thresholds = np.array([1.0, 2.0, 3.0]) * 1e-3
    areas = np.outer(AREA, [0.5, 0.8, 1.1]) * RNG.uniform(0.9, 1.1, (12, 3)).cumsum(axis=1) ** 0.2
    areas.sort(axis=1)
    evolution = ThresholdAreas(TIME, thresholds, areas, RADII, LENGTH)
    table_force, table_area = np.array([600.0, 300.0, 450.0]), 1e-6 * np.array([610.0, 400.0, 530.0])
    found = calibrated(evolution, FRAMES, FORCE, table_force, table_area)

    def rms(threshold: float) -> float:
        curve, total, count = list(evolution.within(threshold)), 0.0, 0
        for area, m in zip(at_frames(curve), FORCE, strict=True):
            if 300.0 <= m <= 600.0:
                low = 300.0 if m <= 450.0 else 450.0
                ends = (400.0, 530.0) if m <= 450.0 else (530.0, 610.0)
                wanted = 1e-6 * (ends[0] + (m - low) / 150.0 * (ends[1] - ends[0]))
                total, count = total + (area / wanted - 1.0) ** 2, count + 1
        assert count == found.frames
        return sqrt(total / count)

    assert found.rms == pytest.approx(rms(found.threshold), rel=1e-10)
    assert all(found.rms <= rms(each) + 1e-9 for each in np.linspace(1e-3, 3e-3, 201))


def test_a_threshold_beside_the_modulus_by_hand() -> None:
    """Two unknowns: no pair beside the one that was found has a smaller sum."""
    thresholds = np.array([2.0, 3.0, 4.0]) * 1e-3
    areas = AREA[:, None] + 1e-6 * np.outer(120.0 + 40.0 * np.cos(3.0 * TIME), [0.0, 1.0, 2.0])
    evolution = ThresholdAreas(TIME, thresholds, areas, RADII, LENGTH)
    whole = AreaForce(evolution, READING["disc"], FRAMES, 0.0, 3e-3)
    found = fitted(whole, FORCE, [modulus_parameter(), Parameter("threshold", "m", 3e-3, 2e-3, 4e-3)], 2)

    def squares(modulus: float, threshold: float) -> float:
        unit = at_frames([law("disc", a, r) for a, r in zip(evolution.within(threshold), RADII, strict=True)])
        return sum((modulus * g - m) ** 2 for g, m in zip(unit, FORCE, strict=True))

    best = found.values["modulus"], found.values["threshold"]
    assert found.cost == pytest.approx(0.5 * squares(*best) / (sum(m * m for m in FORCE) / 7), rel=1e-9)
    for threshold in np.linspace(2e-3, 4e-3, 41):
        for factor in (0.5, 0.8, 0.95, 1.0, 1.05, 1.2, 2.0):
            assert squares(best[0] * factor, threshold) >= squares(*best) * (1.0 - 1e-8)
