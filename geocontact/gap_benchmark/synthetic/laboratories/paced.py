"""Movements at another pace: the same way, run through otherwise."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

from geocontact.gap_benchmark.synthetic.course import InputCourse, Path
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene

Speed = Callable[[Float[np.ndarray, " t"]], Float[np.ndarray, " t"]]
"""Over time; 1 where the movement runs as it did at home."""
KNOTS = 1e-3
"""Time between two nodes of a pace that is no closed form [s]."""
MARGIN = 0.05
"""Time before a trial and after it, through which the movement runs on as it began and ended [s]."""


@dataclass(frozen=True)
class Pace:
    """Time within the home movement as a function of time, with two derivatives; and how long the trial is now [s]."""

    duration: float
    along: Callable[[Float[np.ndarray, " t"]], tuple[Float[np.ndarray, " t"], ...]]

    @classmethod
    def even(cls, duration: float, quicker: float) -> Pace:
        """So many times as quick throughout."""
        return cls(duration / quicker, lambda t: (quicker * t, np.full_like(t, quicker), np.zeros_like(t)))

    @classmethod
    def of(cls, duration: float, speed: Speed) -> Pace:
        """Of a speed over time, scaled so that the trial ends when it did."""
        knots = np.arange(-MARGIN, duration + MARGIN + KNOTS, KNOTS)
        inside = np.clip(knots, 0.0, duration)
        place = CubicSpline(knots, speed(inside)).antiderivative()
        begin, whole = float(place(0.0)), float(place(duration) - place(0.0))
        scale = duration / whole
        return cls(duration, lambda t: (scale * (place(t) - begin), scale * place(t, 1), scale * place(t, 2)))

    def of_path(self, path: Path) -> Path:
        """The movement run through at this pace."""

        def along(time: Float[np.ndarray, " t"]) -> InputCourse:
            at, speed, change = self.along(time)
            old = path(at)
            return replace(
                old,
                time=time,
                rate=old.rate * speed,
                acceleration=old.acceleration * speed**2 + old.rate * change,
                position=old.position,
                duration=self.duration,
            )

        return along


def paced(scene: SyntheticScene, pace: Callable[[Rng, float], Pace]) -> SyntheticScene:
    """The scene whose trials have a pace each, drawn for a duration [s]."""

    def after(draw: Callable[[Rng, int], Path]) -> Callable[[Rng, int], Path]:
        def drawn(rng: Rng, turn: int) -> Path:
            path = draw(rng, turn)
            return pace(rng, path(np.zeros(1)).duration).of_path(path)

        return drawn

    return replace(scene, path=after(scene.path), later=after(scene.later))
