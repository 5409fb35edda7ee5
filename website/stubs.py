"""Write the stubs that say which names packages have: `python -m website.stubs`.

Names of analyses follow the catalogue. What else `geocontact/__init__.pyi` imports stays as it is: a further public
name is a line there, and this puts it in its place and into `__all__`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from geocontact.analyses.catalogue import ENTRIES, GROUPS, HOME, names_of_room
from geocontact.data.stub_names import stub_places

ROOT = Path(__file__).resolve().parents[1]
WIDTH = 120
FRONT = "geocontact/__init__.pyi"
HEAD = '"""Names of `{}`; those of analyses are written by `python -m website.stubs`."""'


def main() -> None:
    """Write those that are not as they should be."""
    for name, text in stubs(ROOT).items():
        (ROOT / name).write_text(text, encoding="utf-8")


def stubs(root: Path) -> dict[str, str]:
    """Text of each stub by its place in a checkout."""
    rooms = sorted({group.room for group in GROUPS if group.room})
    found = {FRONT: stub("geocontact", front(root, rooms), ("__version__: str",))}
    for room in rooms:
        places = {each.name: each.module for each in ENTRIES if each.room == room and each.exported}
        found[f"{HOME.replace('.', '/')}/{room}/__init__.pyi"] = stub(f"{HOME}.{room}", places)
    return found


def front(root: Path, rooms: Sequence[str]) -> dict[str, str]:
    """Module of each name of `geocontact`: analyses and rooms of the catalogue, and what the stub has besides."""
    of_analyses = {HOME, *(each.module for each in ENTRIES)}
    had = {
        name: module
        for name, module in stub_places(root / FRONT).items()
        if module not in of_analyses and there(root, module)
    }
    analyses = {each.name: each.module for each in ENTRIES if each.exported and not each.room}
    return had | dict.fromkeys(rooms, HOME) | {name: analyses[name] for name in names_of_room("")}


def there(root: Path, module: str) -> bool:
    """Whether a checkout has a module or a package of that name."""
    place = root / module.replace(".", "/")
    return place.is_dir() or place.with_suffix(".py").is_file()


def stub(package: str, places: Mapping[str, str], more: Sequence[str] = ()) -> str:
    """A stub that imports every name from its module, in the order that ruff asks for."""
    names = sorted(places, key=order)
    modules = sorted(set(places.values()))
    lines = [HEAD.format(package), ""]
    lines += [imported(module, [name for name in names if places[name] == module]) for module in modules]
    lines += ["", *(f"{line}\n" for line in more), listed(names)]
    return "\n".join(lines) + "\n"


def imported(module: str, names: Sequence[str]) -> str:
    """A line that imports, one for each name where it would be too long."""
    line = f"from {module} import {', '.join(names)}"
    return line if len(line) <= WIDTH else "\n".join([f"from {module} import (", *(f"    {n}," for n in names), ")"])


def listed(names: Sequence[str]) -> str:
    """`__all__`, in one line where that is short enough."""
    line = "__all__ = [" + ", ".join(f'"{name}"' for name in names) + "]"
    return line if len(line) <= WIDTH else "\n".join(["__all__ = [", *(f'    "{name}",' for name in names), "]"])


def order(name: str) -> tuple[int, str]:
    """Constants, classes, and all else, each in order of the alphabet."""
    return (0 if name.isupper() and len(name) > 1 else 1 if name[:1].isupper() else 2), name


if __name__ == "__main__":
    main()
