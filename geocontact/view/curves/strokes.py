"""One stroke for one name: which colour and dashes each line of several cards gets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import count

from geocontact.view.curves.declared import Curves

Line = tuple[str, int | None]
"""Name of a line, and the stroke that it was declared with; None: any."""


def assigned(cards: Sequence[Sequence[Line]]) -> list[list[int]]:
    """Strokes of the lines of each card: a name has the same one in every card, and no other line of a card has it.

    A declared stroke stays, and holds for the same name in other cards. All others are the lowest numbers that are
    free: first for names of several cards, in the order in which they appear, then for those of one card.

    >>> assigned([[("medial", None), ("total", None)], [("total", None), ("lateral", None)]])
    [[0, 1], [1, 0]]
    >>> assigned([[("model", None), ("plate", 4)], [("plate", None)]])
    [[0, 4], [4]]
    """
    known: dict[str, int] = {}
    for name, stroke in (line for card in cards for line in card):
        if stroke is not None:
            known.setdefault(name, stroke)
    names = [{name for name, _ in card} for card in cards]
    for name in dict.fromkeys(name for card in cards for name, _ in card):
        beside = [each for each in names if name in each]
        if name not in known and len(beside) > 1:
            known[name] = _free({known[other] for card in beside for other in card if other in known})
    return [_of_card(card, known) for card in cards]


def _of_card(card: Sequence[Line], known: dict[str, int]) -> list[int]:
    """Declared strokes, those of names of several cards, and what is free for the others."""
    found = [known.get(name) if stroke is None else stroke for name, stroke in card]
    taken = {stroke for stroke in found if stroke is not None}
    strokes = []
    for stroke in found:
        own = _free(taken) if stroke is None else stroke
        taken.add(own)
        strokes.append(own)
    return strokes


def _free(taken: set[int]) -> int:
    return next(k for k in count() if k not in taken)


def lines_of(panel: Curves) -> list[Line]:
    """Lines that the key of a panel names: curves, and points joined to a line."""
    joined = [(each.name, each.stroke) for each in panel.points if each.joined]
    return [*((curve.name, curve.stroke) for curve in panel.curves if not curve.thin), *joined]


def with_strokes(panel: Curves, strokes: Sequence[int]) -> Curves:
    """The panel with the strokes of `lines_of`; lines that the key does not name have that of their place."""
    left = iter(strokes)
    curves = [
        replace(c, stroke=(k if c.stroke is None else c.stroke) if c.thin else next(left))
        for k, c in enumerate(panel.curves)
    ]
    points = [replace(each, stroke=next(left)) if each.joined else each for each in panel.points]
    return replace(panel, curves=curves, points=points)
