"""What an identification at an elbow tells of each number, as it is shown: of ratios where the scale is free."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from geocontact.cli.elbow_numbers import PER_SI, TYPED
from geocontact.identify.profile_likelihood import Profile
from geocontact.systems.elbow_law import LENGTHS, SCALED

if TYPE_CHECKING:
    from geocontact.cli.elbow_fit_analysis import Fitted

TIMES_LINK = {"k": "N", "b": "N s"}
"""Units of the stiffness and the damping times the link's length."""


@dataclass(frozen=True)
class Interval:
    """One number or ratio in the unit shown, with its 95 %.

    Parameters
    ----------
    key, words
        Name in files and in sentences: k, or k_times_l and "k l".
    lower, upper, lower_open, upper_open
        As `Profile`.
    drawn
        Ends by the bootstrap; None without.
    """

    key: str
    words: str
    unit: str
    value: float
    lower: float
    upper: float
    lower_open: bool
    upper_open: bool
    drawn: tuple[float, float] | None

    @property
    def ends(self) -> str:
        """Both ends in words."""
        pairs = ((self.lower, self.lower_open), (self.upper, self.upper_open))
        return " … ".join("open" if is_open else f"{end:.4g}" for end, is_open in pairs)

    @property
    def sign_open(self) -> bool:
        """Whether the interval holds values of both signs."""
        return self.lower < 0.0 < self.upper


def intervals(found: Fitted) -> list[Interval]:
    """Of each free number; where nothing sets the scale, of k l, x/l, y/l, z/l in place of k and the lengths."""
    told = []
    for name, p in found.profiles.items():
        drawn = found.drawn.get(name)
        if found.estimate.problem.scale_free and name in SCALED:
            if name != "l":
                told.append(_ratio(name, found.link_held[name], found.estimate.named["l"]))
            continue
        told.append(_shown(name, name, TYPED[name], p, PER_SI[name], drawn))
    return told


def _ratio(name: str, p: Profile, link: float) -> Interval:
    if name in LENGTHS:
        return _shown(f"{name}_over_l", f"{name}/l", "-", p, 1.0 / link, None)
    return _shown(f"{name}_times_l", f"{name} l", TIMES_LINK[name], p, link, None)


def _shown(key: str, words: str, unit: str, p: Profile, per: float, drawn: tuple[float, float] | None) -> Interval:
    ends = None if drawn is None else (drawn[0] * per, drawn[1] * per)
    return Interval(key, words, unit, p.best * per, p.lower * per, p.upper * per, p.lower_open, p.upper_open, ends)
