"""Columns of recordings and the channels of a model: what is chosen for each on the page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from geocontact.analyses.frame.quantities import UNITS, is_known
from geocontact.analyses.gap.chosen_columns import si_of
from geocontact.app.elements import choice, element, text
from geocontact.app.form_view import VALUE

if TYPE_CHECKING:
    from geocontact.systems.base import Base

INPUT, OUTPUT = "input", "output"


class ColumnTable:
    """A row for each column: what it is, and its unit where the file states no known one; nothing is chosen at first.

    Parameters
    ----------
    columns
        Names with units, "" where the file states none.
    model
        A model of the package, whose channels have names; None for another simulator, which has the columns' names.
    """

    def __init__(self, columns: Sequence[tuple[str, str]], model: Base | None) -> None:
        self.columns = list(columns)
        self._model = model
        self._sides = {} if model is None else {INPUT: model.inputs, OUTPUT: model.outputs}
        known = [each for names in self._sides.values() for each in names]
        self._role = {name: name if name in known else "" for name, _ in columns}
        self._unit = {name: unit if is_known(unit) else "" for name, unit in columns}
        for name, unit in columns:
            with element("div", "field"), element("div", "in"):
                text("span", f"{name}{f' [{unit}]' if unit else ''}")
                made = choice(self._roles(), self._role[name], aria_label=f"{name} is")
                made.on("change", lambda e, name=name: self._role.update({name: str(e.args)}), js_handler=VALUE)
                if not is_known(unit):
                    units = [("", "unit …"), *((each, each) for each in UNITS)]
                    made = choice(units, "", aria_label=f"unit of {name}")
                    made.on("change", lambda e, name=name: self._unit.update({name: str(e.args)}), js_handler=VALUE)

    def rows(self) -> list[dict[str, str]]:
        """Columns that were chosen, as `ChosenColumn` has them."""
        return [
            {"column": name, "channel": self._channel(name), "unit": self._unit[name], "stated": stated}
            for name, stated in self.columns
            if self._role[name]
        ]

    def sides(self) -> dict[str, str | bool]:
        """Options `inputs` and `outputs` of `gap init`."""
        sides = {f"{side}s": self._of(side) for side in (INPUT, OUTPUT)}
        return {option: ",".join(names) for option, names in sides.items() if names}

    def channels(self) -> list[str]:
        """Channels that were chosen."""
        return [self._channel(name) for name, role in self._role.items() if role]

    def outputs(self) -> dict[str, str]:
        """Channels that the model predicts, with their SI units, "" where none is known yet."""
        units = {each["channel"]: si_of(each["unit"]) for each in self.rows()}
        names = self._of(OUTPUT) if self._model is None else [each for each in self._model.outputs if each in units]
        return {name: units[name] for name in names}

    def _of(self, side: str) -> list[str]:
        return [name for name, _ in self.columns if self._role[name] == side]

    def _roles(self) -> list[tuple[str, str]]:
        if self._model is None:
            return [("", "not used"), (INPUT, INPUT), (OUTPUT, OUTPUT)]
        units = self._model.needs.units if self._model.needs is not None else {}
        every = [(n, f"{side} {n} [{units.get(n, '')}]") for side, names in self._sides.items() for n in names]
        return [("", "not used"), *every]

    def _channel(self, name: str) -> str:
        return self._role[name] if self._model is not None else name
