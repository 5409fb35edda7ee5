"""A picture in 3-D below a field of a form, coloured by what the form says as it is filled in."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from typing import Any

from nicegui import run as aside
from nicegui import ui

from geocontact.app.elements import element, text
from geocontact.app.faces import Chooser, Found

chooser = Chooser()


def fill(name: str, value: str, add: bool = False) -> None:
    """Type a value into a field of the form, on a line of its own below what stands there where `add`."""
    typed = f"[e.value.trim(), {json.dumps(value)}].filter(Boolean).join('\\n')" if add else json.dumps(value)
    script = f"const e = document.querySelector('[name={json.dumps(name)}]'); e.value = {typed};"
    ui.run_javascript(f"{script} e.dispatchEvent(new Event('change', {{ bubbles: true }}));")


class FormPicture(ABC):
    """The button, what is said beside it, and the place of the picture.

    Parameters
    ----------
    label
        What the button shows, for screen readers.
    """

    def __init__(self, label: str) -> None:
        self._frame: Any = None
        self._asked: dict[str, Any] | None = None
        self._at_work = False
        button = text("button", "show in 3-D", type="button", aria_label=label)
        self._said = text("span", "", "why", role="status")
        self._place = element("div", "picture")
        button.on("click", self.show)

    @abstractmethod
    async def show(self) -> None:
        """Show it; called by the button."""

    @abstractmethod
    def question(self) -> dict[str, Any] | None:
        """What is asked of the process that knows surfaces; None where no picture is shown or nothing is coloured."""

    @abstractmethod
    def take(self, found: Found) -> None:
        """Show the answer."""

    async def colour(self) -> None:
        """Ask, and show the answer, until the form says nothing else than before; one question at a time.

        While one is answered a slider moves on: what it was moved over is not asked.
        """
        if self._at_work:
            return
        self._at_work = True
        try:
            while (asked := self.question()) is not None and asked != self._asked:
                self._asked = asked
                found = await aside.io_bound(chooser.ask, asked)
                if self._place.is_deleted or found is None:
                    return
                if asked == self._asked and self.question() is not None:
                    self.take(found)
        finally:
            self._at_work = False

    def clear(self) -> None:
        """Take the picture away."""
        self._place.clear()
        self._frame, self._asked = None, None

    def open_page(self, address: str, title: str, **attributes: Any) -> None:
        """Show a page in a frame at the end of the place, which a port leads to."""
        sandbox = "allow-scripts allow-downloads"
        self._frame = element("iframe", src=address, title=title, sandbox=sandbox, **attributes)
        self._frame.on("load", js_handler="(e) => attach(e.target)")

    def mark(self, marked: dict[str, Any] | None) -> None:
        """Colour faces, or vertices within a threshold; none of them for None."""
        self._frame.client.run_javascript(f"mark('{self._frame.html_id}', {json.dumps(marked)})")
