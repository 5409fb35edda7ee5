"""A strap that is finer than the one that is calibrated: pads along the thigh that stiffen on soft tissue.

Nothing of it is measured; all numbers are invented. Five pads lie over `LENGTH` of the thigh. Each presses with a share
of the stiffness that grows with the square of how far it is pressed in, so that the strap turns by its length and its
middle of pressure moves, which one spring at one point cannot. What lies along the thigh slips beyond a limit, and the
tissue damps four times as much. Chains, feet and the person's habit are those of the calibration.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from geocontact.dynamics.body_contact import together
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import (
    LEGS,
    SHIFT,
    STRAP_PARAMETERS,
    STRAP_PLANTED,
    Strap,
    with_exoskeleton,
)
from geocontact.standing_up.feet import EVERY_PLANTED
from geocontact.standing_up.synthetic_study import (
    ASSISTANCE,
    OTHER_SEATED,
    OTHER_SECONDS,
    RATE,
    SEATED,
    SECONDS,
    SyntheticStudy,
)
from geocontact.standing_up.trials import StandingNoise, StandingTrial, recorded, standing_up

PADS, LENGTH = 5, 0.10
STIFFENS = 0.010
"""Where a pad is twice as stiff [m]."""
SLIPS = 30.0
"""Largest force along the thigh, all pads [N]."""
DAMPING = 40.0
"""All pads [N s/m]."""
PLANTED = np.r_[EVERY_PLANTED, STRAP_PLANTED]


def padded_strap(tree: Any, p: Any) -> Strap:
    """`p` means what it does for the strap that is calibrated: stiffnesses of all pads, and the place of the middle."""
    from casadi import SX, cross, exp, mtimes, tanh, vertcat

    person, device = tree.bodies["thigh"], tree.bodies["exo_thigh"]
    normal, tangential, _ = (STRAP_PARAMETERS[k].usual * exp(p[k]) for k in range(3))
    loads, across, along, energy, normal_energy = [], SX(0), SX(0), SX(0), SX(0)
    for at in np.linspace(-0.5, 0.5, PADS) * LENGTH:
        own = mtimes(person.rotation, vertcat(0.0, p[3] + at, 0.0))
        other = mtimes(device.rotation, vertcat(0.0, p[3] + at - SHIFT, 0.0))
        gap = device.place + other - person.place - own
        speed = device.speed + cross(device.spin, other) - person.speed - cross(person.spin, own)
        off = mtimes(person.rotation.T, gap)
        rate = mtimes(person.rotation.T, speed - cross(person.spin, gap))
        pressed = (normal * off[0] * (1.0 + (off[0] / STIFFENS) ** 2) + DAMPING * rate[0]) / PADS
        sheared = SLIPS * tanh(tangential * off[1] / SLIPS) / PADS + DAMPING * rate[1] / PADS
        force = LEGS * mtimes(person.rotation, vertcat(pressed, sheared, 0.0))
        about = cross(device.place + other, force)
        loads.append({"thigh": (force, about), "exo_thigh": (-force, -about)})
        across, along = across + pressed, along + sheared
        energy = energy + 0.5 * LEGS * tangential * off[1] ** 2 / PADS
        stored = 0.5 * off[0] ** 2 + 0.25 * off[0] ** 4 / STIFFENS**2
        normal_energy = normal_energy + LEGS * normal * stored / PADS
    return Strap(together(*loads), across, along, energy, normal_energy)


@dataclass(frozen=True, eq=False)
class FinerStudy:
    """Passive trials, an assisted one that was not used, and that one as it was without noise."""

    trials: SyntheticStudy
    held_out: SyntheticStudy
    true: StandingTrial


def finer_study(seed: int, intervals: int = 100) -> FinerStudy:
    """Three passive trials and an assisted one. ArithmeticError where a motion is not found."""
    subject, noise = Subject(), StandingNoise()
    model = with_exoskeleton(subject, padded_strap)

    def made(
        name: str, seconds: float, seated: Any, assistance: float, own: int
    ) -> tuple[StandingTrial, StandingTrial]:
        _, found = standing_up(
            model,
            subject,
            seconds=seconds,
            seated=seated,
            planted=PLANTED,
            assistance=assistance,
            intervals=intervals,
        )
        if not found.solved:
            raise ArithmeticError(f"{name}: {found.ending}")
        none = StandingNoise(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        noisy, clean = (recorded(model, found.motions[0], PLANTED, RATE, of, own, name) for of in (noise, none))
        return noisy, clean

    kinds = zip(SECONDS, SEATED, strict=True)
    passive = [made(f"T{k + 1}", *kind, 0.0, 100 * seed + k)[0] for k, kind in enumerate(kinds)]
    noisy, clean = made("P1", OTHER_SECONDS, OTHER_SEATED, ASSISTANCE, 100 * seed + 50)
    trials, held_out = (SyntheticStudy(model, subject, noise, PLANTED, tuple(each)) for each in (passive, [noisy]))
    return FinerStudy(trials, held_out, clean)
