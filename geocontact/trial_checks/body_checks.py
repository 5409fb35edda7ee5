"""A person's coordinates against a model's ranges, mass against height and legs."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

import numpy as np
from jaxtyping import Float

from geocontact.data.body_segments import ADULT
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import GROUND
from geocontact.trial_checks.landmarks import body_points, middle, points
from geocontact.trial_checks.recorded import Check, Contradiction, MovedModel, TrialInputs
from geocontact.trial_checks.still_checks import FEWEST, smooth

SMALL = 0.5
"""Degrees by which some angle changes; as radians 29 degrees."""
BEYOND = np.radians(20.0)
"""Beyond the range of a coordinate: ranges are drawn for the muscles' paths, and not all recordings keep them."""
FAR = 50.0
"""m; the length of a hall."""
FREE = 6
"""Coordinates of a joint that frees a body of the ground; which way a person faces has no range."""
BUILD = (14.0, 50.0)
"""kg/m^2; severe thinness begins below 16, obesity of class III at 40 (World Health Organization, TRS 894, 2000)."""
THIN_CHILD = 12.0
"""kg/m^2, in place of the first below `ADULT`; severe thinness at 6 years begins below 12.1 in boys and 11.7 in girls
(World Health Organization, growth reference of 5 to 19 years, 2007)."""
LEG, LEG_OFF = 0.491, 0.15
"""Hip to ankle in parts of the height, thigh 0.245 and shank 0.246 (Drillis and Contini, in Winter, Biomechanics,
2009, figure 4.1); share of it that may be missing or too much."""
UPPER_ARM = 0.186
"""Shoulder to elbow in parts of the height (Drillis and Contini, there); `LEG_OFF` of that height may be off."""
PARTS = (0.75, 1.45)
"""Hip to knee in parts of knee to ankle; 0.245/0.246 there, and 422/434 mm in men, 369/432 mm in women (de Leva, J.
Biomech. 29, 1996)."""
PELVIS, PELVIS_PARTS = 0.56, (0.8, 1.8)
"""Height of the front of the pelvis in parts of a person's, and its height above the knee in parts of the knee's above
the ankle, while standing: 0.275 of the height over 0.246 (Drillis and Contini)."""
UNEVEN = 0.06
"""m, between the heights of the two knees while standing."""
MOVES, RATE = (0.1, 0.05), (0.7, 1.4)
"""rad/s and m/s, root mean square, from which a rate is compared; times the slope that it may be."""
COARSE, LEVELS = np.radians(0.5), 3
"""rad, of the steps in which an angle is written, and so many of them that it takes; at 100 Hz they are 87 rad/s^2."""


def angles_in_degrees(trial: TrialInputs) -> Iterator[Contradiction]:
    """All angles so small that they may be radians that were read as degrees."""
    if trial.moved is None:
        return
    degrees = np.degrees(_angles(trial.moved))
    if not degrees.size or np.abs(degrees).max() > pi:
        return
    most = float(np.ptp(degrees, axis=0).max())
    if most > SMALL:
        what = f"no angle is beyond {np.abs(degrees).max():.2g} degrees, and one changes by {most:.2g}"
        yield Contradiction(trial.moved.source, "", what, "unless the person hardly moves, are they radians?")


def _angles(moved: MovedModel) -> Float[np.ndarray, "t n"]:
    """Rotations that the file has, those of a free root as well [rad]; a column at its default does not count."""
    kept = [
        k
        for k, c in enumerate(moved.model.coordinates)
        if c.kind == "rotational" and (moved.values[:, k] != c.default).any()
    ]
    return moved.values[:, kept]


def in_range(trial: TrialInputs) -> Iterator[Contradiction]:
    """Angles of joints against the ranges that the model states."""
    moved = trial.moved
    if moved is None:
        return
    free = {
        c.name
        for joint in moved.model.joints
        if joint.parent == GROUND and len(joint.coordinates) == FREE
        for c in joint.coordinates
    }
    reached = {
        c.name: float(np.abs(moved.values[:, k]).max(initial=0.0)) for k, c in enumerate(moved.model.coordinates)
    }
    shifts = [c.name for c in moved.model.coordinates if c.kind == "translational"]
    far = max(shifts, key=reached.__getitem__, default=None)
    if far is not None and reached[far] > FAR:
        what = f"{far} is up to {reached[far]:.3g} m from where the model's joint is"
        yield Contradiction(moved.source, "", what, "is it in m, not in mm?")
    beyond = []
    for k, c in enumerate(moved.model.coordinates):
        low, high = c.limits
        values = moved.values[:, k]
        if c.kind != "rotational" or c.name in free or c.locked or not (values != c.default).any():
            continue
        off = float(max(np.nanmax(values) - high, low - np.nanmin(values)))
        if off > BEYOND:
            beyond.append((off, c.name, np.degrees(low), np.degrees(high)))
    if beyond:
        off, name, low, high = max(beyond)
        what = f"{name} leaves its range, {low:.0f} to {high:.0f} degrees, by {np.degrees(off):.0f} degrees"
        more = f", and {len(beyond) - 1} more do" if len(beyond) > 1 else ""
        remedy = "is its sign that of the model, its unit right, and are the coordinates of this model?"
        yield Contradiction(moved.source, "", what + more, remedy)


def resolution(trial: TrialInputs) -> Iterator[Contradiction]:
    """Angles that change in coarse steps, and stay between them, of which no acceleration is known."""
    moved = trial.moved
    if moved is None or len(moved.time) < FEWEST:
        return
    coarse = {}
    for k, c in enumerate(moved.model.coordinates):
        change = np.abs(np.diff(moved.values[:, k]))
        moves = change > 1e-6
        if c.kind != "rotational" or not moves.any() or moves.all():
            continue
        step = float(change[moves].min())
        whole = np.abs(moved.values[:, k] / step - np.round(moved.values[:, k] / step)).max() < 1e-3
        if step >= COARSE and whole and np.ptp(moved.values[:, k]) >= LEVELS * step:
            coarse[c.name] = step
    if coarse:
        name = max(coarse, key=lambda each: coarse[each])
        what = f"{name} is written in steps of {np.degrees(coarse[name]):.2g} degrees"
        yield Contradiction(
            moved.source, "", what, "was it rounded? its rates and accelerations are those of the steps"
        )


def build(trial: TrialInputs) -> Iterator[Contradiction]:
    """Mass against height, and height against the legs: given, of the model, or of the standing trial's markers."""
    leg, standing = _leg(trial), _by_pelvis(trial)
    for height, how in (
        (trial.height, "the height"),
        (None if leg is None else leg / LEG, "a height by the model's legs"),
        (standing, "a height by the pelvis of the standing trial"),
    ):
        if trial.mass is None or height is None:
            continue
        index = trial.mass / height**2
        if not _thin(trial) <= index <= BUILD[1]:
            what = f"is {trial.mass:.4g} kg with {how} of {height:.2f} m, {index:.0f} kg/m²"
            yield Contradiction("", trial.mass_option, what, "are it and the lengths in kg and m, of one person?")
        break
    if trial.height is None:
        return
    for length, part, what in ((leg, LEG, "the model's legs"), (standing, 1.0, "the pelvis of the standing trial")):
        if length is not None and abs(length / part / trial.height - 1.0) > LEG_OFF:
            line = f"by {what} the height is {length / part:.2f} m, it is said to be {trial.height:.2f} m"
            yield Contradiction(_source(trial), "", line, "are both of one person, and in m?")


def build_by_arm(trial: TrialInputs) -> Iterator[Contradiction]:
    """Mass against the height that an upper arm belongs to."""
    if trial.mass is None or trial.upper_arm is None or trial.height is not None:
        return
    height = trial.upper_arm / UPPER_ARM
    low, high = _thin(trial) * (1.0 - LEG_OFF) ** 2, BUILD[1] * (1.0 + LEG_OFF) ** 2
    if not low <= trial.mass / height**2 <= high:
        what = f"is {trial.mass:.4g} kg with an upper arm of {1e3 * trial.upper_arm:.0f} mm, which belongs to a height "
        what += f"of {height:.2f} m, {trial.mass / height**2:.0f} kg/m²"
        yield Contradiction("", trial.mass_option, what, "are both of one person, in kg and m?")


def _thin(trial: TrialInputs) -> float:
    """Least mass over squared height of who is of that age [kg/m²]."""
    return BUILD[0] if trial.age is None or trial.age >= ADULT else THIN_CHILD


def _source(trial: TrialInputs) -> str:
    seen = trial.standing
    return trial.moved.source if trial.moved is not None else "" if seen is None else seen.source


def _leg(trial: TrialInputs) -> float | None:
    """Hip to ankle along the bones of a model [m], mean of its legs; None where it has no such joints."""
    moved = trial.moved
    if moved is None:
        return None
    bones = body_points(moved.model, moved.time[:1], moved.values[:1], moved.source)
    found = []
    for side in ("right", "left", ""):
        hip, knee, ankle = (_mean(bones, kind, side) for kind in ("hip", "knee", "ankle"))
        if hip is not None and knee is not None and ankle is not None:
            found.append(float(np.linalg.norm(hip - knee) + np.linalg.norm(knee - ankle)))
    return float(np.mean(found)) if found else None


def _mean(seen: MarkerTrajectories, kind: str, side: str) -> Float[np.ndarray, " 3"] | None:
    places = points(seen, (kind,), side)
    return np.asarray(places.mean(axis=(0, 1))) if places.shape[1] else None


def _height(seen: MarkerTrajectories, kinds: tuple[str, ...], side: str | None, trial: TrialInputs) -> float:
    """Median height of landmarks [m]; NaN where there are none."""
    found = middle(seen, kinds, side)
    return float("nan") if found is None else float(np.nanmedian(found @ trial.up))


def _by_pelvis(trial: TrialInputs) -> float | None:
    """Height of who stands, by that of the front of the pelvis above the heels and toes [m]."""
    if trial.standing is None:
        return None
    above = _height(trial.standing, ("asis",), None, trial) - _height(trial.standing, ("heel", "toe"), None, trial)
    return above / PELVIS if above > 0.0 else None


def segments(trial: TrialInputs) -> Iterator[Contradiction]:
    """Thigh against shank, and right against left, while standing and in a model."""
    yield from bones(trial)
    seen = trial.standing
    if seen is None:
        return
    knees = []
    for side in ("right", "left"):
        pelvis, knee, ankle = (_height(seen, (kind,), side, trial) for kind in ("asis", "knee", "ankle"))
        knees.append(knee)
        share = (pelvis - knee) / (knee - ankle)
        if not (np.isnan(share) or PELVIS_PARTS[0] <= share <= PELVIS_PARTS[1]):
            what = f"the {side} thigh is {share:.2f} times the shank: pelvis, knee and ankle are {pelvis:.2f}, "
            what += f"{knee:.2f} and {ankle:.2f} m high while standing"
            yield Contradiction(seen.source, "", what, "are the labels right, and does the person stand upright?")
    if abs(knees[0] - knees[1]) > UNEVEN:
        what = f"the knees are {knees[0]:.2f} and {knees[1]:.2f} m high while standing"
        yield Contradiction(seen.source, "", what, "is a marker elsewhere, or a label another one's?")


def bones(trial: TrialInputs) -> Iterator[Contradiction]:
    """The same between the joints of a model."""
    moved = trial.moved
    if moved is None:
        return
    places = body_points(moved.model, moved.time[:1], moved.values[:1], moved.source)
    for side in ("right", "left"):
        hip, knee, ankle = (_mean(places, kind, side) for kind in ("hip", "knee", "ankle"))
        if hip is None or knee is None or ankle is None:
            continue
        share = float(np.linalg.norm(hip - knee) / np.linalg.norm(knee - ankle))
        if not PARTS[0] <= share <= PARTS[1]:
            what = f"the {side} thigh of {moved.model.name} is {share:.2f} times its shank"
            yield Contradiction(moved.source, "", what, "is the model scaled by the right markers?")


def differentiated(trial: TrialInputs) -> Iterator[Contradiction]:
    """Rates that a file has against the slopes of the coordinates."""
    moved = trial.moved
    if moved is None or moved.rates is None or len(moved.time) < FEWEST:
        return
    there = np.isfinite(moved.rates).all(axis=1)
    if there.sum() < FEWEST:
        return
    step = float(np.median(np.diff(moved.time)))
    for k, c in enumerate(moved.model.coordinates):
        slope = np.gradient(smooth(moved.values[there, k], step), step)
        rate = smooth(moved.rates[there, k], step)
        size = float(np.sqrt(np.mean(slope**2)))
        if size < MOVES[c.kind != "rotational"]:
            continue
        times = float(rate @ slope) / float(slope @ slope)
        if not RATE[0] <= times <= RATE[1]:
            what = f"the rate of {c.name} is {times:.3g} times the slope of its values"
            remedy = "is its sign turned, or is it in degrees and not in radians, or of another trial?"
            yield Contradiction(moved.source, "", what, remedy)


BODY_CHECKS = (
    Check(
        "angles in degrees",
        "largest of all angles, and by how much any changes, with what degrees would be",
        f"none beyond {pi:.2f} degrees while one changes by {SMALL:g} degrees",
        angles_in_degrees,
    ),
    Check(
        "range of a coordinate",
        "angles of joints with the ranges that the model states, shifts with the length of a hall",
        f"{np.degrees(BEYOND):.0f} degrees beyond, {FAR:g} m; degrees read as radians are refused by the reader",
        in_range,
    ),
    Check(
        "resolution",
        "steps in which an angle is written with what it moves by",
        f"{np.degrees(COARSE):g} degrees",
        resolution,
    ),
    Check(
        "mass and height",
        "mass with height, and height with legs of the model or the pelvis of the standing trial",
        f"{BUILD[0]:g}, of a child {THIN_CHILD:g}, to {BUILD[1]:g} kg/m² (severe thinness below 16, class III obesity "
        "from 40: WHO, TRS 894); "
        f"{LEG_OFF:.0%} of the height, hip to ankle being {LEG:g} of it (Drillis and Contini)",
        build,
    ),
    Check(
        "mass and upper arm",
        "mass with the height that the upper arm belongs to",
        f"the same, with {LEG_OFF:.0%} of the height, the upper arm being {UPPER_ARM:g} of it (Drillis and Contini)",
        build_by_arm,
    ),
    Check(
        "thigh and shank",
        "thigh with shank and right with left, of the model or while standing",
        f"{PARTS[0]:g} to {PARTS[1]:g} between joints, 0.97 in men and 0.85 in women (de Leva 1996); "
        f"{PELVIS_PARTS[0]:g} to {PELVIS_PARTS[1]:g} by markers; knees {1e3 * UNEVEN:.0f} mm apart in height",
        segments,
    ),
    Check(
        "rates",
        "rates of a file of their own with slopes of the coordinates",
        f"{RATE[0]:g} to {RATE[1]:g} times, where a coordinate moves",
        differentiated,
    ),
)
"""Checks that need a model or a person's size."""
