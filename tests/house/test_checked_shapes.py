"""While tests run, shapes and types in the package's signatures are checked; kernels are left alone."""

from __future__ import annotations

import numpy as np
import pytest
from jaxtyping import TypeCheckError

from geocontact.geometry.kernels.clip import fraction_below
from geocontact.geometry.topology import signed_volume

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
