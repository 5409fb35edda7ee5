"""The page as one HTML file that asks for nothing: script and styles are named by hash, all text is escaped."""

from __future__ import annotations

import base64
import hashlib
import json
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from geocontact.view.page.content import Curves, Page, Picture, Readout, Scene, Strip, Table, Words
from geocontact.view.page.payload import payload, shown

if TYPE_CHECKING:
    from jinja2 import Template

HERE = Path(__file__).resolve().parent
KINDS = {
    Scene: "scene",
    Curves: "curves",
    Strip: "strip",
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


def page_html(page: Page) -> str:
    """The page as text."""
    script, style = bundled("page.js"), bundled("style.css")
    packed = payload(page)
    sections = [(KINDS[type(section)], f"section-{k}", section) for k, section in enumerate(page.sections)]
    return _template().render(
        page=page,
        moves=len(page.time) > 1,
        scene=next((section for kind, _, section in sections if kind == "scene"), None),
        opacities=_opacities(packed.data),
        panels=[s for s in sections if s[0] in ("curves", "strip", "readout")],
        reading=[s for s in sections if s[0] in ("picture", "table", "words")],
        packed=packed,
        data=_json(packed.data),
        policy=policy(script, style),
        script=script,
        style=style,
    )


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
