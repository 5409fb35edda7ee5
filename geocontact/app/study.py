"""The study that a filled form begins: a description that `geocontact cohort` reads."""

from __future__ import annotations

import json
from collections.abc import Mapping
from itertools import count
from math import isfinite
from pathlib import Path

from geocontact.analyses.frame.calls import key
from geocontact.analyses.frame.file_content import holds
from geocontact.app.fields import Field, Form
from geocontact.cli.command import FORMS
from geocontact.study.trials import literal

HEAD = """\
analysis = {command}

[options]
"""
ONE = """\
# A study of one trial. To make it one of many: name the files by a pattern, files = "data/{subject}_{trial}.csv",
# and write "{file}" in place of a path below. [sweep] lists values of an option that every trial is evaluated with.
"""


def study_of(forms: Mapping[str, Form], folder: Path) -> str:
    """Text of the description; paths start from `folder`, options are as they are typed on the command line.

    Parameters
    ----------
    forms
        A form of one analysis by the name of each trial, "" for one that has none: what all of them say stands once.
    """
    said = {trial: _options(form, folder) for trial, form in forms.items()}
    first, *others = said.values()
    shared = {name: text for name, text in first.items() if all(each.get(name) == text for each in others)}
    command = json.dumps(next(iter(forms.values())).command)
    parts = [("" if others else ONE) + HEAD.format(command=command) + _lines(shared)]
    for trial, options in said.items() if others else ():
        own = {name: text for name, text in options.items() if name not in shared}
        parts.append(f"[[trials]]\ntrial = {json.dumps(trial, ensure_ascii=False)}\n[trials.options]\n{_lines(own)}")
    return "\n".join(parts)


def _lines(options: Mapping[str, str]) -> str:
    return "".join(f"{name} = {text}\n" for name, text in options.items())


def _options(form: Form, folder: Path) -> dict[str, str]:
    """Values as TOML writes them, by the keys of a study."""
    return {
        key(one.one): _toml(one, form, folder)
        for one in form.fields
        if one.name not in FORMS and not form.without_effect(one) and one.typed(form.value(one), form.unit(one))
    }


def written_study(file: Path, described: str) -> Path:
    """Write a description into `file`, or into the next of that name where one stands that says something else."""
    file.parent.mkdir(parents=True, exist_ok=True)
    numbered = (file.with_stem(f"{file.stem}-{k}") for k in count(2))
    place = file
    content = described.encode()
    while place.exists() and not holds(place, content):
        place = next(numbered)
    place.write_bytes(content)
    return place


def _toml(one: Field, form: Form, folder: Path) -> str:
    """A value as TOML writes it: a number where the option is one, a list where there may be several."""
    value = form.value(one)
    if isinstance(value, bool):
        return json.dumps(value)
    texts = [word.removeprefix(f"{one.spelled}=") for word in one.typed(value, form.unit(one))]
    if one.kind in ("file", "files"):
        texts = [_absolute(text, folder) for text in texts]
    texts = [literal(text) for text in texts]
    if one.several:
        return json.dumps(texts, ensure_ascii=False)
    kind = one.one.typed.kind if one.one.typed is not None else one.one.kind
    number = _number(texts[0]) if kind in (int, float) else ""
    return number or json.dumps(texts[0], ensure_ascii=False)


def _absolute(text: str, folder: Path) -> str:
    """A path that holds wherever the description lies; what is no file here stays as it is typed."""
    try:
        return (folder / text).as_posix() if (folder / text).exists() else text
    except OSError:
        return text


def _number(text: str) -> str:
    """A number as TOML writes it, which knows no 05, 5. or .5; "" for what is none."""
    for kind in (int, float):
        try:
            found = kind(text)
        except ValueError:
            continue
        return repr(found) if isfinite(found) else ""
    return ""
