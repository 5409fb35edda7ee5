"""The bodies of a form in 3-D, what is within the threshold in colour, and a slider that moves the threshold."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from geocontact.analyses.frame.quantities import length
from geocontact.app.elements import element, text
from geocontact.app.faces import Found
from geocontact.app.fields import Field, Form
from geocontact.app.form_view import PAUSE, VALUE
from geocontact.app.picture import FormPicture, fill
from geocontact.app.within import REACH
from geocontact.data.plausible import THRESHOLD

STEPS = 400
"""Steps of the slider from 0 to `REACH`."""
DIGITS = 6
"""Digits of a threshold."""


def threshold_of(form: Form) -> Field | None:
    """The field of the threshold that two surfaces are held against; None where the analysis has no such picture."""
    if not form.entry.load_options().first_frame:
        return None
    return next((one for one in form.fields if one.one.range is THRESHOLD and one.units), None)


class ThresholdView(FormPicture):
    """The picture of the threshold, below its field.

    Parameters
    ----------
    form, one
        The form, and the field of the threshold.
    pages, serve
        Folder for the page of the bodies, and the address of a page that was written.
    """

    def __init__(self, form: Form, one: Field, pages: Path, serve: Callable[[Path], str]) -> None:
        super().__init__(f"show the {one.label} in 3-D")
        self._form, self._one, self._pages, self._serve = form, one, pages, serve
        self._on = False
        self._page = self._unit = ""

    async def show(self) -> None:
        """Show the bodies at the first frame, and from then on what the form says."""
        self._on, self._asked = True, None
        self._said.text = "…"
        await self.colour()

    def question(self) -> dict[str, Any] | None:
        """What `within` reads; None before the button was pressed."""
        if not self._on:
            return None
        asked = {"command": self._form.command, "filled": self._form.kept(), "folder": str(self._pages)}
        return asked | {"unit": self._form.unit(self._one)}

    def take(self, found: Found) -> None:
        """Colour what is within, say the areas, and move the slider to the threshold; a page where it is new.

        A threshold that cannot be leaves the slider, which may be on its way to another one.
        """
        self._said.text = "" if found.marked else found.said
        if found.marked is None and self._form.at(found.said) is not self._one:
            self.clear()
        if found.marked and (self._frame is None or found.page != self._page):
            self._open(found.page)
        if self._frame is None:
            return
        self._slider_in(self._form.unit(self._one))
        self._areas.text, self._about.text = found.said if found.marked else "", found.about
        self.mark(found.marked)
        if found.thresholds:
            self._move(found.thresholds[-1] / length("1", "", self._unit))

    def clear(self) -> None:
        """Take the picture away; what was asked stays, so that it is not asked again."""
        self._place.clear()
        self._frame = None

    def _open(self, page: str) -> None:
        """The page of the bodies, and places for the slider and for words below it."""
        self.clear()
        self._page, self._unit = page, ""
        with self._place:
            self.open_page(self._serve(Path(page)), f"{self._one.label} in 3-D")
            self._row = element("div", "in")
            self._areas = text("p", "", "help lines", role="status")
            self._about = text("p", "", "help")

    def _slider_in(self, unit: str) -> None:
        """The slider and its number in a unit."""
        if unit == self._unit:
            return
        self._unit = unit
        self._row.clear()
        most, words = REACH / length("1", "", unit), f"{self._one.label} [{unit}]"
        with self._row:
            self._slider = element("input", type="range", min=0, max=most, step=most / STEPS, aria_label=words)
            self._number = element("input", type="number", min=0, step="any", aria_label=f"{words}, as a number")
            text("span", unit)
        for each in (self._slider, self._number):
            each.props["aria-describedby"] = self._about.html_id
            each.on("input", self._drag, js_handler=VALUE, throttle=PAUSE)

    async def _drag(self, event: Any) -> None:
        """Fill in the threshold; of several the last one."""
        try:
            value = f"{float(event.args):.{DIGITS}g}"
        except ValueError:  # a number that is not whole yet
            return
        typed = str(self._form.value(self._one)).split(",")
        units = any(each.strip()[-1:].isalpha() for each in typed[:-1])
        filled = ",".join([*typed[:-1], f"{value}{self._unit}" if units else value])
        self._form.values[self._one.name] = filled
        fill(self._one.name, filled)
        await self.colour()

    def _move(self, value: float) -> None:
        """Slider and number to a value, but for the one that is being moved."""
        ids = [self._slider.html_id, self._number.html_id]
        self._place.client.run_javascript(f"move({json.dumps(ids)}, '{value:.{DIGITS}g}')")
