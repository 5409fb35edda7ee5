"""What an identification at an elbow tells of each number, as it is shown: of ratios where the scale is free."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from geocontact.analyses.misalignment.parameters import PER_SI, TYPED
from geocontact.axis_misalignment.law import LENGTHS, SCALED
from geocontact.identify.intervals.profile_likelihood import Profile

if TYPE_CHECKING:
    from geocontact.analyses.misalignment.identify.run import Fitted

TIMES_LINK = {"k": "N", "b": "N s"}
"""Units of the stiffness and the damping times the link's length."""


@dataclass(frozen=True, eq=False)
class Interval:
    """One number or ratio in the unit shown, with its 95 %.

    Parameters
    ----------
    key, words
        Name in files and in sentences: k, or k_times_l and "k l".
    unit, per
        Shown, empty for a ratio; how many of it one of the profile's is.
    profile
        Of the number, or with l held of that which the ratio is made of.
    drawn
        Ends by the bootstrap in the unit shown; None without.
    """

    key: str
    words: str
    unit: str
    per: float
    profile: Profile
    drawn: tuple[float, float] | None

    @property
    def value(self) -> float:
        """Best value."""
        return self.profile.best * self.per

    @property
    def parts(self) -> list[tuple[float, float]]:
        """As of the profile."""
        return [(low * self.per, high * self.per) for low, high in self.profile.parts]

    @property
    def lower(self) -> float:
        """Least value within."""
        return self.profile.lower * self.per

    @property
    def upper(self) -> float:
        """Largest value within."""
        return self.profile.upper * self.per

    @property
    def lower_open(self) -> bool:
        """Whether the recordings set no least value."""
        return self.profile.lower_open

    @property
    def upper_open(self) -> bool:
        """Whether the recordings set no largest value."""
        return self.profile.upper_open

    @property
    def ends(self) -> str:
        """Ends in words, of each part."""
        told = [f"{end:.4g}" for part in self.parts for end in part]
        if self.lower_open:
            told[0] = "open"
        if self.upper_open:
            told[-1] = "open"
        return " or ".join(f"{low} … {high}" for low, high in zip(told[::2], told[1::2], strict=True))

    @property
    def sign_open(self) -> bool:
        """Whether there are values of both signs within."""
        return self.lower < 0.0 < self.upper

    @property
    def shown(self) -> str:
        """Value, unit as far as there is one, and ends."""
        return f"{' '.join(filter(None, (f'{self.value:.4g}', self.unit)))} (95 % {self.ends})"


def intervals(found: Fitted) -> list[Interval]:
    """Of each free number; where nothing sets the scale, of k l, x/l, y/l, z/l in place of k and the lengths."""
    told = []
    for name, p in found.profiles.items():
        if found.estimate.problem.scale_free and name in SCALED:
            if name != "l":
                drawn = found.link_drawn.get(name)
                told.append(_ratio(name, found.link_held[name], found.estimate.named["l"], drawn))
            continue
        told.append(_number(name, p, found.drawn.get(name)))
    return told


def _ratio(name: str, p: Profile, link: float, drawn: tuple[float, float] | None) -> Interval:
    per = 1.0 / link if name in LENGTHS else link
    ends = None if drawn is None else (drawn[0] * per, drawn[1] * per)
    if name in LENGTHS:
        return Interval(f"{name}_over_l", f"{name}/l", "", per, p, ends)
    return Interval(f"{name}_times_l", f"{name} l", TIMES_LINK[name], per, p, ends)


def _number(name: str, p: Profile, drawn: tuple[float, float] | None) -> Interval:
    per = PER_SI[name]
    ends = None if drawn is None else (drawn[0] * per, drawn[1] * per)
    return Interval(name, name, TYPED[name], per, p, ends)
