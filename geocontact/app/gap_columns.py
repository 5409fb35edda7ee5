"""Columns of recordings and the channels of a model: what is chosen for each on the page."""

from __future__ import annotations

from collections.abc import Sequence

from geocontact.analyses.frame.quantities import UNITS, is_known
from geocontact.app.elements import choice, element, text
from geocontact.app.form_view import VALUE

INPUT, OUTPUT = "input", "output"
CHANNELS: dict[str, dict[str, tuple[str, ...]]] = {
    "elbow": {INPUT: ("beta",), OUTPUT: ("force",)},
    "knee": {
        INPUT: ("flexion", "adduction", "area_medial", "area_lateral"),
        OUTPUT: ("force_medial", "force_lateral"),
    },
}
"""Channels of the package's models; a simulator of somebody's own has those of the columns' names."""


class ColumnTable:
    """A row for each column: what it is, and its unit where the file states no known one; nothing is chosen at first.

    Parameters
    ----------
    columns
        Names with units, "" where the file states none.
    model
        Name of a model of the package, "" for another simulator.
    """

    def __init__(self, columns: Sequence[tuple[str, str]], model: str) -> None:
        self.columns = list(columns)
        self._model = model
        self._role = {name: self._named(name) for name, _ in columns}
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

    def outputs(self) -> list[str]:
        """Channels that the model predicts."""
        return list(CHANNELS[self._model][OUTPUT]) if self._model else self._of(OUTPUT)

    def _of(self, side: str) -> list[str]:
        return [name for name, _ in self.columns if self._role[name] == side]

    def _roles(self) -> list[tuple[str, str]]:
        if not self._model:
            return [("", "not used"), (INPUT, INPUT), (OUTPUT, OUTPUT)]
        every = [(each, f"{side} {each}") for side, names in CHANNELS[self._model].items() for each in names]
        return [("", "not used"), *every]

    def _named(self, name: str) -> str:
        """The channel that a column has the name of."""
        known = [each for names in CHANNELS.get(self._model, {}).values() for each in names]
        return name if name in known else ""

    def _channel(self, name: str) -> str:
        return self._role[name] if self._model else name
