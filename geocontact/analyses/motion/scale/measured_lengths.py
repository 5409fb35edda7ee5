"""Doubts about the distances of markers that measure segments: a joint between them, and sides that differ."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import reserve, say
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody

CHANGES = 0.02
"""m by which the distance of two markers may change in a trial, in 9 of 10 frames: as for a marker of a static one."""
UNEQUAL = 0.02
"""m by which a segment's sides may differ. Legs differ by 5.2 mm, standard deviation 4.1 mm, and so much is 3.6 of them
above (Knutson 2005, Chiropractic & Osteopathy 13:11)."""
TURN, SPANS = 0.2, 0.005
"""rad of one coordinate, and m by which it changes a distance from which a pair spans the joint; invented."""


def doubt_lengths(model: Multibody, seen: MarkerTrajectories, texts: Sequence[str], *, named: bool) -> None:
    """One warning for each pair whose distance changes over the trial, and for each segment of unlike sides.

    `texts` are as `scale` takes them, femur_r=R.Hip/R.Knee; numbers in place of pairs are no measurement. Where a
    marker set chose the pairs, `named`, those that span a joint are said.
    """
    measured = {
        bodies: [tuple(name.strip() for name in pair.split("/")) for pair in size.split(",")]
        for bodies, _, size in (text.partition("=") for text in texts)
        if "/" in size
    }
    if named:
        _say_spanning(model, measured)
    for bodies, pairs in measured.items():
        for one, other in pairs:
            _doubt_change(model, seen, bodies.split(",")[0], one, other)
    for bodies, pairs in measured.items():
        across = bodies.replace("_r", "_l")
        if across != bodies and across in measured:
            sides = (_lengths(model, seen, each) for each in (pairs, measured[across]))
            _doubt_sides(bodies.split(",")[0], *sides)


def _say_spanning(model: Multibody, measured: Mapping[str, Sequence[Sequence[str]]]) -> None:
    """One sentence with the pairs whose distance depends on the pose."""
    spanning = []
    for bodies, pairs in measured.items():
        for one, other in pairs:
            if found := joint_across(model, one, other):
                name, change = found
                spanning.append(f"{bodies.split(',')[0]} by {one}/{other} ({name}, {1e3 * change:.0f} mm)")
    if spanning:
        say(f"measured across a joint, with the change of length for {TURN:g} rad: {', '.join(spanning)}")


def _apart(seen: MarkerTrajectories, one: str, other: str) -> Float[np.ndarray, " t"]:
    places = seen.of((one, other))
    found: Float[np.ndarray, " t"] = np.linalg.norm(places[:, 0] - places[:, 1], axis=1)
    seen_both: Float[np.ndarray, " t"] = found[np.isfinite(found)]
    return seen_both


def _own(model: Multibody, one: str, other: str) -> float:
    """Distance of two markers of the model in its default pose [m]."""
    places = model.marker_places(np.array([[c.default for c in model.coordinates]]))[0]
    names = [m.name for m in model.markers]
    return float(np.linalg.norm(places[names.index(one)] - places[names.index(other)]))


def _lengths(model: Multibody, seen: MarkerTrajectories, pairs: Sequence[Sequence[str]]) -> tuple[float, float]:
    """Mean distance of the pairs [m], and that of the model."""
    measured = np.mean([_apart(seen, one, other).mean() for one, other in pairs])
    return float(measured), float(np.mean([_own(model, one, other) for one, other in pairs]))


def _doubt_change(model: Multibody, seen: MarkerTrajectories, body: str, one: str, other: str) -> None:
    low, high = np.quantile(_apart(seen, one, other), (0.05, 0.95))
    if high - low <= CHANGES:
        return
    across = joint_across(model, one, other)
    why = f"changes with {across[0]}" if across else "is not that of one rigid body"
    reserve(
        f"{seen.source}: {body}: {one} and {other} are {1e3 * low:.0f} to {1e3 * high:.0f} mm apart, which {why}: "
        "measure it in a static trial, or by a pair on one segment with `scale`"
    )


def joint_across(model: Multibody, one: str, other: str) -> tuple[str, float] | None:
    """The coordinate that changes the distance of two markers most, and by how much [m]; None for less than `SPANS`."""
    which = [[m.name for m in model.markers].index(name) for name in (one, other)]
    turning = [k for k, c in enumerate(model.coordinates) if c.kind == "rotational"]
    if not turning:
        return None
    values = np.tile([c.default for c in model.coordinates], (len(turning) + 1, 1))
    values[np.arange(len(turning)), turning] += TURN
    places = model.marker_places(values)[:, which]
    apart = np.linalg.norm(places[:, 0] - places[:, 1], axis=1)
    change = np.abs(apart[:-1] - apart[-1])
    most = int(np.argmax(change))
    return (model.coordinates[turning[most]].name, float(change[most])) if change[most] > SPANS else None


def _doubt_sides(body: str, right: tuple[float, float], left: tuple[float, float]) -> None:
    """A warning where the factors of both sides, of measured length over the model's, make legs that nobody has."""
    differ = (left[0] / left[1] - right[0] / right[1]) * 0.5 * (right[1] + left[1])
    if abs(differ) <= UNEQUAL:
        return
    longer, shorter = ("left", "right") if differ > 0.0 else ("right", "left")
    segment = body.partition(":")[0].rpartition("_")[0]
    measured, own = (f"{1e3 * r:.0f} and {1e3 * l:.0f} mm" for r, l in zip(right, left, strict=True))
    reserve(
        f"{segment}: the {longer} one is scaled {1e3 * abs(differ):.0f} mm longer than the {shorter} one; markers are "
        f"{measured} apart, right and left, those of the model {own}: are both where the subject's are? One factor for "
        "both is `scale` with both bodies and all pairs"
    )
