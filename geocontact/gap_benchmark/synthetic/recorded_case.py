"""The case that somebody would hand in: what was recorded, and nothing of what was injected."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geocontact.data.gap.case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial as CaseTrial
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import SyntheticTrial


def case_of(
    rng: Rng, scene: SyntheticScene, recordings: Sequence[SyntheticTrial], learn: int, name: str
) -> tuple[GapCase, tuple[str, ...]]:
    """The recordings as a case that does not tell what was injected."""
    trials = []
    for i, one in enumerate(recordings):
        outputs = one.outputs.copy()
        for row in scene.body.patchy:
            if rng.random() < 0.1:
                outputs[row, rng.random(outputs.shape[1]) < 0.02] = np.nan
        values = np.column_stack([*one.inputs, *outputs])
        signals = Signals(one.time, values, (*scene.inputs, *scene.outputs), scene.units)
        trials.append(CaseTrial(f"t{i + 1:02d}", signals, one.setting))
    known = {c: noise.sd for c, noise in zip(scene.outputs, scene.noise, strict=True)}
    lot = rng.random()
    if lot < 0.25:
        known = {}
    elif lot < 0.4:
        known = {c: sd for c, sd in known.items() if rng.random() < 0.5}
    case = GapCase(
        name,
        scene.system,
        tuple(trials[:learn]),
        tuple(trials[learn:]),
        scene.parameters,
        scene.constants,
        known,
        scene.tables,
    )
    return case, tuple(one.name for one in trials)
