"""Laboratories by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from geocontact.gap_benchmark.synthetic.laboratories.inputs import inputs_laboratory
from geocontact.gap_benchmark.synthetic.laboratories.kinds import LABORATORY_KINDS
from geocontact.gap_benchmark.synthetic.laboratories.of_kind import laboratory_of_kind
from geocontact.gap_benchmark.synthetic.laboratories.placement import placement_laboratory
from geocontact.gap_benchmark.synthetic.laboratories.recorder import recorder_laboratory
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene

LABORATORIES: Mapping[str, Callable[[Rng, SyntheticScene], SyntheticScene]] = {
    "home": lambda _, scene: scene,
    "recorder": recorder_laboratory,
    "placement": placement_laboratory,
    "inputs": inputs_laboratory,
    **{name: partial(laboratory_of_kind, kind=kind) for name, kind in LABORATORY_KINDS.items()},
}
