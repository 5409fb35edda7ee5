"""Laboratories by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene

LABORATORIES: Mapping[str, Callable[[Rng, SyntheticScene], SyntheticScene]] = {
    "home": lambda _, scene: scene,
}
