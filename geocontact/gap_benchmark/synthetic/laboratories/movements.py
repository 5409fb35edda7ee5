"""Movements at another pace, and of other families: the way of the home movement, run through in another manner.

Sines and holds begin at rest. They last longer than at home, up to half a minute, so that they are not much quicker.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
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
        """Values of a speed over time, scaled so that the trial ends when it did."""
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


RATIO = (4.0, 8.0)
"""Ratio of a sweep's largest speed to its least."""
SIZES = (0.33, 0.11, 0.06)
"""Sizes of the three sines, as shares of the way: together they go as far as half of it to either side of its
middle."""
PASSES = (0.7, 1.3)
"""Periods of the slowest sine in a trial."""
BESIDE = ((1.5, 1.7), (2.3, 2.6))
"""Frequencies of the other two, in that of the slowest."""
MOVING = (0.5, 0.65)
"""Share of the time of a stage in which a movement with holds moves."""
LONGEST = 30.0
"""Time that a movement is drawn out to at most [s], so that there is room for samples."""


def sweep(rng: Rng, duration: float) -> Pace:
    """Ever quicker, or ever slower, by the same factor in the same time."""
    grown = float(np.log(rng.uniform(*RATIO)) * rng.choice([-1.0, 1.0]))
    return Pace.of(duration, lambda t: np.exp(grown * t / duration))


def sines(rng: Rng, duration: float) -> Pace:
    """There and back by three sines none of whose frequencies is a multiple of another."""
    lasting = _longer(duration, rng.uniform(1.3, 1.8))
    omega = 2.0 * np.pi * rng.uniform(*PASSES) / lasting * np.array([1.0, *(rng.uniform(*one) for one in BESIDE)])
    size = duration * np.array(SIZES)

    def along(t: Float[np.ndarray, " t"]) -> tuple[Float[np.ndarray, " t"], ...]:
        angle = np.outer(omega, t)
        return size @ (1.0 - np.cos(angle)), (size * omega) @ np.sin(angle), (size * omega**2) @ np.cos(angle)

    return Pace(lasting, along)


def holds(rng: Rng, duration: float) -> Pace:
    """From stage to stage by least jerk, holding still at each."""
    lasting, count = _longer(duration, rng.uniform(1.4, 2.0)), int(rng.integers(3, 7))
    cuts = np.arange(1, count) + rng.uniform(-0.15, 0.15, count - 1)
    places = np.concatenate([[0.0], cuts, [count]]) * duration / count
    begin, move = np.arange(count) * lasting / count, rng.uniform(*MOVING) * lasting / count

    def along(t: Float[np.ndarray, " t"]) -> tuple[Float[np.ndarray, " t"], ...]:
        u = np.clip((t[:, None] - begin) / move, 0.0, 1.0)
        size = np.diff(places)
        place = u**3 * (10.0 - 15.0 * u + 6.0 * u * u) @ size
        speed = 30.0 * u * u * (1.0 - u) ** 2 @ size / move
        return place, speed, 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) @ size / move**2

    return Pace(lasting, along)


def _longer(duration: float, times: float) -> float:
    return min(times * duration, max(duration, LONGEST))


FAMILIES: Mapping[str, Callable[[Rng, float], Pace]] = {"sweep": sweep, "sines": sines, "holds": holds}


def moving(scene: SyntheticScene, family: str) -> SyntheticScene:
    """The scene with movements of a family, a way and a pace of its own for each trial; as it is for none of them."""
    return paced(scene, FAMILIES[family]) if family in FAMILIES else scene
