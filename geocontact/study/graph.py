"""The steps of a study in words and as a drawing: what takes from what, what is there, what is missing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

from geocontact.analyses.frame.words import counted
from geocontact.study.plan import PLANNED, Evaluation
from geocontact.study.trial_run import DONE

if TYPE_CHECKING:
    from geocontact.study.store import Store
    from geocontact.view.page.content import Picture

ASKED = 200
"""Results of a step whose times are read, at most."""
WIDTH, HEIGHT, GAP_X, GAP_Y, EDGE = 190, 58, 60, 18, 10
"""Sizes of boxes, the room between them and around all, in pixels."""


@dataclass(frozen=True)
class StepState:
    """One step.

    Parameters
    ----------
    takes
        Steps that it takes from.
    there, missing, others
        Evaluations with results, those that are to be made, and those that cannot be or are not asked for.
    seconds
        Mean time of those whose results are there, else of earlier results of the step [s]; None without any.
    """

    name: str
    analysis: str
    takes: tuple[str, ...]
    there: int
    missing: int
    others: int
    seconds: float | None

    @property
    def words(self) -> str:
        """What is there and what is missing, with the time that it took before."""
        parts = [f"{self.there} of {counted(self.there + self.missing + self.others, 'evaluation')} there"]
        if self.missing:
            time = "" if self.seconds is None else f", about {in_words(self.missing * self.seconds)} of work"
            parts.append(f"{self.missing} to evaluate{time}")
        if self.others:
            parts.append(f"{self.others} left out of this run")
        called = "" if self.analysis == self.name else f" ({self.analysis})"
        after = f", after {', '.join(self.takes)}" if self.takes else ""
        return f"{self.name}{called}{after}: {'; '.join(parts)}"


def in_words(seconds: float) -> str:
    """ "40 s", "12 min", "5.5 h"."""
    if seconds < 100.0:
        return f"{seconds:.2g} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.3g} h"


def step_states(evaluations: Sequence[Evaluation], store: Store) -> list[StepState]:
    """Every step in the order of evaluation."""
    found = []
    for name in dict.fromkeys(one.run.step for one in evaluations):
        own = [one for one in evaluations if one.run.step == name]
        there = [one.address for one in own if one.state == DONE]
        missing = sum(one.state == PLANNED for one in own)
        takes = tuple(dict.fromkeys(each for one in own for each in one.run.takes))
        timed = there[:ASKED] or (store.of_step(name, ASKED) if missing else [])
        times = [time for each in timed if (time := store.seconds(each)) is not None]
        seconds = sum(times) / len(times) if times else None
        others = len(own) - len(there) - missing
        found.append(StepState(name, own[0].run.analysis, takes, len(there), missing, others, seconds))
    return found


def graph_picture(states: Sequence[StepState]) -> Picture:
    """The steps as boxes from left to right, with arrows to what takes from them."""
    from geocontact.view.page.content import Picture  # late: with numpy

    words = "An arrow leads from a step to what takes files from it. Numbers are evaluations that have results."
    return Picture("Steps of the study", words, drawn(states), wide=len(_columns(states)) > 3)


def _columns(states: Sequence[StepState]) -> list[list[str]]:
    """Names of steps: each one column behind the last of those that it takes from."""
    level: dict[str, int] = {}
    for one in states:
        level[one.name] = 1 + max((level[each] for each in one.takes), default=-1)
    return [[name for name, at in level.items() if at == k] for k in range(1 + max(level.values()))]


def drawn(states: Sequence[StepState]) -> bytes:
    """The drawing (SVG)."""
    columns = _columns(states)
    places = {
        name: (EDGE + k * (WIDTH + GAP_X), EDGE + j * (HEIGHT + GAP_Y))
        for k, column in enumerate(columns)
        for j, name in enumerate(column)
    }
    width = 2 * EDGE + len(columns) * (WIDTH + GAP_X) - GAP_X
    height = 2 * EDGE + max(map(len, columns)) * (HEIGHT + GAP_Y) - GAP_Y
    parts = [line for one in states for each in one.takes for line in _arrow(places, each, one.name)]
    parts += [line for one in states for line in _box(one, *places[one.name])]
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">'
    return "\n".join((head, *parts, "</svg>")).encode()


def _arrow(places: Mapping[str, tuple[int, int]], one: str, other: str) -> list[str]:
    (x0, y0), (x1, y1) = places[one], places[other]
    start, end, mid = (x0 + WIDTH, y0 + HEIGHT // 2), (x1, y1 + HEIGHT // 2), (x0 + WIDTH + x1) // 2
    path = f"M {start[0]} {start[1]} C {mid} {start[1]} {mid} {end[1]} {end[0] - 6} {end[1]}"
    tip = f"M {end[0] - 7} {end[1] - 4} L {end[0]} {end[1]} L {end[0] - 7} {end[1] + 4} Z"
    return [f'<path d="{path}" style="fill: none; stroke: #7a8794"/>', f'<path d="{tip}" style="fill: #7a8794"/>']


def _box(one: StepState, x: int, y: int) -> list[str]:
    letters = 'font-family="sans-serif" text-anchor="middle"'
    count = f"{one.there} of {one.there + one.missing + one.others}"
    centre = x + WIDTH // 2
    return [
        f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" rx="6" style="fill: #ffffff; stroke: #7a8794"/>',
        f'<text x="{centre}" y="{y + 24}" {letters} font-size="14" font-weight="bold">{escape(one.name)}</text>',
        f'<text x="{centre}" y="{y + 44}" {letters} font-size="12">{count}, {escape(one.analysis)}</text>',
    ]
