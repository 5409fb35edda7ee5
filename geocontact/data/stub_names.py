"""Names of a package from its stub, imported when they are asked for, so that importing the package stays light."""

from __future__ import annotations

import ast
from collections.abc import Callable
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any


def names_of_stub(package: ModuleType) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """`__getattr__`, `__dir__` and `__all__` of a package: what the `__init__.pyi` beside its `__init__.py` imports.

    A type checker reads the same file, so that there is one list. It holds `from module import name, …` by absolute
    names; without it, as with an `import geocontact` from an archive, ImportError says so.
    """
    places = stub_places(Path(str(package.__file__)).with_suffix(".pyi"))

    def get(name: str) -> Any:
        if name not in places:
            raise AttributeError(f"module {package.__name__!r} has no attribute {name!r}")
        inside = vars(import_module(places[name]))
        return inside[name] if name in inside else import_module(f"{places[name]}.{name}")

    def names() -> list[str]:
        return sorted({*(name for name in vars(package) if name.startswith("__")), *places})

    return get, names, sorted(places)


@cache
def stub_places(stub: Path) -> dict[str, str]:
    """Module of every name that a stub imports."""
    try:
        tree = ast.parse(stub.read_text(encoding="utf-8"))
    except OSError as error:
        raise ImportError(f"{stub} is missing; install the package anew") from error
    lines = [line for line in tree.body if isinstance(line, ast.ImportFrom) and line.module]
    return {alias.name: str(line.module) for line in lines for alias in line.names}
