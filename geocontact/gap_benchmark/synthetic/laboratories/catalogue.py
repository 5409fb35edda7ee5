"""Laboratories by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from geocontact.gap_benchmark.synthetic.laboratories.inputs import inputs_laboratory
from geocontact.gap_benchmark.synthetic.laboratories.placement import placement_laboratory
from geocontact.gap_benchmark.synthetic.laboratories.recorder import recorder_laboratory
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene

LABORATORIES: Mapping[str, Callable[[Rng, SyntheticScene], SyntheticScene]] = {
    "home": lambda _, scene: scene,
    "recorder": recorder_laboratory,
    "placement": placement_laboratory,
    "inputs": inputs_laboratory,
}
