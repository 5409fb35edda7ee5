"""What the files of a form hold, beside their fields: facts, warnings, units that are offered, pictures in 3-D."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from nicegui import run as aside
from nicegui.element import Element

from geocontact.analyses.frame.file_content import MODEL, SURFACE, Content, markers_in_common
from geocontact.app.elements import element, text
from geocontact.app.fields import Field
from geocontact.app.files import Known, contents, known_file
from geocontact.app.form_view import FieldRow, FormView
from geocontact.app.picture import FormPicture, fill
from geocontact.app.surface_view import SurfaceView
from geocontact.app.threshold_view import ThresholdView, threshold_of


class FileView:
    """Contents of the files that were filled in.

    Parameters
    ----------
    view
        The form.
    folder
        Where paths start from.
    pages
        Folder for pages of surfaces.
    serve
        Address of a page that was written.
    upload
        Address that takes landmarks.
    """

    def __init__(self, view: FormView, folder: Path, pages: Path, serve: Callable[[Path], str], upload: str) -> None:
        self.form, self._folder, self._pages, self._serve, self._upload = view.form, folder, pages, serve, upload
        self._pictures: dict[str, list[FormPicture]] = {}
        self._rows = {row.one.name: row for row in view.rows if row.one.kind in ("file", "files")}
        self._places: dict[str, Element] = {}
        self._shown: dict[str, tuple[Known, ...]] = dict.fromkeys(self._rows, ())
        self._known: dict[Known, Content] = {}
        self._at_work = self._due = False
        self._anew = False
        threshold = threshold_of(self.form)
        for row in view.rows:
            if row.one is threshold:
                with row.row, element("div", "content"), element("div", "links"):
                    self._pictures[row.one.name] = [ThresholdView(self.form, row.one, pages, serve)]

    def look_at_all(self) -> None:
        """From now on look at files that nobody changed by hand as well."""
        self._anew = True

    @property
    def _looks(self) -> bool:
        """Whether files are read: not before a field for them was changed by hand."""
        return self._anew or any(row.touched for row in self._rows.values())

    def changed(self) -> bool:
        """Whether files are not as they are shown: written again, new or gone, those in a folder too."""
        if self._at_work or not self._looks:
            return False
        return any(self._files(row.one) != self._shown[name] for name, row in self._rows.items())

    async def look(self) -> None:
        """Read files that are new, show what they hold, and colour pictures.

        Nothing is read before a field for files was changed by hand.
        """
        self._due = True
        if self._at_work:
            return
        self._at_work = True
        try:
            while self._due:  # an answer for a picture may last: files come meanwhile
                self._due = False
                if self._looks:
                    await self._follow()
                for picture in [each for some in self._pictures.values() for each in some]:
                    await picture.colour()
        finally:
            self._at_work = False

    async def _follow(self) -> None:
        """Read and show until no file is new."""
        while (now := {name: self._files(row.one) for name, row in self._rows.items()}) != self._shown:
            await self._read(now)
            if any(row.row.is_deleted for row in self._rows.values()):  # the browser has left the page
                return
            self._shown = now
            for name, files in now.items():
                if files or name in self._places:
                    self._show(self._rows[name], files)

    async def _read(self, files: Mapping[str, tuple[Known, ...]]) -> None:
        """Read those that are not known."""
        new = list(dict.fromkeys(each for some in files.values() for each in some if each not in self._known))
        if new:
            found = await aside.io_bound(contents, [path for path, *_ in new])
            self._known |= dict(zip(new, found or [Content()] * len(new), strict=True))  # none as the window ends

    def _files(self, one: Field) -> tuple[Known, ...]:
        """Files of a field that are there."""
        lines = [line.strip() for line in str(self.form.value(one)).splitlines() if line.strip()]
        found = (known_file(self._folder / line, one.folder) for line in lines)
        return tuple(each for each in found if each is not None)

    def _show(self, row: FieldRow, files: tuple[Known, ...]) -> None:
        if row.one.name not in self._places:
            with row.row:
                self._places[row.one.name] = element("div", "content", aria_live="polite")
        place = self._places[row.one.name]
        place.clear()
        self._pictures.pop(row.one.name, None)
        with place:
            for known in files:
                self._file(row.one, known[0], self._known[known])

    def _file(self, one: Field, path: Path, content: Content) -> None:
        """Name and kind of a file above its facts."""
        with element("p"):
            text("strong", path.name)
            text("span", f": {content.kind or ('a folder' if path.is_dir() else 'a file')}")
            if one.kind == "files":
                self._without(one, path)
        with element("ul"):
            for line in (*content.facts, *self._in_common(content)):
                text("li", line)
            for line in content.warnings:
                text("li", f"warning: {line}")
            if content.wrong:
                text("li", content.wrong, "refused")
        units = self._units_of(one)
        if units and content.kind == SURFACE and not content.wrong:
            with element("div", "links"):
                self._offer(units, path, content)
                self._picture(one, units, path)

    def _without(self, one: Field, path: Path) -> None:
        """A button that takes a file out of a field for several, which a file that is dropped is added to."""

        def take_out() -> None:
            lines = [line.strip() for line in str(self.form.value(one)).splitlines()]
            rest = "\n".join(line for line in lines if line and self._folder / line != path)
            fill(one.name, rest)

        button = text("button", "remove", type="button", aria_label=f"remove {path.name} from {one.label}")
        button.on("click", take_out)

    def _offer(self, units: list[Field], path: Path, content: Content) -> None:
        """Buttons that choose a unit, of all files where none is chosen yet; nothing is chosen without them."""

        def choose(unit: str) -> None:
            field = units[-1] if not self.form.value(units[-1]) else units[0]
            fill(field.name, unit)

        for each in content.units:
            if all(each in one.one.choices for one in units):
                button = text("button", f"use {each}", type="button", aria_label=f"use {each} for {path.name}")
                button.on("click", partial(choose, each))

    def _picture(self, one: Field, units: list[Field], path: Path) -> None:
        self._pictures[one.name] = [
            *self._pictures.get(one.name, ()),
            SurfaceView(self.form, one, units, path, self._pages, self._serve, self._upload),
        ]

    def _units_of(self, one: Field) -> list[Field]:
        """Fields for the unit of a file: one of its own before that of all."""
        named = {each.name: each for each in self.form.fields if each.kind == "choice"}
        return [named[name] for name in (f"unit_{one.name}", f"{one.name}_unit", "unit") if name in named]

    def _in_common(self, content: Content) -> list[str]:
        """Markers of a recording beside those of a model in another field."""
        if not content.markers or content.kind == MODEL:
            return []
        shown = {known for files in self._shown.values() for known in files}
        models = [each for each in (self._known[known] for known in shown) if each.kind == MODEL and each.markers]
        return [markers_in_common(content.markers, each.markers) for each in models]
