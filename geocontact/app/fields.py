"""Fields of a form from the declaration of options, and the words of the command line that a filled form stands for."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

from geocontact.analyses.catalogue import Entry, entry_of
from geocontact.analyses.frame.marks import Excludes, Missing, Requires, Spelled
from geocontact.analyses.frame.options import Declared, declared
from geocontact.cli import folders, opensim_setup
from geocontact.cli.command import FORMS, RESULTS, argument, default, negative, option, speller
from geocontact.cli.folders import OUT
from geocontact.data.plausible import Plausible

PROGRAM = "geocontact"
SETUP, TRIAL = opensim_setup.OPTION.removeprefix("--"), folders.TRIAL.removeprefix("--")
BEFORE = (SETUP, TRIAL)
"""What the command line replaces by inputs and options before it reads them."""
CASE = "case"
"""The input that is a folder of a gap case."""
Kind = Literal["flag", "choice", "file", "files", "lines", "text"]
UNITS_OF = {
    "length": ("mm", "cm", "m", "in"),
    "lengths": ("mm", "cm", "m", "in"),
    "thickness": ("mm", "cm", "m", "in"),
    "pressure": ("", "MPa", "GPa", "kPa", "Pa", "bar", "psi", "mmHg"),
    "body_mass": ("kg", "g", "lb"),
    "fraction": ("", "%"),
}
"""Units that can be chosen beside a number, by what reads its text; the first one is in force at first.

An empty one stands where the command line does not assume a unit.
"""


@dataclass(frozen=True)
class Field:
    """One option in a form.

    Parameters
    ----------
    one
        The option as it was declared.
    words
        Its help, as the command line spells it.
    spelled
        How the command line spells it, with its dashes, or MOVING for an input.
    folder
        Whether it may be a folder.
    """

    one: Declared
    words: str
    spelled: str
    folder: bool = False

    @property
    def name(self) -> str:
        """The name in Python."""
        return self.one.name

    @property
    def label(self) -> str:
        """The name as it stands beside the input."""
        return option(self.one).replace("-", " ")

    @property
    def kind(self) -> Kind:
        """What is filled in."""
        if self.one.kind is bool:
            return "flag"
        if self.one.choices:
            return "choice"
        paths = Path in _parts(self.one.kind)
        if self.several:
            return "files" if paths or self.name == "motion" else "lines"
        return "file" if paths else "text"

    @property
    def several(self) -> bool:
        """Whether the command line takes one value each time; else a text may hold several: 1,4."""
        return self.one.spelled.each or (self.one.several and self.one.typed is None)

    @property
    def units(self) -> tuple[str, ...]:
        """Units that can be chosen; empty where the text says everything."""
        return UNITS_OF.get(self.one.typed.read, ()) if self.one.typed is not None else ()

    @property
    def unit(self) -> str:
        """Unit that is fixed: [mm]."""
        typed = self.one.typed
        if typed is not None and typed.hint.startswith("["):
            return typed.hint.strip("[]")
        known = self.one.range
        return known.unit.si if typed is None and isinstance(known, Plausible) and known.unit.si != "1" else ""

    @property
    def usual(self) -> str:
        """What its values usually are: "0.1 to 20 mm"."""
        known = self.one.range
        if not isinstance(known, Plausible):
            return ""
        low, high = known.usual or known.possible
        return f"{'usually' if known.usual else 'possible:'} {low:g} to {high:g} {known.unit.name}".rstrip()

    @property
    def default(self) -> str:
        """What holds where nothing is filled in, as it is typed."""
        value = None if self.one.required else default(self.one)
        return "" if value is None or isinstance(value, (bool, tuple, Mapping)) else str(value)

    def typed(self, value: str | bool, unit: str = "") -> list[str]:
        """Words of the command line for what was filled in."""
        if isinstance(value, bool):
            if value == (self.one.default is True):
                return []
            return [self.spelled if value else negative(self.one)]
        lines = [line.strip() for line in value.splitlines() if line.strip()]
        texts = [_with_unit(line, unit) for line in lines]
        if argument(self.one):
            return [f"./{text}" if text.startswith("-") else text for text in texts]
        return [f"{self.spelled}={text}" for text in texts]


@dataclass
class Form:
    """A form and what was filled in.

    Parameters
    ----------
    command
        As it is typed: "elbow fit".
    values, units
        By the names of the options.
    """

    command: str
    values: dict[str, str | bool] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)

    @property
    def entry(self) -> Entry:
        """The analysis."""
        return entry_of(self.command)

    @property
    def fields(self) -> tuple[Field, ...]:
        """In the order of the declaration."""
        return fields_of(self.command)

    def value(self, one: Field) -> str | bool:
        """What was filled in, or what the form shows at first."""
        return self.values.get(one.name, one.one.default is True if one.kind == "flag" else "")

    def unit(self, one: Field) -> str:
        """The unit that was chosen."""
        return self.units.get(one.name, one.units[0] if one.units else "")

    def given(self, name: str) -> bool:
        """Whether an option holds a value, as `Options.given` says of it."""
        one = next((each for each in self.fields if each.name == name), None)
        if one is None:
            return False
        filled = self.value(one)
        return bool(filled) or (filled == "" and not one.one.required and one.one.default not in (None, False, ()))

    def without_effect(self, one: Field) -> str:
        """Why a field has no effect now, "" where it has one."""
        for rule in one.one.rules:
            others = [each for each in (rule.other, getattr(rule, "alternative", "")) if each]
            if isinstance(rule, Requires) and not any(map(self.given, others)) and not self._mutual(one, others):
                return f"needs {' or '.join(map(self._spelled, others))}"
            if isinstance(rule, Excludes) and self.given(rule.other):
                return f"has no effect with {self._spelled(rule.other)}"
        endings = one.one.endings
        if endings and not any(Path(path).suffix.lower() in endings for path in self.paths()):
            return f"only for {', '.join(endings)} files"
        return ""

    def _mutual(self, one: Field, others: list[str]) -> bool:
        """Whether one of the others requires this field too: somebody has to begin with one of them."""
        rules = [rule for each in self.fields if each.name in others for rule in each.one.rules]
        return any(isinstance(rule, Requires) and one.name in (rule.other, rule.alternative) for rule in rules)

    def paths(self) -> list[str]:
        """Files and folders that were filled in."""
        filled = [str(self.value(one)) for one in self.fields if one.kind in ("file", "files")]
        return [line.strip() for text in filled for line in text.splitlines() if line.strip()]

    def words(self, out: Path | str) -> list[str]:
        """The command line: words after `geocontact`; fields without effect are left out."""
        inputs: list[str] = []
        named: list[str] = []
        gap = False  # an input that is missing: those behind it would be read in its place
        for one in self.fields:
            if not self.without_effect(one):
                typed = one.typed(self.value(one), self.unit(one))
                gap = gap or (argument(one.one) and one.one.required and not typed)
                if not (gap and argument(one.one)):
                    (inputs if argument(one.one) else named).extend(typed)
        return [*self.command.split(), *inputs, *named, f"{OUT}={out}"]

    def at(self, message: str) -> Field | None:
        """The field that a message names: by its spelling, else by the file that was filled in."""
        found = [(place, one) for one in self.fields if (place := _place(one.spelled, message)) >= 0]
        if found:
            return min(found, key=lambda each: (each[0], -len(each[1].spelled)))[1]
        filled = [
            (one, line.strip())
            for one in self.fields
            if one.kind in ("file", "files")
            for line in str(self.value(one)).splitlines()
        ]
        for shorter in (str, lambda path: Path(path).name):
            named = [(len(shorter(path)), one) for one, path in filled if _place(shorter(path), message) >= 0]
            if named:
                return max(named, key=lambda each: each[0])[1]
        return None

    def _spelled(self, name: str) -> str:
        return next((one.spelled for one in self.fields if one.name == name), name)

    def kept(self) -> str:
        """What was filled in, for a page that is loaded anew."""
        return json.dumps({"values": self.values, "units": self.units}, ensure_ascii=False)

    @classmethod
    def of_kept(cls, command: str, kept: str) -> Form:
        """The form that was kept; an empty one of a text that is none, without what this analysis does not have."""
        try:
            found = json.loads(kept)
            values, units = found["values"].items(), found["units"].items()
        except (ValueError, KeyError, TypeError, AttributeError):
            return cls(command)
        kinds = {one.name: bool if one.kind == "flag" else str for one in fields_of(command)}
        return cls(
            command,
            {name: value for name, value in values if type(value) is kinds.get(name)},
            {name: unit for name, unit in units if isinstance(unit, str)},
        )

    @classmethod
    def of_words(cls, words: Iterable[str]) -> Form:
        """The form that words of the command line stand for; InputError is for who runs them."""
        rest = list(words)
        command = next(" ".join(rest[:count]) for count in (2, 1) if " ".join(rest[:count]) in _commands())
        form = cls(command)
        _fill(form, rest[len(command.split()) :])
        return form


def shown(words: Iterable[str]) -> str:
    """The command line as it is typed into a terminal."""
    line = [PROGRAM, *words]
    return subprocess.list2cmdline(line) if os.name == "nt" else shlex.join(line)


@cache
def fields_of(command: str) -> tuple[Field, ...]:
    """Fields of an analysis; options that its class sets itself have none."""
    known = declared(entry_of(command).load_options())
    spell = speller(known)
    before = _of_before(command)
    own = [_in_place(one, before) for one in known if one.settable]
    shown = [*own, *_of_every_command(entry_of(command).load_options().over_time)]
    places = {own[0].name} if command in folders.COMMANDS else {CASE}
    found = [Field(one, spell(one.words), spell(f"`{one.name}`"), one.name in places) for one in shown]
    inputs = sum(argument(each.one) for each in found)
    return (*found[:inputs], *(Field(one, one.words, f"--{one.name}") for one in before), *found[inputs:])


def _of_before(command: str) -> list[Declared]:
    """What is asked before the options: a set-up file of OpenSim, trials of a folder."""
    setup = [_asked(SETUP, Path, opensim_setup.HELP)] if command in opensim_setup.COMMANDS else []
    trials = [_asked(TRIAL, tuple[str, ...], folders.HELP)] if command in folders.COMMANDS else []
    return setup + trials


def _in_place(one: Declared, before: Iterable[Declared]) -> Declared:
    """An option, which has no effect where it is the recording and a set-up file names that."""
    if argument(one) and one.required and any(each.name == SETUP for each in before):
        return replace(one, rules=(*one.rules, Excludes(SETUP)))
    return one


def _of_every_command(over_time: bool) -> list[Declared]:
    """What the command line asks about the results of every analysis."""
    names = [name for name in FORMS if name != "netcdf" or over_time]
    return [_asked(name, bool, FORMS[name], False, RESULTS) for name in names]


def _asked(name: str, kind: Any, words: str, default: Any = None, section: str = "") -> Declared:
    """What the command line asks besides the options of an analysis."""
    spelled = Spelled(each=name == TRIAL)
    return Declared(name, kind, default is None, False, default, None, spelled, (), (), None, Missing(), words, section)


def _commands() -> set[str]:
    from geocontact.analyses.catalogue import ENTRIES

    return {each.command for each in ENTRIES if each.command}


def _fill(form: Form, words: list[str]) -> None:
    """Fill in what was typed: options with their values behind a blank or =, switches, inputs in their order."""
    named = {one.spelled: one for one in form.fields if not argument(one.one)}
    turned_off = {negative(one.one): one for one in named.values() if one.kind == "flag"}
    inputs = [one for one in form.fields if argument(one.one)]
    while words:
        word, equals, text = words.pop(0).partition("=")
        one = named.get(word)
        if word == OUT:
            words[:] = words if equals else words[1:]
        elif word in turned_off:
            form.values[turned_off[word].name] = False
        elif one is None:
            one = inputs[0] if inputs[0].several else inputs.pop(0)
            _add(form, one, word + equals + text)
        elif one.kind == "flag":
            form.values[one.name] = True
        else:
            _add(form, one, text if equals else words.pop(0))
            while one.kind == "files" and words and not words[0].startswith("-") and not inputs[:1]:
                _add(form, one, words.pop(0))


def _add(form: Form, one: Field, text: str) -> None:
    """Fill in a value, below what stands there where there may be several; a unit that can be chosen goes there."""
    unit = next((each for each in one.units if each and _number(text.removesuffix(each)) and text.endswith(each)), "")
    form.values[one.name] = "\n".join(filter(None, (str(form.values.get(one.name, "")), text.removesuffix(unit))))
    if unit:
        form.units[one.name] = unit


def _with_unit(text: str, unit: str) -> str:
    """The unit behind each number that has none; a text that says its unit itself stays."""
    parts = [part.strip() for part in text.split(",")]
    return ",".join(f"{part}{unit}" for part in parts) if unit and all(map(_number, parts)) else text


def _number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _parts(kind: Any) -> tuple[Any, ...]:
    """Types that a type is made of: those of a union, of a tuple."""
    if get_origin(kind) in (Union, UnionType, tuple):
        return tuple(part for each in get_args(kind) for part in _parts(each))
    return (kind,)


def _place(spelled: str, message: str) -> int:
    """Where a message names an option; -1 where it does not, or names a longer one."""
    if not spelled.strip("."):  # the folder that one is in has no name
        return -1
    at = message.find(spelled)
    while at >= 0:
        before, after = message[:at][-1:], message[at + len(spelled) :][:1]
        if not (after.isalnum() or (after in ("-", "_") and after)) and not (before.isalnum() or before == "-"):
            return at
        at = message.find(spelled, at + 1)
    return -1
