"""A laboratory where, in every trial, things sit about a millimetre or half a degree elsewhere.

Constants and zeros of inputs vary from trial to trial as base parameters do, and so do gain and zero of a channel.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import Path
from geocontact.gap_benchmark.synthetic.laboratories.elsewhere import Sizes, another_device, sampled, sizes
from geocontact.gap_benchmark.synthetic.laboratory import Placement
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import samples
from geocontact.gap_benchmark.synthetic.visibility import placed, varied

LENGTH, ANGLE = 1e-3, np.radians(0.5)
"""Standard deviation of a length [m], of an angle [rad]."""
INPUT_ZERO = 0.01
"""Of the zero of an input that is neither, as a share of its range."""
GAIN, ZERO = 0.01, 0.005
"""Of the gain of an output [-]; of its zero, as a share of its range."""
CAREFUL, CARELESS = 0.7, 1.3
"""Laboratories differ: range of the factor on all of these."""
SEEN = 0.05
"""Root mean square change of an output, as a share of its largest magnitude, that somebody would see."""
FLAG = "-"
"""Unit of an input that has no zero that could be off."""


def placement_laboratory(rng: Rng, scene: SyntheticScene) -> SyntheticScene:
    """The scene, placed anew in every trial."""
    scene = another_device(rng, scene)
    size, care = sizes(scene, scene.path(rng, 0)), rng.uniform(CAREFUL, CARELESS)
    placement = noticed(scene, scene.path(rng, 0), placement_of(scene, size, care))
    return sampled(rng, replace(scene, laboratory=replace(scene.laboratory, placement=placement)))


def placed_as_usual(scene: SyntheticScene, path: Path, count: int) -> Float[np.ndarray, "c s q"]:
    """What each thing that sits elsewhere adds to the outputs along a movement, by one usual standard deviation.

    Of a scene that has a placement of its own or none; nothing is drawn for it. What else varies there is added.
    """
    placement = noticed(scene, path, placement_of(scene, sizes(scene, path), 1.0))
    anew = replace(scene, laboratory=replace(scene.laboratory, placement=placement))
    return varied(anew, path, count)


def placement_of(scene: SyntheticScene, size: Sizes, care: float) -> Placement:
    """Standard deviations of everything that may sit elsewhere."""
    known = {"m": LENGTH, "rad": ANGLE}
    units = scene.units[: len(scene.inputs)]
    inputs = {
        row: care * known.get(unit, INPUT_ZERO * float(size.inputs[row]))
        for row, unit in enumerate(units)
        if unit != FLAG
    }
    rows = range(len(scene.outputs))
    return Placement(
        dict.fromkeys(scene.body.lengths, care * LENGTH),
        inputs,
        dict.fromkeys(rows, care * GAIN),
        {row: care * ZERO * float(size.outputs[row]) for row in rows},
    )


def noticed(scene: SyntheticScene, path: Path, placement: Placement) -> Placement:
    """The same, but nothing so far off that whoever measures would see it and place it better."""
    course = path(np.arange(samples(scene, path)) * scene.step)
    outputs = scene.body.recorded(scene.base_model(course)(scene.theta))
    changed = placed(replace(scene, laboratory=replace(scene.laboratory, placement=placement)), course)
    changed = np.where(np.isfinite(outputs)[..., None], changed, np.nan)
    share = np.sqrt(np.nanmean(changed**2, axis=1)) / np.nanmax(np.abs(outputs), axis=1)[:, None]
    return placement.times(np.minimum(1.0, SEEN / np.maximum(share.max(axis=0), 1e-12)))
