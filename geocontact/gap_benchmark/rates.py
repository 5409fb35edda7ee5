"""Shares with exact intervals."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from scipy.stats import beta


@dataclass(frozen=True)
class Rate:
    """So many of so many; NaN where there are none."""

    hits: int
    count: int

    @classmethod
    def of(cls, answers: Iterable[bool]) -> Rate:
        """How many are true."""
        found = [bool(one) for one in answers]
        return cls(sum(found), len(found))

    @property
    def value(self) -> float:
        """Share in 0..1."""
        return self.hits / self.count if self.count else float("nan")

    def interval(self, level: float = 0.95) -> tuple[float, float]:
        """Exact interval of Clopper and Pearson (1934) Biometrika 26:404; conservative. (0, 1) where there are none."""
        if not self.count:
            return 0.0, 1.0
        tail = 0.5 * (1.0 - level)
        low = float(beta.ppf(tail, self.hits, self.count - self.hits + 1)) if self.hits else 0.0
        high = float(beta.isf(tail, self.hits + 1, self.count - self.hits)) if self.hits < self.count else 1.0
        return low, high

    def __str__(self) -> str:
        low, high = self.interval()
        return f"{self.hits}/{self.count} = {self.value:.1%} [{low:.1%}, {high:.1%}]" if self.count else "no case"
