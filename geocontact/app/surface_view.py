"""A surface of a form in 3-D: faces that count and the medial side in colour, a box of faces, landmarks put to use."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from nicegui import run as aside

from geocontact.app.elements import choice, element, text
from geocontact.app.faces import Found
from geocontact.app.fields import Field, Form
from geocontact.app.files import page_name, write_page
from geocontact.app.form_view import PAUSE, VALUE
from geocontact.app.landmark_uses import ELSEWHERE, LINE, NAMED_REGION, POINT, REGION, TABLE, Use, region_of, uses_of
from geocontact.app.picture import FormPicture, fill
from geocontact.app.region_box import NAMES, STEPS, Box

RADIUS = "10mm"
"""Radius of a region about a landmark before another one is typed."""


class SurfaceView(FormPicture):
    """The picture of one surface, below its field.

    Parameters
    ----------
    form, one
        The form, and the field that names the file.
    units
        Fields for its unit, the one of its own first.
    path
        The file.
    pages, serve
        Folder for its page, and the address of a page that was written.
    upload
        Address that takes landmarks.
    """

    def __init__(
        self,
        form: Form,
        one: Field,
        units: list[Field],
        path: Path,
        pages: Path,
        serve: Callable[[Path], str],
        upload: str,
    ) -> None:
        super().__init__(f"show {path.name} in 3-D")
        self._form, self._one, self._units, self._path = form, one, units, path
        self._pages, self._serve, self._upload = pages, serve, upload
        self._region = region_of(form.command, one.name)
        self._in_unit = ""
        self._box: Box | None = None

    async def show(self) -> None:
        """Write the page of the surface and show it."""
        unit = self._unit()
        if not unit:
            self._said.text = f"choose the {self._units[-1].label} first"
            return
        out = self._pages / page_name(self._path, unit)
        self._said.text = "…"
        self._pages.mkdir(parents=True, exist_ok=True)
        self._said.text = str(await aside.io_bound(write_page, self._path, unit, out))
        self.clear()
        if self._said.text:
            return
        self._in_unit = unit
        with self._place:
            self.open_page(self._serve(out), f"{self._path.name} in 3-D", data_to=self._upload)
            self._frame.on("landmarks", self._offer, js_handler="(e) => emit(e.detail)")
            self._counted = text("p", "", "help", role="status")
            self._below = element("div")
            self._uses = element("div", "uses", aria_live="polite")
        await self.colour()

    def clear(self) -> None:
        """Take the picture away, with its box."""
        super().clear()
        self._box = None

    def take(self, found: Found) -> None:
        """Colour the faces that count, and say how many."""
        self._counted.text = found.said
        self.mark(found.marked)
        self._sliders(found)

    def _sliders(self, found: Found) -> None:
        """Sliders of a box about the surface, once its size is known."""
        if self._box is not None or found.box is None:
            return
        self._box = Box(tuple((low, high) for low, high in found.box))
        with self._below, element("details"):
            text("summary", f"choose faces by a box, for {self._region}")
            for k, name in enumerate(NAMES):
                with element("div", "in"):
                    text("span", f"{name}{f' [{self._unit()}]' if k < 3 else ''}")
                    for end, words in enumerate(("from", "to")):
                        label = f"{name} {words}, of {self._path.name}"
                        made = element(
                            "input", type="range", min=0, max=STEPS, defaultValue=end * STEPS, aria_label=label
                        )
                        made.on("input", partial(self._drag, k, end), js_handler=VALUE, throttle=PAUSE)

    def _drag(self, k: int, end: int, event: Any) -> None:
        if self._box is not None:
            self._box.drag(k, end, int(event.args))
            fill(self._region, self._box.expression)

    def _offer(self, event: Any) -> None:
        """Say where landmarks were saved, and what they may be used for."""
        path, names = str(event.args["path"]), [str(each) for each in event.args["landmarks"]]
        self._uses.clear()
        with self._uses:
            if not path:
                text("p", f"the landmarks were not saved: {event.args['wrong']}", "bad", role="alert")
                return
            text("p", f"{len(names)} landmark{'s' if len(names) > 1 else ''} in {path}", "help")
            for use in uses_of(self._form.command, self._one.name):
                with element("div", "links"):
                    self._use(use, path, names)

    def _use(self, use: Use, path: str, names: Sequence[str]) -> None:
        """Buttons for one field."""
        spelled = next(each.spelled for each in self._form.fields if each.name == use.field)
        part = f"{Path(path).stem}=" if use.kind == NAMED_REGION else ""
        add = use.kind == NAMED_REGION
        if use.kind == TABLE:
            self._button(f"{spelled}: this file", lambda: fill(use.field, path))
        if use.kind in (REGION, NAMED_REGION):
            if len(names) > 2:
                self._button(f"{spelled}: inside them", lambda: fill(use.field, f"{part}polygon:{path}", add))
            near = {"name": names[0], "radius": RADIUS}
            self._button(
                f"{spelled}: near",
                lambda: fill(use.field, f"{part}sphere:{path}:{near['name']}:{near['radius']}", add),
            )
            self._names(names, near, "name", f"landmark in the middle of {spelled}")
            radius = element("input", type="text", defaultValue=RADIUS, size=6, aria_label=f"radius of {spelled}")
            radius.on("change", lambda e: near.update(radius=str(e.args)), js_handler=VALUE)
        if use.kind == POINT:
            at = {"name": names[0]}
            self._button(f"{spelled}: at", lambda: fill(use.field, f"{path}:{at['name']}"))
            self._names(names, at, "name", f"landmark of {spelled}")
        if use.kind == LINE and len(names) > 1:
            ends = {"from": names[0], "to": names[1]}
            self._button(f"{spelled}: from", lambda: fill(use.field, f"{path}:{ends['from']}:{ends['to']}"))
            self._names(names, ends, "from", f"first landmark of {spelled}")
            text("span", "to")
            self._names(names, ends, "to", f"second landmark of {spelled}")

    def _button(self, words: str, act: Callable[[], None]) -> None:
        text("button", words, type="button").on("click", act)

    def _names(self, names: Sequence[str], chosen: dict[str, str], key: str, label: str) -> None:
        made = choice([(each, each) for each in names], chosen[key], aria_label=label)
        made.on("change", lambda e: chosen.update({key: str(e.args)}), js_handler=VALUE)

    def _unit(self) -> str:
        return next(filter(None, (str(self._form.value(one)) for one in self._units)), "")

    def question(self) -> dict[str, Any] | None:
        """What the form says of the faces, as `FaceQuestion` has it; None where none are coloured.

        A picture in another unit than the one that is filled in is taken away: its lengths are those of the old one.
        """
        if self._frame is not None and self._unit() != self._in_unit:
            self.clear()
            self._said.text = f"the picture was in {self._in_unit}: show it again"
        if self._frame is None or not self._region:
            return None
        own = self._one.name
        closed = self._value("assume_closed")
        asked: dict[str, Any] = {
            "surface": str(self._path),
            "unit": self._unit(),
            "option": f"`{self._region}`",
            "region": self._value(self._region),
            "placement": self._value(f"place_{own}") or self._value("place"),
            "merge_tolerance": self._value("merge_tolerance"),
            "assume_closed": closed in (own, "both"),
        }
        asked["elsewhere"] = ",".join(ELSEWHERE.get(self._form.command, ()))
        if own != "moving":  # the plane divides the other body
            asked |= {name: self._value(name) for name in ("split", "side", "medial")}
        return asked

    def _value(self, name: str) -> str:
        one = next((each for each in self._form.fields if each.name == name), None)
        if one is None or self._form.without_effect(one):
            return ""
        return str(self._form.value(one)).strip() + (
            self._form.unit(one) if one.units and self._form.value(one) else ""
        )
