"""Markers against themselves, against the way up, right against left, and against the standing trial."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.dynamics.tilt import axes_upright
from geocontact.trial_checks.landmarks import FOOT, landmark, middle, points
from geocontact.trial_checks.recorded import Check, Contradiction, TrialInputs
from geocontact.trial_checks.twice import EVEN, KINK, STRAIGHT, held_steps, straight_gaps

STEP, ACCELERATION = 0.04, 200.0
"""m, and m/s^2 over one sample: a marker of a person does not leave its course by more from one frame to the next.
Skin and feet that land reach 40 to 190 m/s^2 in recordings of six people; a label that jumps leaves by centimetres."""
SAME_PLACE = 0.25
"""Share of two jumps within which each marker has to land at the place of the other to be exchanged with it."""
LYING = 0.15
"""m, of the pelvis above the feet: who stands, walks or sits has it higher up."""
TURNED = 0.3
"""Cosine between where the body faces by its right and left and by its front and back, below 0."""
LEVEL, ON_FLOOR, FLOORS = 0.05, (-0.015, 0.065), 0.035
"""m, between heel and toes of a foot that stands flat; of its lowest marker above the floor; of the heel's marker
between standing and stance."""
FASTEST, NEARLY_ALWAYS = 20.0, 98.0
"""m/s, a sprinter's foot in swing, and per cent of the frames in which a marker is slower; people who walk have 5."""
HELD = ("shoulder", "arm")
"""Landmarks that are no measure: arms hang, swing little, or are held out while somebody stands."""
RIGID, MOVED, FEWEST = 0.006, 0.025, 2
"""m, of standard deviation of the distance of two markers on one segment; m, by which that distance then differs from
the standing trial; pairs of a marker that have to say so."""
MOVING_FOR = 0.3
"""s, in less than which distances between segments are kept as well as those on one."""
SWINGS, ENDS, LONG_ENOUGH = 0.07, 0.2, 30
"""m, of the middle 95 % of a distance on one segment; share of the trial at either end whose medians are compared, with
the limit `MOVED`; frames that a pair has to be seen in. Nine recordings of seven people have 27 and 14 mm at most, an
old one whose pelvis has markers on wands 61 and 7 mm."""
ANYWHERE = frozenset({"marker", "mark", "mkr", "mk", "point", "pt", "unlabeled", "unlabelled", "th"})
"""Words before a number that name no segment: of any marker, and of the thoracic vertebrae."""
STILL_FOR, OTHERS_MOVE, MOSTLY = 10, 0.03, 0.9
"""Frames for which a marker stays at one place, m that the median of the others moves meanwhile, and share of the trial
beyond which it is a place that a model holds."""


def _predicted(seen: MarkerTrajectories) -> tuple[Float[np.ndarray, "n m 3"], float]:
    """By how much each marker leaves its course from one frame to the next [m], and the step of time [s]."""
    places = seen.positions
    return places[2:] - 2.0 * places[1:-1] + places[:-2], float(np.median(np.diff(seen.time)))


def jumps(trial: TrialInputs) -> Iterator[Contradiction]:
    """Markers that leave their course at once: a false detection, or labels of two that are exchanged from there on."""
    for seen in trial.recordings:
        if len(seen) < 4:
            continue
        leaving, step = _predicted(seen)
        limit = max(STEP, ACCELERATION * step**2)
        far = np.nan_to_num(np.linalg.norm(leaving, axis=2))
        jumping = [k for k in range(len(seen.names)) if (far[:, k] > limit).any()]
        pairs = _exchanged(seen, jumping, far, limit)
        for one, other, at in pairs:
            names = f"{seen.names[one]} and {seen.names[other]}"
            what = f"{names} take each other's place at {seen.time[at]:.2f} s"
            yield Contradiction(seen.source, "", what, "exchange the two labels from there on", refuse=True)
        alone = [k for k in jumping if not any(k in pair[:2] for pair in pairs)]
        for k in alone:
            frames = np.flatnonzero(far[:, k] > limit) + 1
            at = int(np.argmax(far[:, k])) + 1
            what = f"{seen.names[k]} leaves its course by {1e3 * far[at - 1, k]:.0f} mm within one frame"
            where = f"at {seen.time[at]:.2f} s" + (f" and in {len(frames) - 1} more frames" if len(frames) > 1 else "")
            yield Contradiction(seen.source, "", f"{what} {where}", "delete the frames in which it was not seen well")


def speeds(trial: TrialInputs) -> Iterator[Contradiction]:
    """The fastest marker, in all but a few frames."""
    for seen in trial.recordings:
        if len(seen) < 4:
            continue
        speed = np.linalg.norm(np.gradient(seen.positions, seen.time, axis=0), axis=2)
        usual = np.nan_to_num(np.nanpercentile(speed, NEARLY_ALWAYS, axis=0))
        k = int(np.argmax(usual))
        if usual[k] > FASTEST:
            rate = 1.0 / float(np.median(np.diff(seen.time)))
            what = f"{seen.names[k]} moves at {usual[k]:.0f} m/s, at {rate:.4g} frames in a second"
            yield Contradiction(seen.source, "", what, "are rate, time and unit of length right?")


def _exchanged(
    seen: MarkerTrajectories, jumping: list[int], far: Float[np.ndarray, "n m"], limit: float
) -> list[tuple[int, int, int]]:
    """Pairs of markers of which each lands where the other was, and the frame in which they do."""
    pairs: list[tuple[int, int, int]] = []
    for i, one in enumerate(jumping):
        for other in jumping[i + 1 :]:
            for at in np.flatnonzero((far[:, one] > limit) & (far[:, other] > limit)) + 1:
                before, after = seen.positions[at - 1 : at + 1][:, [one, other]]
                crossed, apart = np.linalg.norm(after - before[::-1], axis=1), np.linalg.norm(before[0] - before[1])
                if crossed.max() < SAME_PLACE * apart and crossed.max() < limit:
                    pairs.append((one, other, int(at)))
                    break
    return pairs


def upright(trial: TrialInputs) -> Iterator[Contradiction]:
    """The pelvis, or the head and shoulders, above the feet."""
    for seen in trial.recordings:
        high, low = middle(seen, ("asis", "psis", "sacrum")), middle(seen, FOOT)
        if high is None:
            high = middle(seen, ("shoulder", "c7", "head"))
        if high is None or low is None or not np.isfinite(high - low).all(axis=1).any():
            continue
        body = np.nanmedian(high - low, axis=0)
        if body @ trial.up > LYING or body @ trial.up > 0.5 * np.linalg.norm(body):
            continue
        k = int(np.argmax(np.abs(body)))
        along = f"{'-' if body[k] < 0 else ''}{'xyz'[k]}"
        what = f"the body is {1e3 * body @ trial.up:.0f} mm above the feet along the way up, {1e3 * abs(body[k]):.0f}"
        remedy = f"unless the person lies, try `axes` {axes_upright(body, trial.up, trial.turn)}"
        yield Contradiction(seen.source, "", f"{what} mm along {along}", remedy)


def handed(trial: TrialInputs) -> Iterator[Contradiction]:
    """Right and left of the pelvis against its front and back, or against where the feet point."""
    for seen in trial.recordings:
        right, front = _right(seen), _front(seen)
        if right is None or front is None:
            continue
        facing = np.cross(trial.up, right)
        size = np.linalg.norm(facing, axis=1) * np.linalg.norm(front, axis=1)
        with np.errstate(invalid="ignore"):
            cosine = np.sum(facing * front, axis=1) / size
        if not np.isfinite(cosine).any() or np.nanmedian(cosine) > -TURNED:
            continue
        what = "markers of the right side are on the left of the body, by where its front is"
        remedy = "are the labels of right and left exchanged, or is an axis mirrored or upside down?"
        yield Contradiction(seen.source, "", what, remedy)


def toes_ahead(trial: TrialInputs) -> Iterator[Contradiction]:
    """Toes before or behind the heel of each foot, by the front of the pelvis."""
    for seen in trial.recordings:
        front, back = middle(seen, ("asis",)), middle(seen, ("psis", "sacrum"))
        for side in ("right", "left"):
            toe, heel = middle(seen, ("toe",), side), middle(seen, ("heel",), side)
            if front is None or back is None or toe is None or heel is None:
                continue
            foot, body = (each - (each @ trial.up)[:, None] * trial.up for each in (toe - heel, front - back))
            with np.errstate(invalid="ignore"):
                size = np.linalg.norm(foot, axis=1) * np.linalg.norm(body, axis=1)
                cosine = np.sum(foot * body, axis=1) / size
            if np.isfinite(cosine).any() and np.nanmedian(cosine) < -TURNED:
                what = f"the toes of the {side} foot are behind its heel, by where the front of the pelvis is"
                yield Contradiction(seen.source, "", what, "are the labels of heel and toes exchanged?")


def _right(seen: MarkerTrajectories) -> Float[np.ndarray, "t 3"] | None:
    """From left to right of the pelvis, else of the shoulders, else of the feet [m]."""
    for kinds in (("asis",), ("psis",), ("hip",), ("shoulder",), FOOT):
        right, left = middle(seen, kinds, "right"), middle(seen, kinds, "left")
        if right is not None and left is not None:
            return np.asarray(right - left)
    return None


def _front(seen: MarkerTrajectories) -> Float[np.ndarray, "t 3"] | None:
    """Forwards, from the pelvis, else from the feet [m]."""
    front, back = middle(seen, ("asis",)), middle(seen, ("psis", "sacrum"))
    if front is not None and back is not None:
        return np.asarray(front - back)
    front, back = middle(seen, ("toe",)), middle(seen, ("heel",))
    return None if front is None or back is None else np.asarray(front - back)


def same_person(trial: TrialInputs) -> Iterator[Contradiction]:
    """Distances between markers of one segment while moving against those of the standing trial."""
    still, moving = trial.standing, trial.markers
    if still is None or moving is None or moving.time[-1] - moving.time[0] < MOVING_FOR:
        return
    names = tuple(name for name in moving.names if name in still.names and landmark(name)[0] not in HELD)
    i, j = np.triu_indices(len(names), 1)
    if not len(i):
        return
    now = np.linalg.norm(moving.of(names)[:, i] - moving.of(names)[:, j], axis=2)
    with np.errstate(invalid="ignore"):
        then = np.linalg.norm(np.nanmean(still.of(names), axis=0)[i] - np.nanmean(still.of(names), axis=0)[j], axis=1)
        rigid = np.nanstd(now, axis=0) < RIGID
        off = np.nanmedian(now, axis=0) - then
    rigid &= np.isfinite(off) & (then > 2.0 * MOVED)
    if rigid.sum() < FEWEST:
        return
    if np.median(np.abs(off[rigid])) > MOVED:
        what = f"distances of markers on one segment differ by {1e3 * np.median(np.abs(off[rigid])):.0f} mm (median)"
        remedy = "are both trials of one person, in one unit, with the same markers?"
        yield Contradiction(moving.source, "", f"{what} from those of {still.source}", remedy)
        return
    for k, name in enumerate(names):
        own = rigid & ((i == k) | (j == k))
        if own.sum() >= FEWEST and np.median(np.abs(off[own])) > MOVED:
            what = (
                f"{name} is {1e3 * np.median(np.abs(off[own])):.0f} mm elsewhere on its segment than in {still.source}"
            )
            yield Contradiction(moving.source, "", what, "has it been moved, or exchanged with another one?")


def segments_keep(trial: TrialInputs) -> Iterator[Contradiction]:
    """Distances between markers that by their labels are on one segment, over the trial."""
    seen = trial.markers
    if seen is None or trial.on_sole:
        return
    worst: dict[str, tuple[float, str]] = {}
    for names in _segments(seen.names):
        i, j = np.triu_indices(len(names), 1)
        places = seen.of(names)
        for a, b in zip(i, j, strict=True):
            apart = np.linalg.norm(places[:, a] - places[:, b], axis=1)
            apart = apart[np.isfinite(apart)]
            if len(apart) < LONG_ENOUGH:
                continue
            part = int(ENDS * len(apart))
            first, last = float(np.median(apart[:part])), float(np.median(apart[-part:]))
            low, high = np.percentile(apart, (2.5, 97.5))
            which = f"{names[a]} and {names[b]}"
            if abs(last - first) > MOVED:
                line = f"{which} are {1e3 * first:.0f} mm apart at the beginning and {1e3 * last:.0f} mm at the end"
            elif high - low > SWINGS:
                line = f"{which} are {1e3 * low:.0f} to {1e3 * high:.0f} mm apart"
            else:
                continue
            size = max(abs(last - first), float(high - low))
            if size > worst.get(names[0], (0.0, ""))[0]:
                worst[names[0]] = size, line
    for _, line in worst.values():
        remedy = "has one of them slipped, or is a label that of a marker elsewhere?"
        yield Contradiction(seen.source, "", f"{line}, by their labels on one segment", remedy)


def _segments(names: tuple[str, ...]) -> list[tuple[str, ...]]:
    """Labels that name one segment: its landmarks, or one word with a number behind it, RTH1 and RTH2; not single
    letters, as of vertebrae (T1 and T8), nor words for any marker (M1, marker_2).
    """
    found: dict[str, list[str]] = {}
    for name in names:
        kind, side = landmark(name)
        counted = re.fullmatch(r"(.*[A-Za-z])[ _.-]?\d", name)
        if kind in ("asis", "psis", "sacrum"):
            found.setdefault("pelvis", []).append(name)
        elif kind in FOOT:
            found.setdefault(f"foot {side}", []).append(name)
        elif kind in ("head", "knee"):
            found.setdefault(f"{kind} {side if kind == 'knee' else ''}", []).append(name)
        elif not kind and counted:
            word = re.sub("[^a-z]", "", counted[1].lower())
            if len(word) > 1 and word not in ANYWHERE:
                found.setdefault(counted[1].lower(), []).append(name)
    return [tuple(each) for each in found.values() if len(each) > 1]


def standing_still(trial: TrialInputs) -> Iterator[Contradiction]:
    """A marker at one and the same place while the others move on."""
    yield from straight_gaps(trial)
    seen = trial.markers
    if seen is None or len(seen.names) < FEWEST + 1 or len(seen) <= STILL_FOR:
        return
    places = seen.positions
    for k, same in held_steps(places, STILL_FOR).items():
        if landmark(seen.names[k])[0] in FOOT or same.mean() > MOSTLY:  # what a model holds where it is
            continue
        edges = np.flatnonzero(np.diff(np.r_[False, same, False].astype(int))).reshape(-1, 2)
        start, stop = edges[edges[:, 1] - edges[:, 0] >= STILL_FOR].T
        moved = np.linalg.norm(np.delete(places[stop] - places[start], k, axis=1), axis=2)
        moved = np.nan_to_num(np.nanmedian(moved, axis=1))
        if (moved > OTHERS_MOVE).any():
            at = int(np.argmax(moved > OTHERS_MOVE))
            what = f"{seen.names[k]} stays at one place from {seen.time[start[at]]:.2f} to {seen.time[stop[at]]:.2f} s"
            what += f", while others move by {1e3 * moved[at]:.0f} mm"
            yield Contradiction(seen.source, "", what, "is a gap filled with its last place? leave gaps empty")


def flat_foot(trial: TrialInputs) -> Iterator[Contradiction]:
    """Heel and toes of the standing trial against each other, and against the floor that is taken."""
    still = trial.standing
    if still is None:
        return
    for side in ("right", "left"):
        heel, toe = (float(_height(still, (kind,), side, trial)) for kind in ("heel", "toe"))
        if abs(heel - toe) > LEVEL:
            what = f"heel and toes of the {side} foot are {1e3 * heel:.0f} and {1e3 * toe:.0f} mm high while standing"
            yield Contradiction(still.source, "", what, "does the foot stand flat there, and are the labels right?")
        lowest = min(heel, toe) if np.isfinite(heel) and np.isfinite(toe) else np.nan
        if trial.floor is not None and not np.isnan(lowest):
            above = lowest - trial.floor
            if not ON_FLOOR[0] <= above <= ON_FLOOR[1]:
                what = f"the lowest marker of the {side} foot is {1e3 * above:.0f} mm above the floor while standing"
                yield Contradiction(still.source, "", what, f"is the floor at {trial.floor:g} m along the way up?")


def _height(seen: MarkerTrajectories, kinds: tuple[str, ...], side: str, trial: TrialInputs) -> float:
    """Median height of the lowest landmark of these kinds [m]; NaN where there is none."""
    places = points(seen, kinds, side) @ trial.up
    known = places[np.isfinite(places).all(axis=1)] if places.shape[1] else places[:0]
    return float(np.median(known.min(axis=1))) if len(known) else float("nan")


def same_floor(trial: TrialInputs) -> Iterator[Contradiction]:
    """The least height of a heel in a walk against its height in the standing trial."""
    still, seen = trial.standing, trial.markers
    if still is None or seen is None or not trial.plates:
        return
    for side in ("right", "left"):
        places = points(seen, ("heel",), side) @ trial.up
        if not places.size or not np.isfinite(places).any():
            continue
        lowest, standing = float(np.nanpercentile(places, 2.0)), _height(still, ("heel",), side, trial)
        if abs(lowest - standing) > FLOORS:
            what = f"the heel of the {side} foot comes down to {1e3 * lowest:.0f} mm in the walk"
            what += f", and stands at {1e3 * standing:.0f} mm in {still.source}"
            yield Contradiction(seen.source, "", what, "have both trials one origin, and one floor?")


MARKER_CHECKS = (
    Check(
        "jump",
        "a marker with its own course, and with others that jump in the same frame",
        f"{1e3 * STEP:.0f} mm from one frame to the next, or {ACCELERATION:.0f} m/s² where frames are far apart; "
        "six people who walk have 40 to 190 m/s²",
        jumps,
        of_all=False,
    ),
    Check(
        "speed",
        "speed of the fastest marker with that of people",
        f"{FASTEST:g} m/s in {100 - NEARLY_ALWAYS:g} % of the frames, a sprinter's foot; people who walk have 5 m/s",
        speeds,
    ),
    Check(
        "upright",
        "pelvis, or head and shoulders, with the feet, along the way up",
        f"{1e3 * LYING:.0f} mm; who sits on the floor has about 100 mm",
        upright,
    ),
    Check(
        "right and left",
        "right and left of pelvis, shoulders or feet with front and back",
        f"a cosine below {-TURNED}, in the median of all frames",
        handed,
    ),
    Check(
        "heel and toes",
        "from heel to toes of each foot with from back to front of the pelvis",
        f"a cosine below {-TURNED}, in the median of all frames",
        toes_ahead,
    ),
    Check(
        "standing trial",
        "distances of markers on one segment with those of the standing trial",
        f"{1e3 * MOVED:.0f} mm, of pairs that keep their distance to {1e3 * RIGID:.0f} mm, arms left out; skin "
        "moves by 5 to 20 mm",
        same_person,
    ),
    Check(
        "one segment",
        "distances on one segment, by its labels, at both ends and over the trial",
        f"{1e3 * MOVED:.0f} mm, or {1e3 * SWINGS:.0f} mm in the middle 95 %; eight people have 14 and "
        "27 mm at most, on wands 61 mm",
        segments_keep,
    ),
    Check(
        "frozen marker",
        "the place of a marker with those of the others",
        f"{STILL_FOR} frames at one place while the median of the others moves by {1e3 * OTHERS_MOVE:.0f} mm; "
        f"{STRAIGHT} straight to {1e3 * EVEN:g} mm between kinks of {1e3 * KINK:g} mm",
        standing_still,
    ),
    Check(
        "foot while standing",
        "heights of heel and toes with each other, and with the floor where the analysis takes one",
        f"{1e3 * LEVEL:.0f} mm; {1e3 * ON_FLOOR[0]:.0f} to {1e3 * ON_FLOOR[1]:.0f} mm above the floor",
        flat_foot,
    ),
    Check(
        "floor of both trials",
        "least height of the heel in the walk with its height in the standing trial",
        f"{1e3 * FLOORS:.0f} mm",
        same_floor,
    ),
)
"""Checks that need markers only."""
