"""A simulated stance in a few numbers, and what speaks against it."""

from __future__ import annotations

import numpy as np

from geocontact.below_knee_prosthesis.evaluation import longest_stance
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import GATE, Stance
from geocontact.contact.bushing import PISTONING

TURNED = np.radians(20.0)
"""rad; of the socket, beyond which its bushing is doubted."""


def summary(found: Stance) -> dict[str, float]:
    """Numbers of the whole stance, with their units in their names; `BW` is over body weight.

    The stance's length is NaN where it is not over, or never began, while it is simulated.
    """
    weight = found.motion.leg.person.mass * GRAVITY
    span = longest_stance(found.time, found.force[:, 1])
    return {
        "stance_s": float("nan") if span is None else span[1] - span[0],
        "vertical_max_BW": float(found.force[:, 1].max() / weight),
        "ankle_moment_max_N_m": float(found.ankle_moment.max()),
        "stored_max_J": float(found.stored.max()),
        "lost_J": float(found.lost[-1]),
        "pistoning_max_mm": float(1e3 * np.abs(found.pistoning).max()),
        "steps": float(found.found.steps),
    }


def in_numbers(found: Stance) -> dict[str, float]:
    """What strides are compared by: peak vertical force and ankle moment, way of the centre of pressure along the foot
    from its hindmost to its foremost place, energy that the keel stores at most, and what it returns of that.

    Returned is what was stored at most less what is left at the end and what damping and friction take on the way.
    """
    along, stored = found.along_foot("ground"), found.stored
    at = int(np.argmax(stored))
    return {
        "vertical_N": float(found.force[:, 1].max()),
        "ankle_moment_N_m": float(found.ankle_moment.max()),
        "cop_travel_mm": float(1e3 * found.foot.keel.length * (np.nanmax(along) - np.nanmin(along))),
        "stored_J": float(stored[at]),
        "returned_J": float(stored[at] - stored[-1] - (found.lost[-1] - found.lost[at])),
    }


def doubts(found: Stance) -> list[str]:
    """Reasons not to trust a simulated stance, each in a sentence; empty where there is none.

    Loaded at its start or at its end, a socket beyond its limits, spheres that sink beyond their radius, and zones of
    the sole that are never loaded, so that their numbers had no say.
    """
    return [*_ends(found), *_socket(found), *_sole(found)]


def _ends(found: Stance) -> list[str]:
    said, pressing = [], found.loads.pressing[0].sum()
    if pressing > GATE:
        said.append(f"the foot is on the floor at the start, with {pressing:.0f} N: begin earlier")
    if found.on[-1]:
        what = f"the foot is still on the floor with {found.force[-1, 1]:.0f} N where the simulation ends"
        said.append(f"{what}, at {found.time[-1]:.2f} s: is `mass` right, and do the markers go on past toe-off?")
    return said


def _socket(found: Stance) -> list[str]:
    said, time, (far, fast) = [], found.time, found.beyond
    if far.any():
        most, limit = 1e3 * np.abs(found.pistoning).max(), 1e3 * PISTONING.travel
        said.append(f"the socket pistons by {most:.0f} mm, past {limit:.0f} mm, first at {time[far][0]:.2f} s")
    if fast.any():
        limit = 1e3 * PISTONING.speed
        said.append(f"the socket pistons faster than {limit:.0f} mm/s, first at {time[fast][0]:.2f} s")
    turned = np.abs(found.found.q[:, 2:5]).max()
    if turned > TURNED:
        said.append(f"the socket turns by {np.degrees(turned):.0f} degrees on its bushing")
    return said


def _sole(found: Stance) -> list[str]:
    said, loads, spheres = [], found.loads, found.foot.sole.spheres
    sunk = loads.depth > spheres.deepest
    if sunk.any():
        deepest = 1e3 * loads.depth.max()
        many = int(sunk.any(axis=0).sum())
        said.append(f"{many} {spheres.kinds} sink beyond their {spheres.limit}, up to {deepest:.0f} mm")
    idle = [zone for zone, of in spheres.zones.items() if not (loads.pressing[:, of] > 0.0).any()]
    if idle:
        said.append(f"never loaded: {', '.join(idle)}; its numbers stay unknown")
    return said
