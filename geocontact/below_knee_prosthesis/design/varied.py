"""A foot varied along a recorded trial: draws over the values, and the foot along the stance at both ends.

task = trial.task()
varied = varied_foot(foot, trial, sd, knob, feet=12, walks=3)
sweep = Sweep(knob, varied.drawn.drawn, varied.drawn.free, level=0.95)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.drawn import Draws, RecordedTrial, TrialErrors, draws, task_again
from geocontact.below_knee_prosthesis.design.foot_map import CarriedLoad
from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.below_knee_prosthesis.design.knob import Knob, Response, Vary
from geocontact.below_knee_prosthesis.design.sensitivities import FootSensitivity, Unknown, sensitivities
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.leg import FootOffset

ENDS: dict[Vary, tuple[float, float]] = {"alignment": (-6.0, 6.0), "stiffness": (0.6, 1.6)}
"""Values that are tried, from and to: degrees, factor; a fulcrum goes over the range of its keel."""
COUNT = 9
"""Values that are tried."""
ALIGNMENTS = np.radians([-6.0, -3.0, 0.0, 3.0, 6.0])
"""That go together with every value."""
USUAL = TrialErrors()


def values_of(vary: Vary, keel: Keel) -> Float[np.ndarray, " n"]:
    """Values that are tried: m, rad, factor."""
    values = np.linspace(*(keel.range if vary == "fulcrum" else ENDS[vary]), COUNT)
    return np.radians(values) if vary == "alignment" else values


@dataclass(frozen=True, eq=False)
class VariedFoot:
    """A foot varied along a trial.

    Parameters
    ----------
    task
        What the foot carries.
    drawn
        Outcomes over the values, with what is not known drawn.
    ends, shapes
        First, present and last value, and the foot along the stance at each, with the numbers as they are.
    held
        How long joint torques alone hold the leg at each of the ends [s].
    hangs_on
        How far outcomes on the present foot hang on each number.
    """

    task: FootTask
    drawn: Draws
    ends: Knob
    shapes: Mapping[Response, tuple[CarriedLoad, ...]]
    held: tuple[float, ...]
    hangs_on: tuple[FootSensitivity, ...]


def varied_foot(
    foot: VariableStiffnessFoot,
    trial: RecordedTrial,
    sd: Float[np.ndarray, " p"],
    knob: Knob,
    *,
    feet: int,
    walks: int,
    seed: int = 0,
    errors: TrialErrors = USUAL,
    alignments: Sequence[float] = (),
    step: Callable[[], None] = lambda: None,
) -> VariedFoot:
    """Draws over the values of `knob`, and both ends beside the present one.

    Parameters
    ----------
    sd
        Of the logarithms of the sole's numbers, in the order of `ZoneParameters`.
    feet, walks, seed, alignments, step
        As those of `draws`.
    errors
        Of markers and plate.

    ArithmeticError where the foot finds no equilibrium; InputError or ValueError where markers or plate cannot tell
    the stance.
    """
    ends, task = ends_of(knob), trial.task()
    drawn = draws(
        knob,
        foot,
        task,
        lambda rng: task_again(trial, errors, rng),
        sd,
        feet=feet,
        walks=walks,
        seed=seed,
        step=step,
        alignments=alignments,
    )
    unknown = Unknown(sd, errors.pitch, errors.gain)
    hangs_on = sensitivities(foot, task, trial.fulcrum, knob.terrain, unknown)
    maps = ends.maps(foot, task)
    shapes = ends.carried(maps, task)
    held = ends.other_feet(maps, task, tracking=0.0).moved().held
    return VariedFoot(task, drawn, ends, shapes, tuple(held.tolist()), hangs_on)


def ends_of(knob: Knob) -> Knob:
    """The first value, the present one and the last, in order."""
    return Knob(knob.vary, np.unique([knob.settings[0], knob.present, knob.settings[-1]]), knob.fulcrum, knob.terrain)


def known_pitch(offset: FootOffset, pitch: float) -> float:
    """Standard deviation of the foot's pitch [rad]: that of its offset where it knows the pitch better."""
    return min(pitch, offset.pitch_sd) if offset.pitch_sd > 0.0 else pitch
