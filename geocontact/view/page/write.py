"""The page as one HTML file that asks for nothing: script and styles are named by hash, all text is escaped."""

from __future__ import annotations

import base64
import hashlib
import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from geocontact.view.page.bounded import bounded
from geocontact.view.page.content import (
    Curves,
    Intervals,
    Page,
    PageChoice,
    Picture,
    Plan,
    Readout,
    Scene,
    Section,
    Strip,
    Table,
    Words,
)
from geocontact.view.page.payload import minus, payload, shown

if TYPE_CHECKING:
    from jinja2 import Template

HERE = Path(__file__).resolve().parent
KINDS = {
    Scene: "scene",
    Curves: "curves",
    Strip: "strip",
    Plan: "plan",
    Intervals: "intervals",
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


PANELS = ("curves", "strip", "plan", "intervals", "readout")


@dataclass(frozen=True)
class PlacedSection:
    """A section on the page, the choice it belongs to ("": any), and whether it shows the answer."""

    name: str
    kind: str
    section: Section
    choice: str
    lead: bool

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
        moves=page.plays and len(page.time) > 1,
        steps=len(page.time) > 1,
        readings=_readings(page),
        scene=next((each.section for each in placed if each.kind == "scene"), None),
        opacities=_opacities(packed.data),
        lead=[each for each in shown_here if each.lead and each.kind != "scene"],
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
