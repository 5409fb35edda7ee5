"""Contact over one motion: what is found of it and doubted, and its tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.area.bodies import Bodies
from geocontact.analyses.area.congruence import CongruenceEvolution
from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.area.pose_error import AreaUncertainty, uncertainty_table
from geocontact.analyses.area.pressure import PressureEvolution
from geocontact.analyses.frame.collector import note, reserve, say
from geocontact.data.errors import InputError
from geocontact.data.evolution import MM2, AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import area_evolution
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.loads.pressure_load import PressureLoad


@dataclass(frozen=True, eq=False)
class MotionResult:
    """Contact of two bodies over one motion.

    Parameters
    ----------
    name
        Of its sub-folder; empty when there is one motion.
    motion
        Poses of MOVING in FIXED.
    evolution
        Areas, bounds and separation of every frame.
    maps
        Distances of the vertices in some frames; in all of them with `save_map`.
    pressure
        Loads of every frame; None unless `pressure` was asked for.
    comparison
        Differences to measured areas; None unless `compare` names some.
    uncertainty
        Error of the poses carried into FIXED's area; None unless one was given.
    congruence
        How alike the surfaces are curved in contact; None unless asked for.
    reservations
        What is to be doubted about this motion, each one line.
    """

    name: str
    motion: Motion
    evolution: AreaEvolution
    maps: DistanceMaps
    pressure: PressureEvolution | None
    comparison: pd.DataFrame | None
    uncertainty: AreaUncertainty | None
    congruence: CongruenceEvolution | None
    reservations: tuple[str, ...]


def tables_of(one: MotionResult, o: AreaOptions) -> dict[str, pd.DataFrame]:
    """`area`, and `pressure`, `comparison` and `pose_error` where they were asked for."""
    found = {"area": area_table(one, o)}
    if one.pressure is not None:
        found["pressure"] = pressure_table(one.motion, one.pressure)
    if one.comparison is not None:
        found["comparison"] = one.comparison
    if one.uncertainty is not None:
        found["pose_error"] = uncertainty_table(one.motion.time, one.evolution.thresholds, one.uncertainty)
    return found


def area_table(one: MotionResult, o: AreaOptions) -> pd.DataFrame:
    """A row per frame and threshold, with congruence, the angle that a sweep prescribes and the offset of adduction."""
    table = one.evolution.table()
    if one.congruence is not None:
        table = table.assign(**one.congruence.columns())
    if one.motion.coordinate is not None:
        name, angle = one.motion.coordinate
        table[f"{name} [deg]"] = np.repeat(np.degrees(angle), len(one.evolution.thresholds))
    if o.adduction is not None:
        table["adduction offset [deg]"] = np.round(np.degrees(o.adduction[1]), 9)
    return table


def pressure_table(motion: Motion, e: PressureEvolution) -> pd.DataFrame:
    """A row per frame: force on FIXED, its moment about the frame's origin, centre of pressure (empty without load)."""
    wrenches = [load.wrench for load in e.loads]
    columns: dict[str, object] = {"time [s]": motion.time, "force [N]": e.pressing}
    for axis, letter in enumerate("xyz"):
        columns[f"force_{letter} [N]"] = [w.force[axis] for w in wrenches]
    for axis, letter in enumerate("xyz"):
        columns[f"moment_{letter} [N m]"] = [w.moment[axis] for w in wrenches]
    columns |= _columns("", e.loads)
    for side, loads in e.parts.items():
        columns[f"force_{side} [N]"] = [load.pressing for load in loads]
        columns |= _columns(f"_{side}", loads)
    return pd.DataFrame(columns)


def _columns(suffix: str, loads: Sequence[PressureLoad]) -> dict[str, object]:
    centres = np.array([load.centre for load in loads]) * 1e3
    return {
        f"peak{suffix} [MPa]": [load.peak * 1e-6 for load in loads],
        f"pressed_area{suffix} [mm^2]": [load.area * 1e6 for load in loads],
        **{f"cop{suffix}_{letter} [mm]": centres[:, axis] for axis, letter in enumerate("xyz")},
    }


OVERLAP = 1e-3  # m; as much as fluoroscopy and optical tracking err by across a joint
DIGITS = 6  # of a depth in m that count: further ones are rounding, which differs with the place in the frame
NEAR = 20e-3  # m; bodies that never come this close are a mistake in the input
PLACES = "where each mesh sits in its body (`place_moving`, `place_fixed`)"


def refuse_strangers(e: AreaEvolution, motion: Motion, o: AreaOptions) -> None:
    """InputError for bodies that are far apart in every frame."""
    closest = float(e.min_distance.min())
    if closest <= NEAR:
        return
    remedy = f"check unit, frames and direction: {PLACES}, the motion's axes, which body moves"
    if o.osim is not None:
        remedy = f"wrong direction? try `moving_body` {'child' if o.moving_body == 'parent' else 'parent'}"
    what = f"bodies are {closest * 1e3:.0f} mm apart in every frame"
    raise InputError("", "", what, f"{remedy} (they are nearest in {_nearest(e, motion)})")


def warn_of_no_contact(e: AreaEvolution, motion: Motion, name: str) -> None:
    """A reservation where FIXED has no contact in any frame, even within the largest threshold."""
    if e.fixed.area.max() > 0.0:
        return
    largest, closest = max(e.thresholds), float(e.min_distance.min())
    line = _of(name)
    line += f"nothing of FIXED is within {largest * 1e3:g} mm in any frame: "
    line += f"the least distance of the bodies is {closest * 1e3:.3g} mm, in {_nearest(e, motion)}"
    check = f"check unit, {PLACES}, the motion's axes, which body moves, and the threshold"
    if closest <= largest:
        check = "the faces that count are elsewhere, check `region`"
    reserve(f"{line}; {check}")


def warn_of_lift_off(e: AreaEvolution, motion: Motion, name: str) -> None:
    """A reservation where FIXED has contact in some frames and in others has none."""
    without = e.fixed.area[:, int(np.argmax(e.thresholds))] <= 0.0
    if not without.any() or without.all():
        return
    frame = int(np.argmax(e.min_distance))
    reserve(
        f"{_of(name)}{int(without.sum())} of {len(without)} frames have nothing within {max(e.thresholds) * 1e3:g} mm; "
        f"the bodies are farthest apart, {e.min_distance[frame] * 1e3:.3g} mm, in {_frame(frame, motion)}; "
        "if they should touch, are MOVING and FIXED exchanged, or is a row of the motion wrong?"
    )


def warn_of_overlap(e: AreaEvolution, motion: Motion, name: str) -> None:
    """A reservation where one body is farther inside the other than measured poses of rigid bodies bring it."""
    depth = -float(e.min_distance.min())
    if round(depth, DIGITS) >= OVERLAP:
        reserve(
            f"{_of(name)}the bodies overlap, by {depth * 1e3:.2f} mm at most, in {_nearest(e, motion)}; "
            f"rigid ones do not: check {PLACES}, the order of rotations, "
            "that quaternions have the scalar first, and which body moves"
        )


def least_distance(e: AreaEvolution, motion: Motion, name: str) -> str:
    """How near the bodies come, in which frame, and what the sign of a distance says."""
    sign = "unsigned: overlap cannot be told" if e.signed == "none" else "signed: negative is overlap"
    least = round(float(e.min_distance.min()) * 1e3, 3) + 0.0  # no -0
    return f"{_of(name)}least distance {least:g} mm in {_nearest(e, motion)} ({sign})"


def _of(name: str) -> str:
    return f"{name}: " if name else ""


def _nearest(e: AreaEvolution, motion: Motion) -> str:
    """Frame of the least distance, for people: "frame 12 of 101, 0.11 s"."""
    return _frame(int(np.argmin(e.min_distance)), motion)


def _frame(frame: int, motion: Motion) -> str:
    return f"frame {frame + 1} of {len(motion)}, {motion.course.at(frame)}"


Body = Literal["moving", "fixed"]
NONE = 1e-9
"""Share of a contact area below which what lies inside is rounding."""


def say_inner_area(bodies: Bodies, o: AreaOptions, name: str, motion: Motion, evolution: AreaEvolution) -> None:
    """For each file with surfaces inside or across others that count: how much of its contact area is on these."""
    for body, whole, alone in _with_and_without(bodies, o, motion, evolution):
        united = bodies.inner[body]
        within = f"within {max(evolution.thresholds) * 1e3:g} mm"
        inside = whole - alone
        frame = int(np.argmax(inside))
        largest = float(inside[frame])
        holds = f"{f'{name}: ' if name else ''}{united.surface.name} holds {united.words}"
        note(
            f"{name} inner_surfaces_{body}".lstrip(),
            {
                "closed_surfaces": united.count,
                "largest_inner_area_mm2": round(max(largest, 0.0) * MM2, 3),
                "frame": frame,
            },
        )
        if largest <= NONE * float(whole[frame]):
            say(f"{holds}; nothing of area_{body} {within} lies inside")
            continue
        reserve(
            f"{holds}: {largest * MM2:.1f} of the {whole[frame] * MM2:.1f} mm^2 of area_{body} {within} in frame "
            f"{frame + 1} of {len(motion)}, {motion.course.at(frame)}, lie inside another one; "
            f"`outer` {body} counts the outer surface alone"
        )


def _with_and_without(
    bodies: Bodies, o: AreaOptions, motion: Motion, evolution: AreaEvolution
) -> Iterator[tuple[Body, Float[np.ndarray, " t"], Float[np.ndarray, " t"]]]:
    """Body, and its area over the frames at the largest threshold as counted and of the outer surface alone [m^2]."""
    widest = int(np.argmax(evolution.thresholds))
    settings = replace(bodies.settings, thresholds=(max(evolution.thresholds),), sensitivity=())
    for body in bodies.inner:
        sides = {"moving": bodies.moving, "fixed": bodies.fixed, body: bodies.inner[body].surface}
        faces = {"moving": settings.moving_faces, "fixed": settings.fixed_faces}
        marked = faces[body]
        faces[body] = None if marked is None else marked[bodies.inner[body].face]
        alone = replace(settings, moving_faces=faces["moving"], fixed_faces=faces["fixed"])
        found = area_evolution(sides["moving"], sides["fixed"], motion, alone, o.workers)
        yield body, getattr(evolution, body).area[:, widest], getattr(found, body).area[:, 0]
