"""How large things are in the base model along the calibration trials of a case."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.plan import SyntheticMagnitudes
from geocontact.gap_benchmark.synthetic.scene import SyntheticScene
from geocontact.gap_benchmark.synthetic.visibility import WhitenedTrial


def magnitudes_of(scene: SyntheticScene, trials: Sequence[WhitenedTrial], departure: float) -> SyntheticMagnitudes:
    """Magnitudes of the whole system, and of each interface where an effect may sit alone."""
    courses = [one.path(np.arange(one.count) * scene.step) for one in trials]
    pairs = [scene.motion(course) for course in courses]
    most = {
        name: max(float(np.nanmax(np.abs(one.outputs[c]))) for one in trials) for c, name in enumerate(scene.outputs)
    }
    low, stroke, high, rate = extremes(pairs)
    begin, end = ends(courses, 0)
    acceleration = np.concatenate([course.acceleration[0] for course in courses])
    whole = SyntheticMagnitudes(
        scene.body.effects,
        max(most[scene.outputs[row]] for row in scene.body.normal),
        stroke,
        low,
        high,
        rate,
        max(course.duration for course in courses),
        scene.step,
        most,
        float(np.sqrt(np.mean(acceleration**2))),
        0.5 * (begin + end),
        departure,
        0.5 * (end - begin),
        scene.body.loads,
    )
    places = {}
    for row, place in enumerate(scene.body.places):
        low, stroke, high, rate = extremes([(u[row], v[row]) for u, v in pairs])
        begin, end = ends(courses, place.angle)
        places[place.name] = replace(
            whole,
            force=most[scene.outputs[place.output]],
            stroke=stroke,
            low=low,
            high=high,
            rate=rate,
            middle=0.5 * (begin + end),
            span=0.5 * (end - begin),
            loads=(place.output,),
        )
    return replace(whole, places=places)


def extremes(
    pairs: Sequence[tuple[Float[np.ndarray, ...], Float[np.ndarray, ...]]],
) -> tuple[float, float, float, float]:
    """Least, largest in magnitude and greatest deflection; rms of its rate."""
    u, rate = (np.concatenate([pair[i].ravel() for pair in pairs]) for i in (0, 1))
    return float(u.min()), float(np.abs(u).max()), float(u.max()), float(np.sqrt(np.mean(rate**2)))


def ends(courses: Sequence[InputCourse], row: int) -> tuple[float, float]:
    """Least and greatest value of an input."""
    values = np.concatenate([course.position[row] for course in courses])
    return float(values.min()), float(values.max())
