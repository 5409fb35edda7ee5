"""A scene as a kind of laboratory records it, for tests."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic import LABORATORIES
from geocontact.gap_benchmark.synthetic.catalogue import SCENES
from geocontact.gap_benchmark.synthetic.plan import NotFoundError
from geocontact.gap_benchmark.synthetic.scene import SyntheticScene


def scene_of(kind: str, system: str, seed: int = 1) -> SyntheticScene:
    """The first draw of twenty that a laboratory takes."""
    for attempt in range(20):
        rng = np.random.default_rng([seed, attempt])
        try:
            return LABORATORIES[kind](rng, SCENES[system](rng, shifted=False))
        except NotFoundError:
            continue
    raise AssertionError("none of 20 draws")
