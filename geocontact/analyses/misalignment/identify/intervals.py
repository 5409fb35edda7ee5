"""What an identification at an elbow tells of each number, as it is shown: of ratios where the scale is free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geocontact.analyses.misalignment.law_numbers import PER_SI, WRITTEN
from geocontact.axis_misalignment.bins import Binned
from geocontact.axis_misalignment.law import GROWING, LENGTHS, SCALED
from geocontact.axis_misalignment.least_squares import ElbowFit
from geocontact.axis_misalignment.uncertainty import covariance, profiled, wild_bootstrap, with_link_held
from geocontact.identify.intervals.profile_likelihood import Profile

TIMES_LINK = {"k": "N", "b": "N s"}
"""Units of the stiffness and the damping times the link's length."""
TAILS = (2.5, 97.5)


@dataclass(frozen=True, eq=False)
class ShownInterval:
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


def intervals(data: Binned, e: ElbowFit, replicates: int) -> tuple[ShownInterval, ...]:
    """Of each free number; where nothing sets the scale, of k l, x/l, y/l, z/l in place of k and the lengths.

    `replicates` of the bootstrap are drawn, none for 0.
    """
    spread = covariance(data, e)
    if not e.problem.scale_free:
        drawn = _drawn(data, e, replicates)
        return tuple(_number(name, profiled(e, spread, name), drawn.get(name)) for name in e.problem.names)
    held, link = with_link_held(e), e.named["l"]
    held_spread, drawn = covariance(data, held), _drawn(data, held, replicates)
    return tuple(
        _ratio(name, profiled(held, held_spread, name), link, drawn.get(name))
        if name in SCALED
        else _number(name, profiled(e, spread, name), None)
        for name in e.problem.names
        if name != "l"
    )


def _drawn(data: Binned, e: ElbowFit, replicates: int) -> dict[str, tuple[float, float]]:
    """Ends of the bootstrap's 95 % by free number; empty without one."""
    if not replicates:
        return {}
    low, high = np.percentile(wild_bootstrap(data, e, replicates), TAILS, axis=0)
    return {name: (float(low[k]), float(high[k])) for k, name in enumerate(e.problem.names)}


def _ratio(name: str, p: Profile, link: float, drawn: tuple[float, float] | None) -> ShownInterval:
    per = 1.0 / link if name in GROWING else link
    ends = None if drawn is None else (drawn[0] * per, drawn[1] * per)
    if name in GROWING:
        return ShownInterval(f"{name}_over_l", f"{name}/l", "" if name in LENGTHS else "1/N", per, p, ends)
    return ShownInterval(f"{name}_times_l", f"{name} l", TIMES_LINK[name], per, p, ends)


def _number(name: str, p: Profile, drawn: tuple[float, float] | None) -> ShownInterval:
    per = PER_SI[name]
    ends = None if drawn is None else (drawn[0] * per, drawn[1] * per)
    return ShownInterval(name, name, WRITTEN[name], per, p, ends)
