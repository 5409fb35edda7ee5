"""The form of an analysis: groups of fields, each with its help beside it, why it has no effect, and what is wrong."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui
from nicegui.element import Element
from nicegui.elements.mixins.text_element import TextElement

from geocontact.app.elements import choice, element, text
from geocontact.app.fields import Field, Form

PAUSE = 0.2
"""s between two messages about what is typed."""
VALUE = "(e) => emit(e.target.value)"
CHECKED = "(e) => emit(e.target.checked)"


class FieldRow:
    """A field on the page.

    Parameters
    ----------
    one, form
        What is filled in, and where.
    upload
        Address that takes files.
    changed
        Called after each change.
    """

    def __init__(self, one: Field, form: Form, upload: str, changed: Callable[[], None]) -> None:
        self.one, self._form, self._changed = one, form, changed
        self.inputs: list[Element] = []
        self.touched = False
        with element("div", "field") as self.row:
            label = text("label", f"{one.label}{' (required)' if one.one.required else ''}")
            with element("div", "in"):
                main = self._input()
                main.props["name"] = one.name
                label.props["for"] = main.html_id
                if one.units:
                    self._units()
                elif one.unit:
                    text("span", one.unit)
                if one.kind in ("file", "files"):
                    self._pick(main, upload)
            self._help = text("p", " ".join(part for part in (one.words, self._more()) if part), "help")
        main.props["aria-describedby"] = self._help.html_id
        if one.one.required:
            main.props["aria-required"] = "true"
        self.inputs.insert(0, main)
        self._said: dict[str, TextElement] = {}

    def refresh(self, wrong: str) -> None:
        """Say why it has no effect now, and what is wrong with it."""
        why = self._form.without_effect(self.one)
        if self._say("why", why):
            for each in self.inputs:
                each.props.set_bool("disabled", bool(why))
            self.row.classes(**{"add" if why else "remove": "off"})
        if self._say("bad", wrong, role="alert"):
            self.inputs[0].props.set_optional("aria-invalid", "true" if wrong else None)

    def _say(self, kind: str, words: str, **attributes: str) -> bool:
        """A line below the help, made when there is something to say: most fields never need one; whether it is new."""
        line = self._said.get(kind)
        if words == (line.text if line is not None else ""):
            return False
        if line is None:
            with self.row:
                line = self._said[kind] = text("p", words, kind, **attributes)
            line.move(target_index=self.row.default_slot.children.index(self._help) + 1)
            described = (self._help, *self._said.values())
            self.inputs[0].props["aria-describedby"] = " ".join(each.html_id for each in described)
        line.text = words
        return True

    def _more(self) -> str:
        """Range and default."""
        parts = (self.one.usual, f"by default {self.one.default}" if self.one.default else "")
        more = "; ".join(part for part in parts if part)
        return more[:1].upper() + more[1:]

    def _input(self) -> Element:
        one, value = self.one, self._form.value(self.one)
        if one.kind == "flag":
            made = element("input", type="checkbox")
            made.props.set_bool("checked", bool(value))
            return made.on("change", lambda e: self._set(bool(e.args)), js_handler=CHECKED)
        if one.kind == "choice":
            values = [("", f"({one.default or 'none'})"), *((str(each), str(each)) for each in one.one.choices)]
            made = choice(values, str(value))
            return made.on("change", lambda e: self._set(str(e.args)), js_handler=VALUE)
        if one.kind in ("files", "lines"):
            made = element("textarea", rows=2, defaultValue=value, spellcheck="false")
        else:
            made = element("input", type="text", defaultValue=value, spellcheck="false", autocomplete="off")
            if one.one.typed is not None and one.one.typed.python:
                made.props["placeholder"] = one.default
        made.on("change", lambda e: self._set(str(e.args)), js_handler=VALUE)  # at once: Run may be what comes next
        return made.on("input", lambda e: self._set(str(e.args)), js_handler=VALUE, throttle=PAUSE)

    def _units(self) -> None:
        values = [(each, each or "unit …") for each in self.one.units]
        made = choice(values, self._form.unit(self.one), aria_label=f"unit of {self.one.label}")
        made.props["name"] = f"{self.one.name}-unit"
        made.on("change", lambda e: self._set_unit(str(e.args)), js_handler=VALUE)
        self.inputs.append(made)

    def _pick(self, main: Element, upload: str) -> None:
        with element("span", "pick"):
            text("span", "choose or drop …")
            told: dict[str, Any] = {"data_to": upload, "data_target": main.html_id}
            made = element("input", type="file", aria_label=f"choose a file for {self.one.label}", **told)
            if self.one.kind == "files":
                made.props["multiple"] = True
        self.inputs.append(made)
        if self.one.folder:
            with element("span", "pick"):
                text("span", "or a folder, without videos …")
                whole = element("input", type="file", aria_label=f"choose a folder for {self.one.label}", **told)
                whole.props["webkitdirectory"] = True
            self.inputs.append(whole)

    def _set(self, value: str | bool) -> None:
        self._form.values[self.one.name] = value
        self.touched = True
        self._changed()

    def _set_unit(self, unit: str) -> None:
        self._form.units[self.one.name] = unit
        self._changed()


class FormView:
    """All fields of an analysis, in groups.

    Parameters
    ----------
    form
        What is filled in.
    upload
        Address that takes files.
    changed
        Called after each change.
    """

    def __init__(self, form: Form, upload: str, changed: Callable[[], None]) -> None:
        self.form = form
        self.rows: list[FieldRow] = []
        self._groups: dict[str, Element] = {}
        for section in dict.fromkeys(one.one.section for one in form.fields):
            inside = [one for one in form.fields if one.one.section == section]
            with element("details") as group:
                if not section or any(one.one.required or form.values.get(one.name) for one in inside):
                    group.props["open"] = True
                text("summary", section or "Inputs and options")
                self.rows += [FieldRow(one, form, upload, changed) for one in inside]
            self._groups |= dict.fromkeys((one.name for one in inside), group)
        self.refresh("")

    def refresh(self, wrong: str, only_touched: bool = True) -> str:
        """Show a mistake at the field that it names; what is said of none, or of one that nobody filled in yet."""
        at = self.form.at(wrong) if wrong else None
        shown = at is not None and (not only_touched or at.name in self.form.values)
        for row in self.rows:
            row.refresh(wrong if shown and at is not None and row.one.name == at.name else "")
        return "" if shown else wrong

    def go_to(self, message: str) -> None:
        """Open the group of the field that a message names, and go there."""
        at = self.form.at(message)
        if at is None:
            return
        main = next(row for row in self.rows if row.one.name == at.name).inputs[0]
        group = self._groups[at.name].html_id
        ui.run_javascript(
            f"document.getElementById('{group}').open = true; const e = document.getElementById('{main.html_id}');"
            "e.scrollIntoView({block: 'center'}); e.focus();"
        )
