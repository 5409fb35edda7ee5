"""Whether the present foot, as a choice computes it, is the one that was recorded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.below_knee_prosthesis.calibration.recorded_stance import Errors, RecordedStance
from geocontact.below_knee_prosthesis.design.foot_map import CarriedLoad
from geocontact.identify.goodness_of_fit import GoodnessOfFit, of_low_r2, of_range, of_residual

MM = 1e3
HEIGHT = "height of the present foot under its load"
CENTRE = "centre of pressure on the present foot"


def goodness_of(
    stance: RecordedStance, present: CarriedLoad | None, lost: int, o: ProsthesisDesignOptions
) -> GoodnessOfFit:
    """Height of the foot and centre of pressure against those recorded, and drawn feet without an equilibrium.

    The recorded load at the recorded pitch wants a height of the foot that hangs on its stiffness: with the fulcrum
    of the wrong setting it is another one. What is constant of the height is an error of the standing trial.

    Parameters
    ----------
    present
        The present foot along the stance, angles kept; None where the ground is another one than was recorded.
    lost
        Drawn feet without an equilibrium.
    """
    doubts = list(of_range("a drawn foot finds no equilibrium in", lost / o.feet, "the draws"))
    if present is None:
        return GoodnessOfFit(tuple(doubts), ("draws",))
    time = present.task.time
    off = MM * (present.height - np.interp(time, stance.time, stance.poses.translation[:, 1]))
    noise = MM * Errors(height=o.marker_error, pitch=o.pitch_error).standing
    asked = "was the foot set as `setting` or `fulcrum` says?"
    doubts += [
        replace(each, what=f"{each.what}: {asked}") for each in of_residual(HEIGHT, "mm", off - off.mean(), noise)
    ]
    known = np.isfinite(stance.centre)
    seen = np.interp(time, stance.time[known], stance.centre[known])
    square = np.sum((present.centre[:, 0] / present.foot.keel.keel.length - seen) ** 2)
    doubts += of_low_r2(CENTRE, float(1.0 - square / np.sum((seen - seen.mean()) ** 2)))
    return GoodnessOfFit(tuple(doubts), (HEIGHT, CENTRE, "draws"))
