"""While tests run, shapes and types in the package's signatures are checked; kernels are left alone."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest
from jaxtyping import TypeCheckError

from geocontact.geometry.kernels.clip import fraction_below
from geocontact.geometry.topology import signed_volume
from tests.house.first_screens import ROOT

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


@pytest.mark.shapes
def test_a_wrong_shape_is_refused() -> None:
    assert signed_volume(TETRAHEDRON, FACES) == pytest.approx(1 / 6, rel=1e-15)
    with pytest.raises(TypeCheckError):
        signed_volume(TETRAHEDRON[:, :2], FACES)
    with pytest.raises(TypeCheckError):
        signed_volume(TETRAHEDRON, FACES.astype(float))


def test_kernels_are_not_wrapped() -> None:
    assert hasattr(fraction_below, "py_func"), "numba's own object, callable from other kernels"


def protocols(file: Path) -> list[ast.ClassDef]:
    classes = [node for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))) if isinstance(node, ast.ClassDef)]
    return [one for one in classes if any(ast.unparse(base).startswith("Protocol") for base in one.bases)]


def test_protocols_can_be_checked_while_tests_run() -> None:
    """Without `runtime_checkable` no module imports that has one in a signature, once shapes are checked."""
    found = [one for file in sorted((ROOT / "geocontact").rglob("*.py")) for one in protocols(file)]
    assert len(found) > 10
    assert [one.name for one in found if "runtime_checkable" not in map(ast.unparse, one.decorator_list)] == []
