"""Work at and above shoulder height: the arm is raised, a tool runs, the arm is lowered."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import InputCourse, Path
from geocontact.gap_benchmark.synthetic.motions import Rng
from geocontact.gap_benchmark.synthetic.systems.sit_to_stand.motions import reached


@dataclass(frozen=True)
class ShoulderStyle:
    """How one case moves: `kind`, angles hanging and raised [rad], mean rate [rad/s], duration [s], step [s].

    "raise" goes up once, "heights" stops on the way, "cycle" goes up and down again and again. `levels` of support are
    taken in turn.
    """

    kind: str
    hanging: float
    raised: float
    pace: float
    duration: float
    step: float
    levels: tuple[float, ...]


def shoulder_path(rng: Rng, style: ShoulderStyle, turn: int) -> Path:
    """Trial number `turn`."""
    low, high = style.hanging + rng.normal(0.0, 0.05), style.raised + rng.normal(0.0, 0.08)
    places = {"raise": [low, high, low], "heights": [low, 0.5 * (low + high), high, low]}.get(
        style.kind, [low, high, low, high, low, high, low]
    )
    pace = style.pace * float(np.exp(rng.normal(0.0, 0.08)))
    moves = np.abs(np.diff(places)) / pace
    wait = rng.uniform(0.6, 1.1)
    duration = style.duration * float(np.exp(rng.normal(0.0, 0.04)))
    rests = max((duration - moves.sum() - 2.0 * wait) / max(len(moves) - 1, 1), 0.15) * rng.uniform(
        0.8, 1.0, len(moves) - 1
    )
    begin = wait + np.concatenate([[0.0], np.cumsum(moves[:-1] + rests)])
    runs = events(rng, begin[:-1] + moves[:-1], begin[1:], float(begin[-1] + moves[-1]))
    lasting = float(begin[-1] + moves[-1]) + wait
    sway, omega = rng.uniform(0.002, 0.006), 2.0 * np.pi * rng.uniform(0.25, 0.5)
    phase = rng.uniform(0.0, 2.0 * np.pi)
    setting = {"level": style.levels[turn % len(style.levels)]}

    def along(time: Float[np.ndarray, " t"]) -> InputCourse:
        place, rate, acceleration = (np.zeros_like(time) for _ in range(3))
        place += low
        for at, move, size in zip(begin, moves, np.diff(places), strict=True):
            share = (time - at) / move
            u = np.clip(share, 0.0, 1.0)
            place += size * reached(share, 0.0, 1.0)
            rate += size / move * 30.0 * u * u * (1.0 - u) ** 2
            acceleration += size / move**2 * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u)
        # a body sways
        place += sway * (1.0 - np.cos(omega * time))
        rate += sway * omega * np.sin(omega * time)
        acceleration += sway * omega**2 * np.cos(omega * time)
        flag = np.any([(time >= a) & (time < b) for a, b in runs], axis=0).astype(float)
        nothing = np.zeros_like(time)
        rows = np.array([[place, flag], [rate, nothing], [acceleration, nothing]])
        return InputCourse(time, rows[0], rows[1], rows[2], lasting, phase, setting)

    return along


def events(
    rng: Rng, arrived: Float[np.ndarray, " m"], left: Float[np.ndarray, " m"], end: float
) -> tuple[tuple[float, float], ...]:
    """When the tool runs: while the arm is held long enough, else once at any time."""
    runs = []
    for begin, leave in zip(arrived, left, strict=True):
        if leave - begin > 1.0:
            start = begin + rng.uniform(0.1, 0.3) * (leave - begin)
            runs.append((start, start + rng.uniform(0.4, 0.65) * (leave - begin)))
    start = rng.uniform(0.2, 0.6) * end
    return tuple(runs) or ((start, start + 0.2 * end),)
