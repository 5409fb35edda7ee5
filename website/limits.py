"""All known limits: docs/reference/limits.md, gathered from the sections of the pages that tell them, and from tests.

A page tells its limits below a heading of `HEADINGS`; the page gathered from them has the first sentence of each and
says where it stands.
"""

from __future__ import annotations

import ast
import csv
import re
from collections import Counter
from pathlib import Path

from website.stage import ROOT

PAGE = "docs/reference/limits.md"
README = ROOT / "README.md"  # not a page of the site
PAPERS = "papers.csv"
"""What the five papers do, by item: state, command and file; beside the page."""
STATES = ("done", "other", "partly", "open", "missing")
"""Of an item: there; done otherwise, on purpose, with its reason; some of it; in work; not there."""
HEADINGS = ("Limits", "What it does not do", "What these trials cannot distinguish", "What it leaves out")
LINK = re.compile(r"\]\(([^):\s]+)\)")


def limits() -> str:
    """The whole page."""
    parts = [
        "# Known limits",
        "The first sentence of each; the link leads to the whole. Made by `python -m website.pages`.",
    ]
    for file in [README, *sorted((ROOT / "docs").rglob("*.md"))]:
        if file != ROOT / PAGE:
            parts += _of_page(file)
    parts += _of_papers()
    parts += ["## What tests expect to fail", "Each with the reason that the test states.", _xfails()]
    return "\n\n".join(parts) + "\n"


def papers() -> list[dict[str, str]]:
    """Rows of the table of the papers."""
    text = (ROOT / PAGE).with_name(PAPERS).read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines()))


def _of_papers() -> list[str]:
    """How many items of the papers are there, and those that are not, by name."""
    rows = papers()
    counts = Counter(row["state"] for row in rows)
    counted = ", ".join(f"{counts[state]} {state}" for state in STATES)
    named = {state: "; ".join(row["what"] for row in rows if row["state"] == state) for state in ("missing", "partly")}
    items = [
        f"- {len(rows)} items ([table]({PAPERS})): {counted}.",
        *(f"- {state.title()}: {what}." for state, what in named.items() if what),
    ]
    return ["## The five papers, item by item", "\n".join(items)]  # a heading with a link to a file has no place


def _of_page(file: Path) -> list[str]:
    text = file.read_text(encoding="utf-8")
    title = text.partition("\n")[0].removeprefix("# ")
    parts: list[str] = []
    for heading, body in sections(text):
        link = _relative(file, file.name) + "#" + heading.lower().replace(" ", "-")
        above = f"## All of {title}" if file == README else f"## [{title}]({link})"
        parts += [above, LINK.sub(lambda one: f"]({_relative(file, one[1])})", "\n".join(firsts(body)))]
    return parts


def firsts(body: str) -> list[str]:
    """Items with the first sentence of every paragraph and item; a table is left to its page."""
    found = []
    for block in re.split(r"\n\s*\n|\n(?=- )", body):
        text = " ".join(block.split()).removeprefix("- ")
        if text and not text.startswith("|"):
            sentence = re.match(r"(.*?\.)(?:\*\*)?(?= [A-Z*\[`]|$)", text)
            found.append("- " + (sentence[0] if sentence else text))
    return found


def sections(text: str) -> list[tuple[str, str]]:
    """Headings of a page that tell limits, and what stands below them, code left out."""
    found = re.findall(r"^## (.*)\n+((?:(?!## ).*\n)*)", text + "\n", re.MULTILINE)
    return [
        (heading, re.sub(r"```.*?```", "", body, flags=re.DOTALL).strip())
        for heading, body in found
        if heading in HEADINGS
    ]


def _relative(file: Path, target: str) -> str:
    """A link of a page as seen from the page of limits."""
    name, hash_, anchor = target.partition("#")
    there = (file.parent / name).resolve() if name else file
    place = there.relative_to(ROOT).as_posix()
    found = place.removeprefix("docs/reference/") if place.startswith("docs/reference/") else f"../../{place}"
    return found.replace("../../docs/", "../") + hash_ + anchor


def _xfails() -> str:
    by_file: dict[str, list[str]] = {}
    for place, reason in xfails():
        by_file.setdefault(place, []).append(reason)
    return "\n".join(f"- `{place}`: {'; '.join(reasons)}." for place, reasons in by_file.items())


def xfails() -> list[tuple[str, str]]:
    """File and reason of each mark and call of xfail; a reason that is put together is told by the names in it."""
    found: list[tuple[str, str]] = []
    for file in sorted((ROOT / "tests").rglob("test_*.py")):
        text = file.read_text(encoding="utf-8")
        if "xfail" not in text or file.parent.name == "website":
            continue
        tree = ast.parse(text)
        tables = {
            one.targets[0].id: one.value
            for one in tree.body
            if isinstance(one, ast.Assign) and isinstance(one.targets[0], ast.Name)
        }
        for one in ast.walk(tree):
            if isinstance(one, ast.Call) and ast.unparse(one.func).endswith("xfail"):
                reason = next(
                    (word.value for word in one.keywords if word.arg == "reason"), one.args[0] if one.args else None
                )
                found += [(file.relative_to(ROOT).as_posix(), words) for words in _reasons(reason, tables, text)]
    return list(dict.fromkeys(found))


def _reasons(reason: ast.expr | None, tables: dict[str, ast.expr], text: str) -> list[str]:
    """Words of a reason; of one that is looked up, the words of the whole table."""
    if isinstance(reason, ast.Constant):
        return [str(reason.value)]
    if isinstance(reason, ast.JoinedStr):
        return ["".join(str(part.value) if isinstance(part, ast.Constant) else "…" for part in reason.values)]
    if isinstance(reason, ast.Subscript) and isinstance(reason.value, ast.Name):
        return _words(tables.get(reason.value.id))
    if isinstance(reason, ast.Name):
        looped = re.search(rf"for \w+, {reason.id} in (\w+)\.items\(\)", text)
        return _words(tables.get(looped[1] if looped else reason.id))
    return []


def _words(table: ast.expr | None) -> list[str]:
    if isinstance(table, ast.Dict):
        return [word for value in table.values for word in _words(value)]
    return [str(table.value)] if isinstance(table, ast.Constant) else []
