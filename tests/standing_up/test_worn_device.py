"""An exoskeleton by its own motion: sums that the motors see are kept whatever its parts weigh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import part_lengths, two_chains
from geocontact.standing_up.exoskeleton_torque import parameter_names
from geocontact.standing_up.worn_device import PARTS, DeviceMasses, WornDevice, identified_device

SUBJECT = Subject(66.0, 1.68)
TRUE = ((3.2, 0.02, 0.21, 0.06), (3.8, -0.01, 0.2, 0.05), (5.1, -0.04, 0.13, 0.04))
"""Mass, mass centre ahead of the hinge and above it, and inertia about the mass centre of each part; invented."""
TAKEN = (0.0, 2.2, 3.0)
"""Masses of an answer of least squares: that of the shank does not act on the motors."""


def as_identified() -> dict[str, float]:
    """Another answer with the same torques: masses at a part's end are first moment and inertia of the part."""
    lengths, rows = part_lengths(SUBJECT), []
    for k, (mass, ahead, above, inertia) in enumerate(TRUE):
        more = sum(of[0] for of in TRUE[k + 1 :]) - sum(TAKEN[k + 1 :])
        first, about = mass * above + lengths[k] * more, inertia + mass * (ahead**2 + above**2) + lengths[k] ** 2 * more
        rows += [TAKEN[k], mass * ahead, first, about]
    return dict(zip(parameter_names(), [*rows, 1.1, 0.4, 1.2, 0.5, 1.3, 0.6], strict=True))


VALUES = as_identified()


def motors(parts: list[tuple[float, complex, float]], lengths: np.ndarray, q: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Torques at rest that three bodies on a fixed plate need, by moments of their weights and accelerations.

    Parameters
    ----------
    parts
        Mass, first moment along and, times -i, across (ahead), inertia about the hinge.
    q, a
        Angles and accelerations of the hinges, at no speed.
    """
    lean, spin = np.cumsum(q), np.cumsum(a)
    hinge = np.r_[0.0, np.cumsum(lengths * 1j * np.exp(1j * lean))][:3]
    fast = np.r_[0.0, np.cumsum(1j * spin * lengths * 1j * np.exp(1j * lean))][:3]
    torque = np.zeros(3)
    for k in range(3):
        for j, (mass, first, inertia) in enumerate(parts):
            if j >= k:
                arm = first * np.exp(1j * lean[j])
                pull = mass * (fast[j] + 9.81j) + 1j * spin[j] * arm
                torque[k] += (np.conj(hinge[j] - hinge[k]) * pull).imag
                torque[k] += (np.conj(arm) * (fast[j] + 9.81j)).imag + inertia * spin[j]
    return torque


def told(of: dict[str, float]) -> list[tuple[float, complex, float]]:
    return [
        (of[f"{n} mass"], of[f"{n} first moment along x"] + 1j * of[f"{n} first moment along y"], of[f"{n} inertia"])
        for n in PARTS
    ]


@pytest.mark.parametrize("masses", [DeviceMasses(), DeviceMasses(1.0, 3.4, 3.7, 5.2)])
def test_motors_need_the_same_whatever_the_parts_weigh(masses: DeviceMasses) -> None:
    lengths, rng = part_lengths(SUBJECT), np.random.default_rng(2)
    device = identified_device(VALUES, lengths, masses)
    bodies = [
        (p.mass, p.mass * complex(p.across, p.along), p.inertia + p.mass * (p.across**2 + p.along**2))
        for p in device.parts
    ]
    whole = [(m, m * complex(ahead, up), i + m * (ahead**2 + up**2)) for m, ahead, up, i in TRUE]
    for _ in range(4):
        q, a = rng.normal(size=3), 5.0 * rng.normal(size=3)
        wanted = motors(whole, np.array(lengths), q, a)
        np.testing.assert_allclose(motors(told(VALUES), np.array(lengths), q, a), wanted, rtol=1e-10, atol=1e-10)
        np.testing.assert_allclose(motors(bodies, np.array(lengths), q, a), wanted, rtol=1e-10, atol=1e-10)
    chain = {body.name: body for body in two_chains(replace(SUBJECT, device=device)).bodies}
    assert [chain[name].mass for name in PARTS] == list(masses.parts)
    for name, part in zip(PARTS, device.parts, strict=True):
        np.testing.assert_allclose(chain[name].centre, [part.across, part.along, 0.0])
        assert chain[name].inertia[2, 2] == part.inertia


def test_friction_is_against_the_rate_and_the_shipped_device_has_none() -> None:
    device = identified_device(VALUES, part_lengths(SUBJECT), DeviceMasses())
    rate = np.array([[0.7, -0.4, 1e-4]])
    wanted = [1.1 * 0.7 + 0.4, -1.2 * 0.4 - 0.5, 1.3e-4 + 0.6 * np.tanh(1e-4 / np.radians(1.0))]
    np.testing.assert_allclose(device.friction(rate)[0], wanted, rtol=1e-9)
    assert not WornDevice().friction(rate).any() and not WornDevice().identified and device.identified


def test_a_part_without_inertia_gets_the_least_and_no_other_changes() -> None:
    """0.1 kg m² less at the shank: raised to a radius of gyration of a tenth of its length."""
    lengths, masses = part_lengths(SUBJECT), DeviceMasses(2.0, 3.2, 3.8, 5.1)
    less = VALUES | {"exo_shank inertia": VALUES["exo_shank inertia"] - 0.1}
    one, other = (identified_device(values, lengths, masses) for values in (VALUES, less))
    least = 3.2 * (0.1 * lengths[0]) ** 2
    assert other.parts[0].inertia == pytest.approx(least) and one.raised == (0.0, 0.0, 0.0)
    assert other.raised[0] == pytest.approx(least - (0.06 - 0.1)) and other.parts[1:] == one.parts[1:]


def test_masses_that_leave_no_inertia_are_refused() -> None:
    with pytest.raises(ValueError, match="has no inertia left about its mass centre"):
        identified_device(VALUES, part_lengths(SUBJECT), DeviceMasses(module=9.0))
