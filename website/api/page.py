"""The page of one public name: signature, parameters, what it returns and raises, an example, where it comes from."""

from __future__ import annotations

import dataclasses
import inspect
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import Declared, declared
from geocontact.chain.links import LawParameters
from geocontact.data.units import Unit
from website.api.docstring import cell, entry_list, markdown, parts
from website.api.entries import Entry
from website.api.types import shown_type, signature

ROOT = Path(__file__).resolve().parents[2]


def page(entry: Entry, read_more: Iterable[tuple[str, str]], theory: Iterable[tuple[str, str]]) -> str:
    """Markdown of its page; `read_more` are titles and links of pages that speak of it, `theory` of its formulas."""
    thing = entry.thing
    told = parts(entry.docstring)
    summary = [paragraph for paragraph in told.words if not paragraph.startswith("    ")]
    lines = [f"# gc.{entry.name}", *map(_words, summary)]
    if callable(thing) and not isinstance(thing, Unit):
        lines.append(f"```python\n{signature(entry.name, thing)}\n```")
    lines += ["## Example", f"```python\n{entry.example}\n```"]
    lines += _options(thing) if isinstance(thing, Job) else _sections(thing, told.sections)
    if isinstance(thing, LawParameters):
        rows = [(f"`{name}`", f"{value:g}") for name, value in thing.neutral.items()]
        lines += ["## Numbers", _table(("name", "where the law has no such term"), rows)]
    lines += _returned(thing) + _members(thing)
    place = Path(inspect.getfile(entry.module)).relative_to(ROOT).as_posix()
    lines += ["## Source", f"`{place}`" + (f", line {entry.line}" if entry.line > 1 else "")]
    for words, pages in (("Formulas and their sources", theory), ("Read more", read_more)):
        links = [f"[{title}]({link})" for title, link in pages]
        lines += [f"{words}: " + " · ".join(links)] if links else []
    return "\n\n".join(lines) + "\n"


def _words(paragraph: str) -> str:
    return markdown(" ".join(paragraph.splitlines()))


def _options(job: Job[Any, Any]) -> list[str]:
    known = [one for one in declared(job.options) if one.settable]
    lines = ["## Parameters"]
    for section in dict.fromkeys(one.section for one in known):
        lines += [f"### {section}"] if section else []
        rows = [_option(one) for one in known if one.section == section]
        lines.append(_table(("name", "type", "unit", "by default", "what it is"), rows))
    return lines


def _option(one: Declared) -> tuple[str, ...]:
    unit = one.typed.si if one.typed is not None else ""
    default = "**required**" if one.required else "" if one.default in (None, ()) else f"`{one.default}`"
    words = one.words + (f" Written as `{one.typed.python}`." if one.typed is not None else "")
    return f"`{one.name}`", shown_type(one.kind), cell(unit), default, cell(words)


def _sections(thing: Any, sections: dict[str, list[str]]) -> list[str]:
    lines: list[str] = []
    kinds = _kinds(thing)
    for heading, body in ({"Parameters": []} | sections if kinds else sections).items():
        if heading == "Examples":
            continue
        rows = []
        for names, words in entry_list(body):
            name = names.partition(" : ")[0]
            kind = " / ".join(dict.fromkeys(shown_type(kinds[one]) for one in name.split(", ") if one in kinds))
            rows.append((f"`{name}`", kind, cell(words)))
        if heading == "Parameters":
            said = {one for row in rows for one in row[0].strip("`").split(", ")}
            rows += [(f"`{name}`", shown_type(kind), "") for name, kind in kinds.items() if name not in said]
        if heading == "Raises":
            lines += [f"## {heading}", _table(("error", "when"), [(row[0], row[2]) for row in rows])]
        else:
            lines += [f"## {heading}", _table(("name", "type", "what it is"), rows)]
    return lines


def _kinds(thing: Any) -> dict[str, Any]:
    if not callable(thing) or isinstance(thing, Unit) or getattr(thing, "_is_protocol", False):
        return {}
    try:
        return {name: one.annotation for name, one in inspect.signature(thing).parameters.items()}
    except (TypeError, ValueError):
        return {}


RAISED = [
    ("`gc.InputError`", "A file or an option is unusable; one line says which, why, and what to do."),
    ("`gc.InputWarning`", "A warning, not an error: what was computed has a reservation."),
]
"""By every job."""


def _returned(thing: Any) -> list[str]:
    if isinstance(thing, Job):
        return [*_result(thing), "## Raises", _table(("error", "when"), RAISED)]
    if inspect.isfunction(thing):
        kind = inspect.signature(thing).return_annotation
        return [] if kind in (None, "None") else ["## Returns", shown_type(kind)]
    return []


def _result(job: Job[Any, Any]) -> list[str]:
    """Type of what a job returns, and its fields."""
    result = inspect.get_annotations(job.run, eval_str=True)["return"]
    summary = parts(inspect.getdoc(result) or "")
    known = entry_list(summary.sections.get("Parameters", []))
    told = {name: words for names, words in known for name in names.split(", ")}
    fields = [one for one in dataclasses.fields(result) if one.name != "record"]
    rows = [(f"`{one.name}`", shown_type(one.type), cell(told.get(one.name, ""))) for one in fields]
    first = _words(summary.words[0]) if summary.words else ""
    return [
        "## Returns",
        f"`{result.__name__}`: {first}",
        _table(("field", "type", "what it is"), rows),
        "Its methods `table`, `tables`, `figure`, `write` and `page`: see [gc.Result](Result.md).",
    ]


def _members(thing: Any) -> list[str]:
    """Methods and properties of a class with their first sentences."""
    if not inspect.isclass(thing) or issubclass(thing, Exception):
        return []
    rows = []
    for name, one in vars(thing).items():
        plain = one.fget if isinstance(one, property) else getattr(one, "func", getattr(one, "__func__", one))
        if name.startswith("_") or not inspect.isfunction(plain) or not plain.__doc__:
            continue
        kind = "`" + name + ("`" if not inspect.isfunction(getattr(one, "__func__", one)) else "()`")
        first = parts(plain.__doc__).words[0]
        rows.append((kind, shown_type(inspect.signature(plain).return_annotation), cell(" ".join(first.split()))))
    return ["## Methods and properties", _table(("name", "gives", "what it is"), rows)] if rows else []


def _table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    kept = [i for i in range(len(head)) if any(row[i] for row in rows)]
    told = [tuple(row[i] for i in kept) for row in [head, *rows]]
    lines = ["| " + " | ".join(row) + " |" for row in told]
    return "\n".join([lines[0], "|" + "---|" * len(kept), *lines[1:]])


def anchors(text: str) -> list[str]:
    """Names after `gc.` that a page of the documentation speaks of."""
    return re.findall(r"\bgc\.([A-Za-z_]+(?:\.[a-z_]+)?)", text)
