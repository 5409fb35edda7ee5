"""Where nothing may be compiled the package is slow, and its areas are the same."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from geocontact.geometry.kernels.clip import fraction_below

CUBES = """
import numpy as np, trimesh, geocontact as gc
from scipy.spatial.transform import RigidTransform
box = trimesh.creation.box((0.01, 0.01, 0.01))
cube = gc.Surface(np.array(box.vertices), np.array(box.faces))
above = gc.Motion(np.zeros(1), RigidTransform.from_translation([[0.0, 0.012, 0.0]]))
found = gc.area_evolution(cube, cube, above, gc.Settings(thresholds=(0.004,), rule="clip"), workers=1)
print(float(1e6 * found.fixed.area[0, 0]))
"""


def test_areas_need_no_compiler() -> None:
    """A cube of 10 mm 2 mm above another: within 4 mm of it are the upper face and the upper 2 mm of four sides."""
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-W", "error", "-c", CUBES]
    done = subprocess.run(command, check=False, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) == pytest.approx(100.0 + 4 * 10.0 * 2.0, rel=1e-6)


@pytest.mark.parametrize(
    ("values", "share"), [((-1, -1, 3), 0.4375), ((-1, 1, 1), 0.25), ((-1, -1, -1), 1.0), ((1, 2, 3), 0.0)]
)
def test_share_below_of_arrays_elements(values: tuple[float, ...], share: float) -> None:
    """By similar triangles: beyond a corner of value 3 beside two of -1 lies (3/4)^2 of the area."""
    plain = getattr(fraction_below, "py_func", fraction_below)
    for order in (0, 1, 2):
        assert plain(*np.roll(np.array(values, float), order)) == pytest.approx(share)
