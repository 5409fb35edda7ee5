"""Where two bodies are over a motion: far apart, overlapping, lifting off, or in contact inside another surface."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.area.bodies import Bodies
from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.frame.collector import note, reserve, say
from geocontact.data.errors import InputError
from geocontact.data.evolution import MM2, AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import area_of_outer

OVERLAP = 1e-3  # m; as much as fluoroscopy and optical tracking err by across a joint
DIGITS = 6  # of a depth in m that count: further ones are rounding, which differs with the place in the frame
NEAR = 20e-3  # m; bodies that never come this close are a mistake in the input
PLACES = "where each mesh sits in its body (`place_moving`, `place_fixed`)"


def refuse_far_apart(e: AreaEvolution, motion: Motion, o: AreaOptions) -> None:
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
            f"rigid ones do not: check units and signs of the motion, {PLACES}, the order of rotations, "
            "that quaternions have the scalar first, and which body moves"
        )


def least_distance(e: AreaEvolution, motion: Motion, name: str) -> str:
    """How near the bodies come, in which frame, and what the sign of a distance says."""
    sign = "unsigned: overlap is not detectable" if e.signed == "none" else "signed: negative is overlap"
    least = round(float(e.min_distance.min()) * 1e3, 3) + 0.0  # no -0
    return f"{_of(name)}least distance {least:g} mm in {_nearest(e, motion)} ({sign})"


def _of(name: str) -> str:
    return f"{name}: " if name else ""


def _nearest(e: AreaEvolution, motion: Motion) -> str:
    """Frame of the least distance, for people: "frame 12 of 101, 0.11 s"."""
    return _frame(int(np.argmin(e.min_distance)), motion)


def _frame(frame: int, motion: Motion) -> str:
    return f"frame {frame + 1} of {len(motion)}, {motion.course.at(frame)}"


NONE = 1e-9
"""Share of a contact area below which what lies inside is rounding."""


def say_inner_area(bodies: Bodies, o: AreaOptions, name: str, motion: Motion, evolution: AreaEvolution) -> None:
    """For each file with surfaces inside or across others that count: how much of its contact area is on these."""
    widest = int(np.argmax(evolution.thresholds))
    for body, united in bodies.inner.items():
        whole = getattr(evolution, body).area[:, widest]
        alone = area_of_outer(bodies.moving, bodies.fixed, motion, bodies.settings, body, united, o.workers)
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
