"""Standing up and sitting down: how straps at each site move against the body, at different paces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import Path, through
from geocontact.gap_benchmark.synthetic.motions import KNOTS, Rng

MARGIN = 0.2
"""Time before a trial and after it through which its path runs on [s]."""


@dataclass(frozen=True)
class SiteStyle:
    """How one strap moves: normal displacement seated, its growth, ripple and lean; tangential and rotation.

    Lengths in m, `turn` in rad; the others are phases of a cycle of standing up and sitting down [rad].
    """

    seated: float
    growth: float
    ripple: float
    lean: float
    slide: float
    slide_phase: float
    turn: float
    turn_phase: float


@dataclass(frozen=True)
class SitToStandStyle:
    """How one case moves: `kind`, duration [s], step [s], and each site."""

    kind: str
    duration: float
    step: float
    sites: tuple[SiteStyle, ...]


def sit_to_stand_path(rng: Rng, style: SitToStandStyle) -> Path:
    """One trial."""
    duration = style.duration * float(np.exp(rng.normal(0.0, 0.08)))
    time = np.arange(-MARGIN, duration + MARGIN + KNOTS, KNOTS)
    cycle = 2.0 * np.pi * progress(style.kind, time / duration, rng.uniform(-0.04, 0.04))
    turn = float(np.exp(rng.normal(0.0, 0.07)))
    rows = [row for site in style.sites for row in of_site(rng, site, cycle, turn)]
    return through(time, np.array(rows), duration, rng.uniform(0.0, 2.0 * np.pi))


def of_site(
    rng: Rng, site: SiteStyle, cycle: Float[np.ndarray, " t"], turn: float
) -> tuple[Float[np.ndarray, " t"], ...]:
    """Normal, tangential and rotation along a cycle."""
    growth = site.growth * float(np.exp(rng.normal(0.0, 0.03)))
    risen = 0.5 - 0.5 * np.cos(cycle + 0.35 * np.sin(cycle) * site.lean)
    normal = site.seated + growth * risen + site.ripple * (1.0 - np.cos(2.0 * cycle)) * np.sin(cycle + site.lean)
    tangential = site.slide * np.sin(0.5 * cycle + site.slide_phase)
    rotation = site.turn * turn * np.sin(cycle + site.turn_phase)
    return normal, tangential, rotation


def progress(kind: str, share: Float[np.ndarray, " t"], uneven: float) -> Float[np.ndarray, " t"]:
    """Cycles of standing up and sitting down since the beginning, 0.5 is upright.

    "cycle" goes through at about one pace, "hold" rests upright, "rise" only stands up, "twice" does it two times.
    """
    warped = share + uneven * np.sin(2.0 * np.pi * share)
    if kind == "hold":
        return np.asarray(0.5 * reached(share, 0.06, 0.4 + uneven) + 0.5 * reached(share, 0.6 + uneven, 0.94))
    if kind == "rise":
        return np.asarray(0.5 * reached(share, 0.12, 0.75 + uneven))
    return 2.0 * warped if kind == "twice" else warped


def reached(share: Float[np.ndarray, " t"], begin: float, end: float) -> Float[np.ndarray, " t"]:
    """0 before, 1 after, and least jerk between."""
    u = np.clip((share - begin) / (end - begin), 0.0, 1.0)
    return np.asarray(u**3 * (10.0 - 15.0 * u + 6.0 * u * u))
