"""Where the search of the feet's parameters starts: what presses as the plate says along the recorded motion.

Along smoothed coordinates the plate's force and centre follow from the parameters alone, without any dynamics. What the
smoothing leaves of the errors of the foot's height makes many newtons, so that this is a start and no estimate. From
the prior alone some searches of three trials ended elsewhere, with the spheres on a bound.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import bounds, usual
from geocontact.standing_up.trials import StandingTrial

FORCE, CENTRE = 20.0, 5e-3
"""What smoothed coordinates leave of the force [N] and the centre [m], roughly."""
INSIDE = 1e-3
"""Share of the room between bounds that a start keeps from them."""
Coordinates = Callable[[Float[np.ndarray, " t"]], Float[np.ndarray, "t n"]]


def first_fit(
    model: StandingModel,
    trials: Sequence[StandingTrial],
    smooth: Sequence[Coordinates],
    free: Sequence[str],
    tracks: Sequence[str],
    held: Float[np.ndarray, " p"] | None = None,
) -> Float[np.ndarray, " p"]:
    """Parameters that fit force and centre best, their prior counted once.

    Parameters
    ----------
    smooth
        Coordinates of each trial at times from its own start on.
    free, tracks
        Names of what is sought and of the channels that there are; the prior where neither force nor centre is.
    held
        Values of what is not sought, unless usual.
    """
    from casadi import Function
    from scipy.optimize import least_squares

    middle, sd = usual(model.parameters), np.array([each.sd for each in model.parameters])
    low, high = bounds(model.parameters, free)
    sought = low < high
    if held is not None:
        middle = np.where(sought, middle, held)
    channels = [name for name in ("force", "centre") if name in tracks]
    if not channels or not sought.any():
        return middle
    e, h = model.equations, 1e-3
    plate = Function("plate", [e.q, e.u, e.p], [model.force, model.centre])
    given = []
    for trial, course in zip(trials, smooth, strict=True):
        time = trial.time - trial.time[0]
        given.append((course(time).T, (course(time + h) - course(time - h)).T / (2.0 * h)))

    def off(part: Float[np.ndarray, " s"]) -> Float[np.ndarray, " r"]:
        p = middle.copy()
        p[sought] = part
        pieces = [(part - middle[sought]) / sd[sought]]
        for trial, (q, u) in zip(trials, given, strict=True):
            force, centre = plate.map(len(trial.time))(q, u, np.tile(p[:, None], (1, len(trial.time))))
            weight = 1.0 / np.sqrt(len(trial.time))
            if "force" in channels:
                pieces.append(weight * ((force.full().T - trial.force) / FORCE).ravel())
            if "centre" in channels:
                pieces.append(weight * (centre.full()[0] - trial.centre) / CENTRE)
        return np.concatenate(pieces)

    room = INSIDE * (high - low)
    found = least_squares(
        off, np.clip(middle, low + room, high - room)[sought], bounds=((low + room)[sought], (high - room)[sought])
    )
    best = middle.copy()
    best[sought] = found.x
    return best
