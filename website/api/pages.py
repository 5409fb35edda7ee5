"""All pages of the reference of functions, and their index."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

from website.api.docstring import cell, parts
from website.api.entries import CHAIN, GROUPS, JOBS, UNITS, Entry, entries
from website.api.page import anchors, page

ROOT = Path(__file__).resolve().parents[2]
FOLDER = "docs/reference/api"
OWN_MODEL = ROOT / "docs" / "how-to" / "own_model.md"
FIRST = {
    "Jobs": "One function for every job of the command line. Each returns a result: see [gc.Result](Result.md).",
    "Functions": "What the jobs are made of, for work of one's own.",
    "Types": "What functions take and give.",
    "Models of one's own": "What a base model of one's own, and an effect of one's own, are written with: "
    "[a model of your own](../../how-to/own_model.md).",
    "Units": "Values enter in SI, or through these.",
}


def api_pages() -> dict[str, str]:
    """Place and text of each, from the repository's root."""
    known = entries()
    spoken = _spoken_of()
    single = [entry for entry in known if entry.group != UNITS]
    found: dict[str, str] = {}
    for entry in single:
        read_more = spoken.get(entry.name, []) or ([_link(OWN_MODEL)] if entry.group == CHAIN else [])
        found[f"{FOLDER}/{entry.name}.md"] = page(entry, read_more, _theory(read_more, entry.group))
    found[f"{FOLDER}/units.md"] = _units([entry for entry in known if entry.group == UNITS])
    found[f"{FOLDER}/index.md"] = _index(known)
    return found


def _index(known: list[Entry]) -> str:
    lines = ["# Functions", "One page for each public name of `import geocontact as gc`, made from the docstrings."]
    names = []
    for group in GROUPS:
        lines += [f"## {group}", FIRST[group]]
        rows = []
        for entry in (one for one in known if one.group == group):
            place = "units" if group == UNITS else entry.name
            names.append(place)
            first = parts(entry.docstring).words if group != UNITS else [repr(entry.thing)[1:-1]]
            rows.append(f"| [gc.{entry.name}]({place}.md) | {cell(' '.join((first or [''])[0].split()))} |")
        lines.append("\n".join(["| name | what it is |", "|---|---|", *rows]))
    told = "\n".join(f"/{FOLDER}/{name}" for name in dict.fromkeys(names))
    return "\n\n".join([*lines, f"```{{toctree}}\n:hidden:\n\n{told}\n```"]) + "\n"


def _units(known: list[Entry]) -> str:
    from geocontact.data import units

    rows = [f"| `gc.{one.name}` | {cell(one.thing.name)} | {one.thing.si} | {one.thing.factor!r} |" for one in known]
    lines = ["# Units", parts(inspect.getdoc(units) or "").words[0], "```python\n" + known[0].example + "\n```"]
    return "\n\n".join([*lines, "\n".join(["| name | unit | gives | factor |", "|---|---|---|---|", *rows])]) + "\n"


def _theory(read_more: list[tuple[str, str]], group: str) -> list[tuple[str, str]]:
    """Pages of the theory that the pages name which tell how a job is done; types and functions name their own."""
    if group not in {JOBS, CHAIN}:
        return []
    found: dict[tuple[str, str], None] = {}
    for _, link in read_more:
        file = ROOT / link.removeprefix("../" * (FOLDER.count("/") + 1))
        if file.parent.name == "how-to" or file.name == "tutorial.md":
            targets = re.findall(r"\]\((?:\.\./)?(theory/\w+\.md)", file.read_text(encoding="utf-8"))
            found |= {_link(ROOT / "docs" / target): None for target in targets}
    return list(found)


def _link(file: Path) -> tuple[str, str]:
    """Title and link of a page."""
    title = file.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ")
    return title, "../" * (FOLDER.count("/") + 1) + file.relative_to(ROOT).as_posix()


def _spoken_of() -> dict[str, list[tuple[str, str]]]:
    """Title and link of the pages that write a name with its `gc.`; of jobs, also those that README names for them."""
    found: dict[str, list[tuple[str, str]]] = {}

    def add(names: list[str], file: Path) -> None:
        for name in dict.fromkeys(names):
            if _link(file) not in found.setdefault(name, []):
                found[name].append(_link(file))

    for row in (ROOT / "README.md").read_text(encoding="utf-8").splitlines():
        names = _jobs(row)
        for target in re.findall(r"\]\((docs/[^)#]+\.md)", row) if row.startswith("|") else ():
            add(names, ROOT / target)
    for file in sorted((ROOT / "docs").rglob("*.md")):
        add(anchors(file.read_text(encoding="utf-8")), file)
    return found


def _jobs(row: str) -> list[str]:
    """Names of a row of README's table of jobs, where `.identify` after `gc.misalignment.simulate` is short."""
    names: list[str] = []
    here = ""
    for room, name, short in re.findall(r"`(?:gc\.(?:(\w+)\.)?(\w+)|\.(\w+))`", row):
        here = room or here if short else room
        names.append(f"{here}.{short or name}" if here else name)
    return names
