"""Straps that are finer than those that are calibrated: pads along a segment that stiffen on soft tissue.

Nothing of it is measured; all numbers are invented. Five pads lie over `LENGTH` of the thigh, and of shank and pelvis
where these have a strap. Each presses with a share
of the stiffness that grows with the square of how far it is pressed in, so that the strap turns by its length and its
middle of pressure moves, which one spring at one point cannot. What lies along the thigh slips beyond a limit, and the
tissue damps four times as much. Chains, feet and the person's habit are those of the calibration.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from geocontact.dynamics.sphere_contact import together
from geocontact.standing_up.chain import EVERY_PLANTED, Subject
from geocontact.standing_up.exoskeleton import (
    DAMPING,
    STRAP_PLANTED,
    Strap,
    with_exoskeleton,
)
from geocontact.standing_up.strap_sites import STRAP_SITES, THIGH_STRAP, StrapSite
from geocontact.standing_up.trials import StandingNoise, StandingTrial, recorded, standing_up
from meshes.standing_study import (
    ASSISTANCE,
    OTHER_SEATED,
    OTHER_SECONDS,
    RATE,
    SEATED,
    SECONDS,
    SyntheticStudy,
)

PADS, LENGTH = 5, 0.10
STIFFENS = 0.010
"""Where a pad is twice as stiff [m]."""
SLIPS = 30.0
"""Largest force along the thigh, all pads [N]."""
PADS_DAMPING = 40.0
"""All pads [N s/m]."""
PLANTED = np.r_[EVERY_PLANTED, STRAP_PLANTED]


class Pad:
    """Place of a strap between both chains: how far the exoskeleton's is off, and how fast, seen by the person's.

    Parameters
    ----------
    height
        Over the person's hinge [m].
    """

    def __init__(self, tree: Any, height: Any, site: StrapSite = THIGH_STRAP) -> None:
        from casadi import cross, mtimes, vertcat

        self.site = site
        self.person, device = tree.bodies[site.person], tree.bodies[site.device]
        own = mtimes(self.person.rotation, vertcat(0.0, height, 0.0))
        other = mtimes(device.rotation, vertcat(0.0, height - (site.above), 0.0))
        gap = device.place + other - self.person.place - own
        speed = device.speed + cross(device.spin, other) - self.person.speed - cross(self.person.spin, own)
        self.at = device.place + other
        self.off = mtimes(self.person.rotation.T, gap)
        self.rate = mtimes(self.person.rotation.T, speed - cross(self.person.spin, gap))

    def loads(self, across: Any, along: Any) -> dict[str, tuple[Any, Any]]:
        """Of all straps of the site, where one's pad has these forces on the person [N]."""
        from casadi import cross, mtimes, vertcat

        force = self.site.count * mtimes(self.person.rotation, vertcat(across, along, 0.0))
        about = cross(self.at, force)
        return {self.site.person: (force, about), self.site.device: (-force, -about)}


@dataclass(frozen=True)
class PaddedStrap:
    """Numbers mean what they do for the strap that is calibrated: stiffnesses of all pads, and the place of the middle.

    Parameters
    ----------
    stiffens
        Where a pad is twice as stiff [m].
    slips
        Largest force along the thigh, all pads [N].
    damping
        Of all pads [N s/m].
    preload
        Normal force without displacement, all pads [N].
    tilt
        How far the mat is turned against the thigh, so that it sees a part of the force along it [rad].
    """

    stiffens: float = np.inf
    slips: float = np.inf
    damping: float = DAMPING
    preload: float = 0.0
    tilt: float = 0.0

    def __call__(self, tree: Any, p: Any) -> Strap:
        """As `StrapLaw` wants it."""
        return self.at_site(tree, p, THIGH_STRAP)

    def at_site(self, tree: Any, p: Any, site: StrapSite) -> Strap:
        """The same at any place of the body."""
        from casadi import SX, exp, tanh

        normal, tangential, _ = (site.parameters[k].usual * exp(p[k]) for k in range(3))
        loads, across, along, energy, normal_energy = [], SX(0), SX(0), SX(0), SX(0)
        for at in np.linspace(-0.5, 0.5, PADS) * LENGTH:
            pad = Pad(tree, p[3] + at, site)
            off, rate = pad.off, pad.rate
            stiffer = normal * off[0] * (1.0 + (off[0] / self.stiffens) ** 2)
            pressed = (stiffer + self.damping * rate[0] + self.preload) / PADS
            spring = tangential * off[1]
            held = spring if np.isinf(self.slips) else self.slips * tanh(spring / self.slips)
            sheared = (held + self.damping * rate[1]) / PADS
            loads.append(pad.loads(pressed, sheared))
            across, along = across + pressed, along + sheared
            energy = energy + 0.5 * site.count * tangential * off[1] ** 2 / PADS
            stored = 0.5 * off[0] ** 2 + 0.25 * off[0] ** 4 / self.stiffens**2
            normal_energy = normal_energy + site.count * normal * stored / PADS
        seen = across * np.cos(self.tilt) + along * np.sin(self.tilt)
        return Strap(together(*loads), seen, along, energy, normal_energy)


padded_strap = PaddedStrap(STIFFENS, SLIPS, PADS_DAMPING)
"""The one that is finer than what is calibrated."""


def padded_straps(tree: Any, p: Any) -> Strap:
    """The same at all sites, `p` the parameters of one after the other."""
    each = [padded_strap.at_site(tree, p[4 * k : 4 * k + 4, :], site) for k, site in enumerate(STRAP_SITES)]
    first, *others = each
    energy, normal_energy = first.energy, first.normal_energy
    for strap in others:
        energy, normal_energy = energy + strap.energy, normal_energy + strap.normal_energy
    elsewhere = {site.name: strap.normal for site, strap in zip(STRAP_SITES[1:], others, strict=True)}
    loads = together(*(strap.loads for strap in each))
    return Strap(loads, first.normal, first.shear, energy, normal_energy, elsewhere)


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
