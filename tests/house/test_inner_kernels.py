"""Kernels without wrappers for Python are named by kernels alone: a call from Python would end the process."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
KERNELS = ROOT / "geocontact/geometry/kernels"
BARE = {"inner", "lean"}
COMPILED = {"kernel", "part", *BARE}


def decorators(node: ast.stmt) -> set[str]:
    """Names above a function."""
    found = node.decorator_list if isinstance(node, ast.FunctionDef) else []
    return {each.id for each in found if isinstance(each, ast.Name)}


def inner_kernels(folder: Path) -> dict[str, set[str]]:
    """Names without a wrapper for Python, decorated with `inner` or `lean`, by module."""
    trees = {file.stem: ast.parse(file.read_text(encoding="utf-8")) for file in folder.glob("*.py")}
    return {
        stem: {node.name for node in tree.body if isinstance(node, ast.FunctionDef) and decorators(node) & BARE}
        for stem, tree in trees.items()
    }


PACKAGE = "geocontact.geometry.kernels"


def named_by_python(file: Path, inner: dict[str, set[str]]) -> set[str]:
    """Inner kernels that a file names outside of a compiled function, imports and their plain functions apart."""
    text = file.read_text(encoding="utf-8")
    if "kernels" not in text and file.parent.name != "kernels":
        return set()
    tree = ast.parse(text)
    own = inner.get(file.stem, set()) if file.parent.name == "kernels" else set()
    known, modules = {name: name for name in own}, dict[str, str]()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            modules |= _imported_modules(node)
            names = inner.get((node.module or "").rpartition(".")[2], set()) if _of_kernels(node) else set()
            known |= {alias.asname or alias.name: alias.name for alias in node.names if alias.name in names}
            if names and any(alias.name == "*" for alias in node.names):
                known |= {name: name for name in names}
        elif isinstance(node, ast.Import):
            modules |= {alias.asname or alias.name: alias.name for alias in node.names}
    found, attributes = set(), set[str]().union(*inner.values())
    plain = {id(each) for node in ast.walk(tree) if _plain(node) for each in ast.walk(node)}
    for node in (each for top in tree.body if not decorators(top) & COMPILED for each in ast.walk(top)):
        if id(node) in plain:
            continue
        if isinstance(node, ast.Name) and node.id in known:
            found.add(known[node.id])
        elif isinstance(node, ast.Attribute) and node.attr in attributes:
            found |= inner.get(_kernels_module(ast.unparse(node.value), modules), set()) & {node.attr}
    return found


def _plain(node: ast.AST) -> bool:
    """What numba has not compiled, where it compiles at all: `getattr(kernel, "py_func", kernel)`."""
    named = isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "getattr"
    return named and re.fullmatch(r"getattr\((\S+), 'py_func', \1\)", ast.unparse(node)) is not None


def _of_kernels(node: ast.ImportFrom) -> bool:
    """From a module of the kernels, by its whole name or from its neighbours."""
    return (node.module or "").startswith(f"{PACKAGE}.") or node.level > 0


def _imported_modules(node: ast.ImportFrom) -> dict[str, str]:
    """Names of what may be modules, and what these are called as a whole."""
    return {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}


def _kernels_module(words: str, modules: dict[str, str]) -> str:
    """Last name of the kernels' module that an expression is, \"\" for any other."""
    for name, whole in modules.items():
        if words == name or words.startswith(f"{name}."):
            words = whole + words.removeprefix(name)
            break
    return words.removeprefix(f"{PACKAGE}.") if words.startswith(f"{PACKAGE}.") else ""


def test_nothing_in_python_names_an_inner_kernel() -> None:
    inner = inner_kernels(KERNELS)
    assert sum(map(len, inner.values())) > 40
    files = [file for room in ("geocontact", "tests", "benchmarks", "meshes") for file in (ROOT / room).rglob("*.py")]
    found = {str(file): names for file in files if (names := named_by_python(file, inner))}
    assert not found


WAYS = {
    f"from {PACKAGE}.tree import nearest": "nearest",
    f"from {PACKAGE}.tree import nearest as n": "n",
    f"from {PACKAGE}.tree import *": "nearest",
    f"from {PACKAGE} import tree": "tree.nearest",
    f"from {PACKAGE} import tree as t": "t.nearest",
    f"import {PACKAGE}.tree": f"{PACKAGE}.tree.nearest",
    f"import {PACKAGE}.tree as t": "t.nearest",
    f"import {PACKAGE} as k": "k.tree.nearest",
    "from geocontact.geometry import kernels": "kernels.tree.nearest",
}
"""Imports, and what they call an inner kernel."""


@pytest.mark.parametrize(("head", "name"), WAYS.items())
def test_a_call_from_python_is_found(tmp_path: Path, head: str, name: str) -> None:
    """The check sees a call in a plain function, and none in a compiled one."""
    wrong, right = tmp_path / "wrong.py", tmp_path / "right.py"
    wrong.write_text(f"{head}\ndef f(x):\n    return {name}(x)\n", encoding="utf-8")
    right.write_text(f"{head}\n@kernel\ndef f(x):\n    return {name}(x)\n", encoding="utf-8")
    inner = inner_kernels(KERNELS)
    assert named_by_python(wrong, inner) == {"nearest"}
    assert named_by_python(right, inner) == set()


def test_other_modules_of_the_same_name_are_none(tmp_path: Path) -> None:
    file = tmp_path / "right.py"
    file.write_text("from geocontact.dynamics import tree\ndef f(x):\n    return tree.nearest(x)\n", encoding="utf-8")
    assert named_by_python(file, inner_kernels(KERNELS)) == set()
