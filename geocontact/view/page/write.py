"""The page as one HTML file that asks for nothing: script and styles are named by hash, all text is escaped."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Int

from geocontact.view.extremes import FRAMES, with_extremes
from geocontact.view.page.content import (
    Choices,
    Curves,
    Intervals,
    Matrix,
    Page,
    PageChoice,
    Picture,
    Plan,
    Readout,
    Scene,
    Section,
    Strip,
    Strips,
    Table,
    Words,
)
from geocontact.view.page.payload import minus, payload, shown

if TYPE_CHECKING:
    from jinja2 import Template


CROWD = 8
"""Curves of a card; with more it takes the whole width."""
ROWS = 12
"""Rows of intervals likewise."""
SPARE = 1.2
"""Times `FRAMES` that a page may have before it is thinned out: those that were thinned out have a few added."""


def bounded(page: Page) -> Page:
    """The page itself, or one with about `FRAMES` of its frames: those with the extremes of its curves.

    The first panel counts first. Marks at times of their own are thinned out likewise.
    """
    others = () if page.choices is None else page.choices.others
    every = [*page.sections, *(section for other in others for section in other.instead.values())]
    count = len(page.time)
    dense = any(_dense(each) for each in every if isinstance(each, Curves))
    if count <= SPARE * FRAMES and not dense:
        return page
    along = [section for section in page.sections if isinstance(section, Curves) and section.over is None]
    curves = [curve.values for section in along for curve in section.curves]
    kept = np.arange(count) if count <= SPARE * FRAMES else with_extremes(count, curves, always=(page.opening,))

    def fewer(section: Section) -> Section:
        return _fewer(section, kept)

    choices = page.choices
    if choices is not None:
        instead = [replace(o, instead={k: fewer(section) for k, section in o.instead.items()}) for o in choices.others]
        choices = Choices(choices.label, choices.own, instead)
    numbers = np.arange(1, count + 1) if page.numbers is None else page.numbers
    said = [] if len(kept) == count else [f"the page shows {len(kept)} of {count} samples; the tables have all"]
    return replace(
        page,
        time=page.time[kept],
        reservations=(*page.reservations, *said),
        start_frame=int(np.searchsorted(kept, page.opening)),
        sections=tuple(fewer(section) for section in page.sections),
        numbers=numbers[kept],
        total=count if page.total is None else page.total,
        choices=choices,
    )


def _follows(section: Section) -> bool:
    """Something in it changes along the page's own time."""
    return isinstance(section, Scene | Plan | Readout | Strip) or (isinstance(section, Curves) and section.over is None)


def _fewer(section: Section, kept: Int[np.ndarray, " k"]) -> Section:
    """A section at some of its frames; one that does not change over time as it is."""
    match section:
        case Curves():
            return section.at(kept).bounded() if _dense(section) else section.at(kept)
        case Strip(values=values):
            return replace(section, values=values[kept])
        case Plan(tracks=tracks):
            told = [[track.told[k] for k in kept] if track.told else () for track in tracks]
            return replace(
                section,
                tracks=[replace(t, points=t.points[kept], told=said) for t, said in zip(tracks, told, strict=True)],
            )
        case Readout(rows=rows):
            return replace(section, rows=[replace(row, texts=[row.texts[k] for k in kept]) for row in rows])
        case Scene():
            return _scene(section, kept)
    return section


def _dense(panel: Curves) -> bool:
    """Whether marks, or curves along an axis of their own, have more samples than a page shows."""
    own = [len(points.time) for points in panel.points] + [0 if panel.over is None else len(panel.over.values)]
    return max(own) > SPARE * FRAMES


def _scene(scene: Scene, kept: Int[np.ndarray, " k"]) -> Scene:
    bodies = [
        replace(
            body,
            poses=None if body.poses is None else body.poses[kept],
            distance=None if body.distance is None else body.distance[kept],
        )
        for body in scene.bodies
    ]
    linkages = [replace(one, points=one.points[kept] if len(one.points) > 1 else one.points) for one in scene.linkages]
    return replace(
        scene, bodies=bodies, maps=[replace(m, values=m.values[kept]) for m in scene.maps], linkages=linkages
    )


HERE = Path(__file__).resolve().parent
KINDS = {
    Scene: "scene",
    Curves: "curves",
    Strip: "strip",
    Plan: "plan",
    Intervals: "intervals",
    Strips: "strips",
    Matrix: "matrix",
    Readout: "readout",
    Picture: "picture",
    Table: "table",
    Words: "words",
}


def write_page(page: Page, path: Path) -> int:
    """Write the page; the same content gives the same bytes.

    Returns
    -------
    int
        Size of the file [bytes].
    """
    data = page_html(page).encode("utf-8", errors="replace")  # file names may hold what is no character
    path.write_bytes(data)
    return len(data)


PANELS = ("curves", "strip", "plan", "intervals", "strips", "matrix", "readout")


@dataclass(frozen=True)
class PlacedSection:
    """A section on the page, the choice it belongs to ("": any), and whether it shows the answer."""

    name: str
    kind: str
    section: Section
    choice: str
    lead: bool

    @property
    def crowded(self) -> bool:
        """It holds more curves or rows than a narrow card has room for."""
        match self.section:
            case Curves(curves=curves):
                return len(curves) > CROWD
            case Intervals(intervals=rows):
                return len(rows) > ROWS
        return False

    @property
    def empty(self) -> bool:
        """Nothing would be seen: numbers of a frame that no frame has."""
        return isinstance(self.section, Readout) and not self.section.rows


def page_html(page: Page) -> str:
    """The page as text."""
    page = bounded(page)
    script, style = bundled("page.js"), bundled("style.css")
    packed = payload(page)
    placed = [
        PlacedSection(name, KINDS[type(section)], section, "" if choice is None else str(choice), k in page.leads)
        for name, k, choice, section in page.placed()
    ]
    shown_here = [each for each in placed if not each.empty]
    return _template().render(
        page=page,
        moves=page.plays and len(page.time) > 1 and any(map(_follows, page.sections)),
        steps=len(page.time) > 1,
        readings=_readings(page),
        scene=next((each.section for each in placed if each.kind == "scene"), None),
        opacities=_opacities(packed.data),
        lead=[each for each in shown_here if each.lead and each.kind != "scene"],
        pictured=any(each.lead and isinstance(each.section, Picture) and not each.section.wide for each in shown_here),
        panels=[each for each in shown_here if each.kind in PANELS and not each.lead],
        reading=[each for each in shown_here if each.kind in ("picture", "table", "words") and not each.lead],
        packed=packed,
        data=_json(packed.data),
        policy=policy(script, style),
        script=script,
        style=style,
    )


def _readings(page: Page) -> list[PageChoice]:
    """What the head of the page says in each choice, its own first."""
    if page.choices is None:
        return [PageChoice("", page.headline, page.facts, {})]
    return [PageChoice(page.choices.own, page.headline, page.facts, {}), *page.choices.others]


def policy(script: str, style: str) -> str:
    """Content security policy: nothing but this script, this style sheet and pictures the page makes itself."""
    return (
        f"default-src 'none'; script-src '{_sha256(script)}'; style-src '{_sha256(style)}'; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )


@cache
def bundled(name: str) -> str:
    """A built file of the front end."""
    return (HERE / "bundle" / name).read_text(encoding="utf-8")


@cache
def _template() -> Template:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(HERE / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["shown"] = shown
    environment.filters["minus"] = minus
    environment.filters["quoted"] = lambda text: re.sub(r"`([^`]+)`", r"“\1”", text)
    return environment.get_template("page.html")


def _sha256(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")


def _json(data: dict[str, object]) -> str:
    """JSON that can stand in a script element: nothing in it can end or open one."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _opacities(data: dict[str, object]) -> list[float]:
    scene = data.get("scene")
    return [body["opacity"] for body in scene["bodies"]] if isinstance(scene, dict) else []
