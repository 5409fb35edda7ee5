"""One name has one stroke in all cards of a page, and in the figure of the same curves."""

from __future__ import annotations

import json
import re

import numpy as np

from geocontact.data.motion import Course
from geocontact.view.curves.declared import INK, Curve, Curves, Points
from geocontact.view.curves.strokes import assigned, lines_of, with_strokes
from geocontact.view.page.content import IntervalRow, Intervals, Page, Plan, Section, Track
from geocontact.view.page.write import page_html

X = np.arange(3.0)


def drawn(*sections: Section) -> dict[str, set[int]]:
    """Strokes of each name as the page's script gets them."""
    html = page_html(Page("a", "", X, "time [s]", sections=sections))
    found = re.search(r'id="page-data">(.*?)</script>', html, re.DOTALL)
    assert found
    by_name: dict[str, set[int]] = {}
    for part in json.loads(found[1])["parts"]:
        for line in [
            *part.get("curves", ()),
            *(p for p in part.get("points", ()) if p["joined"]),
            *part.get("tracks", ()),
        ]:
            by_name.setdefault(line["name"], set()).add(line["stroke"])
        for kind, hue in part.get("hues", {}).items():
            by_name.setdefault(kind, set()).add(hue)
    return by_name


def panel(*names: str, **strokes: int) -> Curves:
    return Curves(" ".join(names), "N", [Curve(name, X, stroke=strokes.get(name)) for name in names])


def test_a_name_has_one_stroke_on_a_page() -> None:
    plan = Plan(
        "plan", "mm", "x", "y", [], [Track("chosen", np.zeros((3, 2))), Track("alone", np.zeros((3, 2)))], [], []
    )
    bars = Intervals(
        "bars", "N", [IntervalRow("a", 1.0, kind="chosen"), IntervalRow("b", 1.0, kind="other")], bars=True
    )
    found = drawn(panel("without", "alone", "chosen"), panel("chosen", "without"), plan, bars)
    assert all(len(strokes) == 1 for strokes in found.values()), found
    assert len({found[name].copy().pop() for name in ("without", "alone", "chosen")}) == 3
    assert "other" not in found, "kinds of bars alone have the colours of bars"


def test_lines_of_one_card_differ() -> None:
    for cards in ([["a", "b"], ["b", "c"], ["c", "a"]], [["x"], ["y"], ["z", "x", "y"]]):
        strokes = assigned([[(name, None) for name in card] for card in cards])
        assert all(len(set(own)) == len(own) for own in strokes)


def test_cards_of_their_own_begin_with_the_first_stroke() -> None:
    assert assigned([[("force", None)], [("area", None)]]) == [[0], [0]]


def test_a_declared_stroke_holds_for_its_name_everywhere() -> None:
    found = drawn(panel("model", "plate", plate=INK), panel("plate", "model", "third"))
    assert found["plate"] == {INK} and len(found["model"]) == 1 and found["third"] != found["model"]


def test_points_joined_to_a_line_count_as_curves() -> None:
    shown = Curves("a", "N", [Curve("one", X)], points=[Points("two", X, X, joined=True)], over=Course("x", "", X))
    one = with_strokes(shown, *assigned([lines_of(shown)]))
    assert (one.curves[0].stroke, one.points[0].stroke) == (0, 1)
