"""Which plate carries what of a body: a foot, both feet or the seat, by where its centre of pressure is.

Seen from above, a foot is a line along its own forward direction through the ankle, and both feet are the area between
the two lines. The seat carries what lies between a point behind the hips and the knees. A plate belongs to what the
median of its loaded centre of pressure is nearest to, within limits; the order of plates in their file has no effect.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.force_plate import ForcePlate

BEHIND, AHEAD = 0.06, 0.20
"""Ends of a foot behind and ahead of the ankle [m]; feet are 0.26 m long, as for a stance."""
BESIDE = 0.09
"""m, from a foot's line, in the median; 0.005 to 0.034 in 12 steps of 5 people (`trial_checks.foot_checks`)."""
REARWARD, SEAT = 0.15, 0.15
"""m, from the hips' centre to the end of the buttocks, and beside the line from there to the knees; invented."""
ALL = 0.75
"""Share of the weight that a single plate of who stands on both feet carries at least; one foot's is nearer to half."""
Places = Float[np.ndarray, "t 3"]
Side = Literal["right", "left"]
Carried = Literal["right foot", "left foot", "both feet", "seat", "nothing known", "no load"]


@dataclass(frozen=True, eq=False)
class BodySites:
    """Places of a body over time in the frame of the ground, y up [m].

    Parameters
    ----------
    time
        [s].
    ankles, toes
        Centre of each ankle, and unit vector along each foot forwards, by side.
    hips, knees
        Middle of both.
    """

    time: Float[np.ndarray, " t"]
    ankles: Mapping[str, Places]
    toes: Mapping[str, Places]
    hips: Places
    knees: Places


@dataclass(frozen=True)
class PlatePlace:
    """A plate, what it carries, and distances of its centre of pressure seen from above, in the median [m].

    Parameters
    ----------
    away
        From what it carries; not a number where nothing is known, or without load.
    from_feet, from_seat
        From the area of both feet, and from the seat.
    """

    name: str
    carries: Carried
    away: float
    from_feet: float
    from_seat: float

    def __str__(self) -> str:
        if self.carries == "no load":
            return f"{self.name} without load"
        if self.carries == "nothing known":
            return f"{self.name} under no part of the body, {self.from_feet:.2f} m from the feet"
        under = self.carries if self.carries == "both feet" else f"the {self.carries}"
        return f"{self.name} under {under} ({1e3 * self.away:.0f} mm)"


def plate_places(plates: Sequence[ForcePlate], body: BodySites) -> tuple[PlatePlace, ...]:
    """Each plate and what it carries.

    Where each foot has a plate of its own, another between the feet that is near the seat too carries the seat: the
    ankles of somebody who sits may be under the thighs.
    """
    found = tuple(_place(plate, body) for plate in plates)
    if not {"right foot", "left foot"} <= {each.carries for each in found}:
        return found
    return tuple(
        replace(each, carries="seat", away=each.from_seat)
        if each.carries == "both feet" and each.from_seat <= SEAT
        else each
        for each in found
    )


def _place(plate: ForcePlate, body: BodySites) -> PlatePlace:
    centre, heavy = plate.centre_of_pressure(), plate.heavy(body.time[0], body.time[-1])
    if not heavy.any():
        return PlatePlace(plate.name, "no load", float("nan"), float("nan"), float("nan"))
    at, seen = plate.time[heavy], centre[heavy][:, [0, 2]]
    lines = {side: _foot(body, side, at) for side in ("right", "left")}
    off = {side: float(np.median(from_line(seen, *line))) for side, line in lines.items()}
    between = [
        from_line(seen, *((1.0 - share) * lines["right"][end] + share * lines["left"][end] for end in (0, 1)))
        for share in np.linspace(0.0, 1.0, 21)
    ]
    both = float(np.median(np.min(between, axis=0)))
    hips, knees = _seen_at(body, body.hips, at), _seen_at(body, body.knees, at)
    long = np.fmax(np.linalg.norm(knees - hips, axis=1, keepdims=True), 1e-6)
    seat = float(np.median(from_line(seen, hips - REARWARD * (knees - hips) / long, knees)))
    nearest: Side = "right" if off["right"] <= off["left"] else "left"
    if off[nearest] <= BESIDE and off[nearest] < 0.5 * max(off.values()):
        return PlatePlace(plate.name, "right foot" if nearest == "right" else "left foot", off[nearest], both, seat)
    if both <= BESIDE:
        return PlatePlace(plate.name, "both feet", both, both, seat)
    if seat <= SEAT:
        return PlatePlace(plate.name, "seat", seat, both, seat)
    return PlatePlace(plate.name, "nothing known", float("nan"), both, seat)


def _seen_at(body: BodySites, places: Places, at: Float[np.ndarray, " s"]) -> Float[np.ndarray, "s 2"]:
    """Places at other times, seen from above."""
    return np.column_stack([np.interp(at, body.time, places[:, k]) for k in (0, 2)])


def _foot(body: BodySites, side: str, at: Float[np.ndarray, " s"]) -> tuple[Float[np.ndarray, "s 2"], ...]:
    """Heel and toes of a foot, seen from above."""
    ankle, ahead = body.ankles[side], body.toes[side]
    return _seen_at(body, ankle - BEHIND * ahead, at), _seen_at(body, ankle + AHEAD * ahead, at)


def from_line(
    seen: Float[np.ndarray, "s d"], begin: Float[np.ndarray, "s d"], end: Float[np.ndarray, "s d"]
) -> Float[np.ndarray, " s"]:
    """Distance from the line between two points."""
    along, out = end - begin, seen - begin
    share = np.clip(np.sum(out * along, axis=1) / np.fmax(np.sum(along**2, axis=1), 1e-12), 0.0, 1.0)
    return np.asarray(np.linalg.norm(out - share[:, None] * along, axis=1))
