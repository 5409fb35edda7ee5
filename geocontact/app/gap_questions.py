"""What a begun case asks, and the answers as they were typed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from geocontact.analyses.gap.init.options import QUESTIONS
from geocontact.app.elements import element, text
from geocontact.app.form_view import CHECKED, VALUE

ENDS = ("start", "lower", "upper", "unit")
UNKNOWN = "?"


class StartTable:
    """Start values of the numbers that a model of the package needs.

    Parameters
    ----------
    units
        SI units by name.
    kept
        What was typed, by name; stays when the fields are made anew.
    """

    def __init__(self, units: Mapping[str, str], kept: dict[str, str]) -> None:
        self._units, self._kept = units, kept
        for name, unit in units.items():
            kept.setdefault(name, "")
            with element("div", "field"), element("div", "in"):
                text("span", f"{name} [{unit}]")
                word(kept, name, f"start value of {name}")

    def lines(self) -> str:
        """Option `number` of `gap init`."""
        return "\n".join(f"{name}={typed}" for name in self._units if (typed := self._kept[name].strip()))


class QuestionTable:
    """Trials that are held out, numbers of the model with their bounds, noise of the sensors.

    Parameters
    ----------
    settings
        What case.toml says now, as `begun_settings` has it; questions that no field here answers are shown.
    outputs
        SI units of the channels that the model predicts, by name.
    """

    def __init__(self, settings: Mapping[str, Any], outputs: Mapping[str, str]) -> None:
        self._trials = [*settings["calibration"], *settings["evaluation"]]
        self._held = {name: name in settings["evaluation"] for name in self._trials}
        self._numbers: dict[str, dict[str, Any]] = {}
        self._noise = {name: str(settings.get("noise", {}).get(name, "")) for name in outputs}
        if settings[QUESTIONS]:
            text("p", "Open, and kept in case.toml as comments:")
            with element("ul"):
                for question in settings[QUESTIONS]:
                    text("li", question)
        with element("div", "field"):
            text("p", "Held out, nothing is fitted to them:")
            for name in self._trials:
                self._box(self._held, name, f"hold out {name}")
        for name, said in settings.get("parameters", {}).items():
            self._number(name, said)
        for name, unit in outputs.items():
            with element("div", "field"), element("div", "in"):
                text("span", f"noise of {name} [{unit}]")
                word(self._noise, name, f"noise of {name}, SI unit; estimated where empty")

    def answers(self) -> dict[str, Any]:
        """Fields of `answer_case`; ValueError says which one is no number."""
        numbers = {}
        for name, typed in self._numbers.items():
            ends = {end: _number(str(typed[end]), f"{end} of {name}") for end in ENDS[: 1 if typed["fixed"] else 3]}
            numbers[name] = {"lower": None, "upper": None, **ends, "unit": str(typed["unit"]).strip()}
        noise = {name: _number(typed, f"noise of {name}") for name, typed in self._noise.items() if typed.strip()}
        evaluation = [name for name in self._trials if self._held[name]]
        return {"evaluation": evaluation, "numbers": numbers, "noise": noise}

    def _number(self, name: str, said: Mapping[str, Any]) -> None:
        known = {end: "" if (value := said.get(end, "")) == UNKNOWN else str(value) for end in ENDS}
        self._numbers[name] = {**known, "fixed": bool(said.get("fixed", False))}
        with element("div", "field"), element("div", "in"):
            text("span", name)
            for end in ENDS:
                word(self._numbers[name], end, f"{end} of {name}")
            self._box(self._numbers[name], "fixed", f"{name} is known exactly")

    def _box(self, kept: dict[str, Any], key: str, label: str) -> None:
        with element("label"):
            made = element("input", type="checkbox")
            made.props.set_bool("checked", bool(kept[key]))
            made.on("change", lambda e: kept.update({key: bool(e.args)}), js_handler=CHECKED)
            text("span", f" {label}")


def word(kept: dict[str, Any], key: str, label: str) -> None:
    """A field whose text is kept."""
    short = label.partition(" ")[0]
    made = element("input", type="text", defaultValue=str(kept[key]), size=9, aria_label=label, placeholder=short)
    for event in ("change", "input"):
        made.on(event, lambda e: kept.update({key: str(e.args)}), js_handler=VALUE)


def _number(typed: str, what: str) -> float:
    try:
        return float(typed)
    except ValueError:
        raise ValueError(f"{what} is {typed!r}: write a number" if typed.strip() else f"{what} is missing") from None
