"""Other families of movements: the way of the home movement, run through in another manner.

Sines and holds begin at rest. They last longer than at home, up to half a minute, so that they are not much quicker.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.laboratories.paced import Pace, paced
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene

RATIO = (4.0, 8.0)
"""Of a sweep's largest speed to its least."""
SIZES = (0.33, 0.11, 0.06)
"""Of the three sines, as shares of the way: together they go as far as half of it to either side of its middle."""
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
