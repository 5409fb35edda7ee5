"""A case of the rigid foot from what finer code shows: near it until a fulcrum moves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.prosthesis.gap import gathered, off_of
from benchmarks.prosthesis.refit import fulcrum
from benchmarks.prosthesis.truth import FootPath, Truth, Withheld, measure
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot


@pytest.mark.slow
def test_a_rigid_foot_follows_until_the_fulcrum_moves(tmp_path: Path) -> None:
    """A foot that rolls under load, its stiffness held as it was found before."""
    time = np.arange(0.0, 0.6, 4e-3)
    share = time / 0.6
    pitch = 0.2 - 0.4 * share
    lowest = np.where(pitch > 0.0, 0.03, 0.03 + 0.22 * -np.sin(pitch))
    height = lowest + 0.003 - 0.013 * np.sin(np.pi * share) ** 2
    path, foot = FootPath(time, np.column_stack([0.1 * share, height, pitch])), vsf_foot(joints=24, finer=4)
    made = {
        kind: {name: measure(Truth(foot, fulcrum(), each), path, k) for k, name in enumerate(("t01", "t02"))}
        for kind, each in (("before", Withheld()), ("since", Withheld(fulcrum=0.02)))
    }
    off = {
        kind: off_of(gathered(tmp_path / kind, trials, held=made["before"], uses=(("t01",), ("t02",))))
        for kind, trials in made.items()
    }
    assert off["before"]["force_y_N"] < 40.0 and off["before"]["cop_x_mm"] < 8.0
    assert off["since"]["force_y_N"] > 2.0 * off["before"]["force_y_N"]
