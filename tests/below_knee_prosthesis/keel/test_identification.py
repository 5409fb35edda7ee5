"""EI, series stiffness and fulcrums from compressions that were planted with Euler and Bernoulli by hand."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.keel.identification import (
    MeasuredCompression,
    compressed_curve,
    compressed_to,
    identified_keel,
)
from geocontact.below_knee_prosthesis.keel.sections import Sections
from geocontact.below_knee_prosthesis.keel.sole_identification import identified_sole
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot, vsf_keel

LENGTH, EI, SERIES, NOISE = 0.229, 17.0, 80e3, 2e-5
PLACES = (0.07, 0.1, 0.13)


def pinned_tip(fulcrum: float) -> float:
    """F a² L/(3 EI) for F = 1, a = L - l: a beam on two supports that hangs over (Roark, table 8.1)."""
    return (LENGTH - fulcrum) ** 2 * LENGTH / (3.0 * EI)


def curve(fulcrum: float, rng: np.random.Generator, soft: float | None = None, **more: bool) -> MeasuredCompression:
    """Up to 400 N, touched at 0.3 mm; deflections with white noise."""
    force = np.linspace(5.0, 400.0, 60)
    soft = pinned_tip(fulcrum) + 1.0 / SERIES if soft is None else soft
    deflection = 3e-4 + force * soft + NOISE * rng.standard_normal(len(force))
    return compressed_curve(f"at {fulcrum}", fulcrum, force, deflection, NOISE, **more)


def test_planted_numbers_are_inside_their_intervals() -> None:
    """Of 40 draws 95 % intervals hold the planted EI and series stiffness in 34 at least; the mean is right."""
    keel, inside, found = vsf_keel(), np.zeros(2), []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        one = identified_keel(keel, [curve(at, rng) for at in PLACES])
        found.append([each.value for each in one.numbers])
        inside += [each.lower < true < each.upper for each, true in zip(one.numbers, (EI, SERIES), strict=True)]
    assert np.mean(found, axis=0) == pytest.approx([EI, SERIES], rel=0.01)
    assert inside.min() >= 34
    width = np.log([one.numbers[0].upper / one.numbers[0].lower])
    spread = np.log(np.array(found)[:, 0]).std(ddof=1) * 2.0 * 1.96
    assert 0.6 * spread < width[0] < 1.7 * spread


def test_a_fulcrum_that_is_not_known_is_identified_with_the_keel() -> None:
    rng = np.random.default_rng(3)
    rows = [curve(0.07, rng), replace(curve(0.11, rng, sought=True), fulcrum=0.09), curve(0.145, rng)]
    found = identified_keel(vsf_keel(), rows)
    own = found.numbers[-1]
    assert own.lower < 0.11 < own.upper and own.upper - own.lower < 2e-3
    assert found.fulcrums[1] == own.value and found.fulcrum_sd[0] == 0.0 < found.fulcrum_sd[1]


def test_two_sections_are_identified_in_their_ratio() -> None:
    """EI halves at 150 mm: m²/EI integrated by hand, l < 150 mm."""
    edge = 0.15

    def soft(fulcrum: float) -> float:
        a, b = LENGTH - fulcrum, LENGTH - edge
        front = (a**3 - b**3) / (3.0 * EI) + b**3 / (3.0 * 0.5 * EI)
        return a**2 * fulcrum / (3.0 * EI) + front + 1.0 / SERIES

    keel = replace(vsf_keel(), sections=Sections((edge,), (1.0, 0.5)))
    rng = np.random.default_rng(1)
    found = identified_keel(keel, [curve(at, rng, soft(at)) for at in PLACES])
    ei, series = found.numbers
    assert ei.lower < EI < ei.upper and series.lower < SERIES < series.upper
    assert ei.upper / ei.lower < 1.05
    one = identified_keel(vsf_keel(), [curve(at, rng, soft(at)) for at in PLACES]).numbers[1]
    more = (LENGTH - edge) ** 3 / (3.0 * EI) + 1.0 / SERIES
    assert one.lower < 1.0 / more < one.upper  # in front of all fulcrums it acts as one more spring in series


def test_a_plate_in_front_of_the_tip_presses_a_shorter_beam() -> None:
    """The same curves with the plate 20 mm behind the tip are those of a stiffer... shorter beam: EI by hand."""
    at, rng = LENGTH - 0.02, np.random.default_rng(2)
    rows = [curve(place, rng, (at - place) ** 2 * at / (3.0 * EI) + 1.0 / SERIES) for place in PLACES]
    number = identified_keel(vsf_keel(), rows, at=at).numbers[0]
    assert number.lower < EI < number.upper


def test_stiffnesses_alone_give_the_numbers_of_the_study() -> None:
    """10 and 32 N/mm at the ends of the range: EI and 1/k by two equations; 19 N/mm its fulcrum. Rounded to 1 N/mm."""
    c = [(LENGTH - at) ** 2 * LENGTH / 3.0 for at in (0.066, 0.151)]
    bending = (c[0] - c[1]) / (1.0 / 10e3 - 1.0 / 32e3)
    series = 1.0 / (1.0 / 32e3 - c[1] / bending)
    to = partial(compressed_to, sd=1e3 / 12.0**0.5)
    rows = [to("low", 0.066, 10e3), to("medium", 0.1, 19e3, sought=True), to("high", 0.151, 32e3)]
    found = identified_keel(vsf_keel(), rows)
    assert [each.value for each in found.numbers] == pytest.approx([bending, series, 0.1174], rel=1e-3)
    assert found.freedom == 0
    change = np.array([bending_of(10e3 + 1.0, 32e3), bending_of(10e3, 32e3 + 1.0)]) - bending
    sd = 1e3 / 12.0**0.5 * np.hypot(*change) / bending
    assert np.log(found.numbers[0].upper / found.numbers[0].lower) == pytest.approx(2.0 * 1.96 * sd, rel=0.01)


def bending_of(low: float, high: float) -> float:
    """EI from two stiffnesses, by hand."""
    c = [(LENGTH - at) ** 2 * LENGTH / 3.0 for at in (0.066, 0.151)]
    return (c[0] - c[1]) / (1.0 / low - 1.0 / high)


def test_a_known_series_stiffness_needs_one_fulcrum_only() -> None:
    rng = np.random.default_rng(5)
    number = identified_keel(vsf_keel(), [curve(0.1, rng)], series=SERIES).numbers[0]
    assert number.lower < EI < number.upper
    with pytest.raises(ValueError, match="need compressions at 2 known places of the fulcrum, there are 1"):
        identified_keel(vsf_keel(), [curve(0.1, rng), curve(0.1, rng)])


def test_curves_that_bend_have_wider_intervals_than_their_noise_makes() -> None:
    """A foot that stiffens: the residual is the model's, not the noise's, and remembers along the curve."""
    rng = np.random.default_rng(6)
    straight = [curve(at, rng) for at in PLACES]
    bent = [replace(one, deflection=one.deflection - 8e-4 * (one.force / 400.0) ** 2) for one in straight]
    widths = [
        np.diff(np.log([n.lower, n.upper]))[0]
        for n in (identified_keel(vsf_keel(), s).numbers[0] for s in (straight, bent))
    ]
    assert widths[1] > 3.0 * widths[0]


def test_the_sole_has_the_numbers_of_the_shipped_foot() -> None:
    """From stiffnesses of the study: what `vsf_foot` fits, with intervals that hold it."""
    foot = vsf_foot()
    to = partial(compressed_to, sd=1e3 / 12.0**0.5)
    rows = [to("low", 0.066, 10e3), to("medium", 0.1, 19e3, sought=True), to("high", 0.151, 32e3)]
    beam = identified_keel(foot.keel, rows)
    sole = identified_sole(foot, beam, rows, tilt=np.radians(20.0), travel=5e-3)
    assert sole.zone == "forefoot"
    assert [each.value for each in sole.numbers] == pytest.approx([foot.keel.bending, foot.law.stiffness[-1]], rel=1e-3)
    assert sole.stiffnesses == pytest.approx([10e3, 19e3, 32e3], rel=0.01)
    assert 1.05 < sole.numbers[0].upper / sole.numbers[0].lower < 1.5
