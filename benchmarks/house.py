"""Measure how the package is laid out: `python -m benchmarks.house [FOLDER] [--keep NAME]`.

Lines are those of code, of imports, of docstrings (of modules, classes and functions, with the blank lines inside of
them), of comments alone, and blank; each line counts once. An analysis is a folder with `options.py`; its files are
those below it, `__init__.py` among them. A circle is a set of neighbours in one folder, modules or packages, that
import each other, by way of whatever lies inside of them. An import runs upwards where the contract of layers in
`pyproject.toml` says so, and where the package imports what stands beside it: benchmarks, samples, tests, web site.
Files of a new analysis are those that `benchmarks.new_analysis` touches.
"""

from __future__ import annotations

import argparse
import ast
import sys
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from benchmarks.machine import ROOT, write_results
from benchmarks.new_analysis import touched

PACKAGE = "geocontact"
BESIDE = ("benchmarks", "meshes", "tests", "website")
LAYERS = "Rooms know only the rooms below them"
FEW = 20  # lines of code: files with fewer are counted
KINDS = ("code", "imports", "docstrings", "comments", "blank")
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
DOCUMENTED = (ast.Module, ast.ClassDef, *FUNCTIONS)
Edges = Mapping[str, frozenset[str]]


@dataclass(frozen=True)
class Module:
    """One file: lines of each of `KINDS`, modules that it imports, functions whose signature names `Record`."""

    name: str
    lines: Mapping[str, int]
    imports: frozenset[str]
    with_record: int

    @property
    def small(self) -> bool:
        return self.lines["code"] < FEW


def main() -> int:
    """Exit code 0; prints a markdown table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=ROOT, help="checkout that is measured (%(default)s)")
    parser.add_argument("--keep", metavar="NAME", help="also write benchmarks/results/NAME.json")
    given = parser.parse_args()
    found = measured(given.folder)
    print(table(found))
    if given.keep:
        write_results(given.keep, {"folder": PACKAGE, "few": FEW}, found)
    return 0


def measured(root: Path) -> dict[str, object]:
    """Figures of a checkout by name."""
    package = modules(root, PACKAGE)
    beside = {name: modules(root, name) for name in BESIDE if (root / name).is_dir()}
    lines = {kind: sum(each.lines[kind] for each in package) for kind in KINDS}
    every = sum(lines.values())
    files = files_of_analyses(root / PACKAGE / "analyses")
    counts = sorted(files.values())
    everything = [*package, *(each for some in beside.values() for each in some)]
    edges = resolved(everything)
    benchmarks = [each.name for each in beside.get("benchmarks", ())]
    new = touched(root)
    return {
        "modules": len(package),
        "lines": every,
        "lines_by_kind": lines,
        "small_files": sum(each.small for each in package) / len(package),
        "import_lines": lines["imports"] / every,
        "files_of_analyses": files,
        "files_of_an_analysis": {"least": counts[0], "median": median(counts), "most": counts[-1]} if counts else None,
        "files_of_a_new_analysis": None if new is None else vars(new),
        "functions_with_record": sum(each.with_record for each in package),
        "functions_with_record_outside_the_frame": sum(e.with_record for e in package if not of_the_frame(e.name)),
        "circles": [sorted(some) for some in circles([each.name for each in package], edges)],
        "circles_of_benchmarks": [sorted(some) for some in circles(benchmarks, edges)],
        "upward_imports": upward(edges, layers(root)),
    }


def table(found: Mapping[str, object]) -> str:
    """The figures as markdown."""
    kinds, each = found["lines_by_kind"], found["files_of_an_analysis"]
    of_one = "none" if each is None else f"{each['least']} to {each['most']}, median {each['median']:g}"  # type: ignore[index]
    rows = {
        f"modules in `{PACKAGE}/`": f"{found['modules']}",
        "lines in all, of code": f"{found['lines']}, {kinds['code']}",  # type: ignore[index]
        f"files with fewer than {FEW} lines of code": f"{found['small_files']:.1%}",
        "import lines": f"{found['import_lines']:.1%}",
        "files of an analysis": of_one,
        "files of a new analysis, of these only its name": of_a_new_one(found["files_of_a_new_analysis"]),
        "functions with `Record`, outside the frame": "{}, {}".format(
            found["functions_with_record"], found["functions_with_record_outside_the_frame"]
        ),
        "circles, those of `benchmarks/`": f"{len(found['circles'])}, {len(found['circles_of_benchmarks'])}",  # type: ignore[arg-type]
        "upward imports": f"{len(found['upward_imports'])}",  # type: ignore[arg-type]
    }
    return "\n".join(["| | |", "|---|---|", *(f"| {name} | {value} |" for name, value in rows.items())])


def of_a_new_one(files: Mapping[str, Sequence[str]] | None) -> str:
    """Files that a new analysis touches, and how many of them hold nothing but its name."""
    if files is None:
        return "not measured"
    every = len(files["by_hand"]) + len(files["by_script"])
    return f"{every}, one of them by a script; {len(files['name_alone'])}"


def modules(root: Path, folder: str) -> list[Module]:
    """Every module below a folder of a checkout."""
    return [module(file, root) for file in sorted((root / folder).rglob("*.py"))]


def module(file: Path, root: Path) -> Module:
    """What one file holds."""
    text = file.read_text(encoding="utf-8")
    tree = ast.parse(text)
    parts = file.relative_to(root).with_suffix("").parts
    name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
    kinds = [kind_of(line) for line in text.splitlines()]
    imports: set[str] = set()
    with_record = 0
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            kinds[node.lineno - 1 : node.end_lineno] = ["imports"] * ((node.end_lineno or 0) - node.lineno + 1)
            imports |= imported(node)
        elif isinstance(node, DOCUMENTED) and ast.get_docstring(node) is not None:
            words = node.body[0]
            kinds[words.lineno - 1 : words.end_lineno] = ["docstrings"] * ((words.end_lineno or 0) - words.lineno + 1)
        if isinstance(node, FUNCTIONS):
            with_record += takes_record(node)
    return Module(name, {kind: kinds.count(kind) for kind in KINDS}, frozenset(imports), with_record)


def kind_of(line: str) -> str:
    """Kind of a line as it stands, without what is around it."""
    text = line.strip()
    return "blank" if not text else "comments" if text.startswith("#") else "code"


def imported(node: ast.Import | ast.ImportFrom) -> set[str]:
    """Modules, and what may be modules, that a statement imports."""
    if isinstance(node, ast.Import):
        return {alias.name for alias in node.names}
    return {f"{node.module}.{alias.name}" for alias in node.names}


def takes_record(node: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Whether an argument's annotation names `Record`."""
    a = node.args
    every = [*a.posonlyargs, *a.args, *a.kwonlyargs, *(one for one in (a.vararg, a.kwarg) if one)]
    notes = [ast.walk(one.annotation) for one in every if one.annotation is not None]
    return any(isinstance(part, ast.Name) and part.id == "Record" for note in notes for part in note)


def of_the_frame(name: str) -> bool:
    """Modules of `analyses` that belong to no single analysis: those in its own folder and in `frame`."""
    room, _, rest = name.removeprefix(f"{PACKAGE}.").partition(".")
    return room == "analyses" and ("." not in rest or rest.startswith("frame."))


def files_of_analyses(folder: Path) -> dict[str, int]:
    """Files of each folder that has options, less those of analyses inside of it; the frame is no analysis."""
    frame = (folder, folder / "frame")
    homes = sorted(file.parent for file in folder.rglob("options.py") if file.parent not in frame)
    of_home = {home: set(home.rglob("*.py")) for home in homes}
    for home in homes:
        for inside in homes:
            if home in inside.parents:
                of_home[home] -= of_home[inside]
    return {home.relative_to(folder).as_posix(): len(files) for home, files in of_home.items()}


def resolved(every: Iterable[Module]) -> dict[str, frozenset[str]]:
    """What each module imports of all these modules; a name is looked for as a module, else where it comes from."""
    every = list(every)
    names = {each.name for each in every}

    def known(name: str) -> set[str]:
        found = {name, name.rpartition(".")[0]} & names
        return {max(found, key=len)} if found else set()

    return {each.name: frozenset(set().union(*map(known, each.imports)) - {each.name}) for each in every}


def circles(names: Iterable[str], edges: Edges) -> list[set[str]]:
    """Sets of neighbours that import each other, by way of what lies inside of them."""
    below: dict[tuple[str, ...], dict[str, set[str]]] = {}
    names = set(names)
    for name in names:
        for other in edges[name] & names:
            a, b = name.split("."), other.split(".")
            depth = next((k for k, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), None)
            if depth is not None:
                home = tuple(a[:depth])
                below.setdefault(home, {}).setdefault(".".join(a[: depth + 1]), set()).add(".".join(b[: depth + 1]))
    return [some for graph in below.values() for some in knots(graph)]


def knots(graph: Mapping[str, set[str]]) -> list[set[str]]:
    """Sets of more than one node that reach each other (Warshall's closure: graphs are small)."""
    nodes = sorted({*graph, *(other for some in graph.values() for other in some)})
    reach = {node: set(graph.get(node, ())) for node in nodes}
    for middle in nodes:
        for node in nodes:
            if middle in reach[node]:
                reach[node] |= reach[middle]
    found: list[set[str]] = []
    for node in nodes:
        if node in reach[node] and not any(node in some for some in found):
            found.append({other for other in reach[node] if node in reach[other]})
    return found


def layers(root: Path) -> dict[str, int]:
    """Layer of each room, the lowest 0, as `pyproject.toml` has them."""
    linter = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    every = next(one["layers"] for one in linter["contracts"] if one["name"] == LAYERS)
    height = {}
    for level, line in enumerate(reversed(every)):
        height |= {room.strip(" ()"): level for room in line.replace("|", ":").split(":")}
    return height


def upward(edges: Edges, height: Mapping[str, int]) -> list[str]:
    """Imports of the package from a higher room, or from beside the package."""
    found = []
    for name in sorted(edges):
        top, _, rest = name.partition(".")
        room = rest.partition(".")[0]
        for other in sorted(edges[name]) if top == PACKAGE else ():
            theirs, _, their_rest = other.partition(".")
            their_room = their_rest.partition(".")[0]
            higher = room in height and height.get(their_room, 0) > height[room]
            if theirs != PACKAGE or higher:
                found.append(f"{name} -> {other}")
    return found


if __name__ == "__main__":
    sys.exit(main())
