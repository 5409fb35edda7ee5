"""Kernels without wrappers for Python are named by kernels alone: a call from Python would end the process."""

from __future__ import annotations

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KERNELS = ROOT / "geocontact/geometry/kernels"
COMPILED = {"kernel", "part", "inner"}


def decorators(node: ast.stmt) -> set[str]:
    """Names above a function."""
    found = node.decorator_list if isinstance(node, ast.FunctionDef) else []
    return {each.id for each in found if isinstance(each, ast.Name)}


def inner_kernels(folder: Path) -> dict[str, set[str]]:
    """Names decorated with `inner`, by module."""
    trees = {file.stem: ast.parse(file.read_text(encoding="utf-8")) for file in folder.glob("*.py")}
    return {
        stem: {node.name for node in tree.body if isinstance(node, ast.FunctionDef) and "inner" in decorators(node)}
        for stem, tree in trees.items()
    }


def named_by_python(file: Path, inner: dict[str, set[str]]) -> set[str]:
    """Inner kernels that a file names outside of a compiled function, imports for those apart."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    known = set(inner.get(file.stem, set())) if file.parent.name == "kernels" else set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("geocontact.geometry.kernels."):
            known |= {alias.name for alias in node.names} & inner.get((node.module or "").rpartition(".")[2], set())
    plain = [node for node in tree.body if not decorators(node) & COMPILED]
    return {each.id for node in plain for each in ast.walk(node) if isinstance(each, ast.Name)} & known


def test_nothing_in_python_names_an_inner_kernel() -> None:
    inner = inner_kernels(KERNELS)
    assert sum(map(len, inner.values())) > 40
    files = [file for room in ("geocontact", "tests", "benchmarks", "meshes") for file in (ROOT / room).rglob("*.py")]
    found = {str(file): names for file in files if (names := named_by_python(file, inner))}
    assert not found


def test_a_call_from_python_is_found(tmp_path: Path) -> None:
    """The check sees a call in a plain function, and none in a compiled one."""
    head = "from geocontact.geometry.kernels.tree import nearest\n"
    wrong, right = tmp_path / "wrong.py", tmp_path / "right.py"
    wrong.write_text(f"{head}def f(x):\n    return nearest(x)\n", encoding="utf-8")
    right.write_text(f"{head}@kernel\ndef f(x):\n    return nearest(x)\n", encoding="utf-8")
    inner = inner_kernels(KERNELS)
    assert named_by_python(wrong, inner) == {"nearest"}
    assert named_by_python(right, inner) == set()
