"""The version of one analysis' code: the modules of the package that it can import, and its libraries.

A change elsewhere in the package leaves it as it is. The modules are found by reading sources, not by running them: all
imports count, those inside functions too, and modules that a text names ("misalignment.law_numbers:numbers").
"""

from __future__ import annotations

import ast
import hashlib
import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, packages_distributions, version
from importlib.util import find_spec
from pathlib import Path

PACKAGE = "geocontact"
NAMED = re.compile(r"([a-z_]\w*(?:\.\w+)*):\w+|(geocontact(?:\.\w+)+)")
"""A text that names a module: with what is in it, or in full."""
WITHIN = ("", f"{PACKAGE}.analyses.")
"""What such a name starts from."""
READ_FROM_FILES = {f"{PACKAGE}.systems.python_model": f"{PACKAGE}.systems"}
"""A module that imports what a user's file names, and the package whose modules that may be."""
APART = (f"{PACKAGE}.data.version",)
"""The number of a release computes nothing."""
DATA = (".csv", ".css", ".html", ".js", ".json", ".toml")
"""Files beside modules that these read."""


@dataclass(frozen=True)
class _Module:
    """What the source of a module says.

    Parameters
    ----------
    imports
        Names that it may import: modules, and what stands in them.
    texts
        Names of modules that texts in it hold.
    """

    imports: frozenset[str]
    texts: frozenset[str]


class CodeSources:
    """The sources of packages.

    Parameters
    ----------
    folders
        Where packages are, by name; others where Python finds them.
    """

    def __init__(self, **folders: Path) -> None:
        self._folders: dict[str, Path | None] = dict(folders)

    def file_of(self, name: str) -> Path | None:
        """The source of a module; None for what is none, and for packages without a source of their own."""
        top, _, rest = name.partition(".")
        folder = self._folder(top)
        if folder is None:
            return None
        if folder.suffix == ".py":
            return None if rest else folder
        place = folder.joinpath(*rest.split(".")) if rest else folder
        found = (place / "__init__.py", place.with_suffix(".py"))
        return next((file for file in found if file.is_file()), None)

    def _folder(self, top: str) -> Path | None:
        if top not in self._folders:
            try:
                spec = find_spec(top)
            except (ImportError, ValueError):
                spec = None
            places = list(spec.submodule_search_locations or ()) if spec else []
            source = Path(spec.origin) if spec and spec.origin and spec.origin.endswith(".py") else None
            self._folders[top] = Path(places[0]) if places else source
        return self._folders[top]

    def closure(self, module: str) -> tuple[dict[str, Path], set[str]]:
        """Modules that a module can import, with their files, but for those of distributions, which are libraries.

        Its own package and this one count although distributions may have them.
        """
        own = {PACKAGE, module.partition(".")[0]}
        found: dict[str, Path] = {}
        libraries: set[str] = set()
        waiting = [module]
        while waiting:
            name = waiting.pop()
            file = self.file_of(name)
            if name in found or name in APART or file is None:
                continue
            found[name] = file
            told = _read(file, name, file.stat().st_mtime_ns)
            tops = {each.partition(".")[0] for each in told.imports}
            own |= {each for each in tops - own - libraries if self._is_loose(each)}
            libraries |= tops - own
            waiting += [each for each in (*_parents(name), *told.texts) if each.partition(".")[0] in own]
            waiting += [each for each in told.imports if each.partition(".")[0] in own]
            waiting += self._all_of(READ_FROM_FILES.get(name, ""))
        return found, libraries - set(sys.stdlib_module_names)

    def _is_loose(self, top: str) -> bool:
        """Whether sources are there that are of no distribution, whose version would say that they changed."""
        if top in sys.stdlib_module_names or top in _distributions():
            return False
        return self._folder(top) is not None

    def _all_of(self, package: str) -> Iterator[str]:
        if not package:
            return
        file = self.file_of(package)
        for each in file.parent.rglob("*.py") if file else ():
            parts = each.relative_to(file.parent).with_suffix("").parts if file else ()
            yield ".".join((package, *(part for part in parts if part != "__init__")))

    def digest(self, module: str) -> str:
        """Digest of these modules and of the data beside them: 32 hexadecimal digits."""
        modules, _ = self.closure(module)
        found = hashlib.sha256()
        for name, file in sorted({**modules, **_data(modules)}.items()):
            found.update(f"{name}\0{hashlib.sha256(file.read_bytes()).hexdigest()}\0".encode())
        return found.hexdigest()[:32]


def _package(name: str, file: Path) -> str:
    """The package that a module is in, or is; "" where it is in none."""
    return name if file.name == "__init__.py" else name.rpartition(".")[0]


def _parents(name: str) -> Iterator[str]:
    while "." in name:
        name = name.rpartition(".")[0]
        yield name


def _data(modules: dict[str, Path]) -> dict[str, Path]:
    """Data in the folders of packages, and one folder below where that is none.

    Beside a module that is in no package stand others' files too, such as results of studies: those that it names.
    """
    folders = {file.parent: home for name, file in modules.items() if (home := _package(name, file))}
    found = {}
    for name, file in ((name, file) for name, file in modules.items() if not _package(name, file)):
        source = file.read_bytes()
        beside = (each for each in file.parent.iterdir() if each.suffix in DATA and each.is_file())
        found.update({f"{name}/{each.name}": each for each in beside if each.name.encode() in source})
    for folder, name in folders.items():
        below = [each for each in folder.iterdir() if each.is_dir() and not any(each.glob("*.py"))]
        for file in (each for place in (folder, *below) for each in place.iterdir()):
            if file.suffix in DATA and file.is_file():
                found[f"{name}/{file.relative_to(folder).as_posix()}"] = file
    return found


@cache
def _read(file: Path, name: str, changed: int) -> _Module:
    """Read a source that was changed at that time; what only type checkers see does not count."""
    imports: set[str] = set()
    texts: set[str] = set()
    waiting: list[ast.AST] = [ast.parse(file.read_bytes())]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
            waiting += node.orelse
            continue
        if isinstance(node, ast.Import):
            imports |= {each.name for each in node.names}
        elif isinstance(node, ast.ImportFrom):
            home = _absolute(node, name, file.name == "__init__.py")
            imports |= {home, *(f"{home}.{each.name}" for each in node.names)}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            texts |= set(_named(node.value, name))
        waiting += ast.iter_child_nodes(node)
    return _Module(frozenset(imports), frozenset(texts))


def _absolute(node: ast.ImportFrom, name: str, package: bool) -> str:
    """Name of the module that is imported from."""
    if not node.level:
        return node.module or ""
    parts = name.split(".")
    home = parts[: len(parts) - node.level + package]
    return ".".join((*home, node.module) if node.module else home)


def _named(text: str, name: str) -> Iterator[str]:
    """Modules that a text may name; a package names its own by their last word as well, where it imports late."""
    if match := NAMED.fullmatch(text):
        yield from (f"{start}{match[1] or match[2]}" for start in WITHIN)
    elif text.isidentifier():
        yield f"{name}.{text}"


@cache
def _distributions() -> Mapping[str, list[str]]:
    return packages_distributions()


@cache
def code_version(module: str) -> dict[str, object]:
    """Digest of the code that a module can import, and the versions of its libraries."""
    sources = CodeSources()
    _, libraries = sources.closure(module)
    known = _distributions()
    names = sorted({known.get(each, [each])[0] for each in libraries})
    return {"code": sources.digest(module), "libraries": {name: _version(name) for name in names}}


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "not installed"
