"""Centre or axis of a joint from markers: `geocontact joint`, `gc.functional_joint`.

>>> import geocontact as gc
>>> leg = gc.virtual_markers("meshes/leg_swing.mot", model="meshes/leg.osim").write("leg")
>>> thigh, shank = (",".join(f"{body}_r{k}" for k in range(3)) for body in ("femur", "tibia"))
>>> gc.functional_joint(leg / "markers.trc", first=thigh, second=shank, axis=True).sentences[0]
'axis through 54.2, -345.8, -7.1 mm along 0.000, -0.021, 1.000 in the frame of femur_r0, femur_r1, femur_r2'
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import contradicted, judge, reserve, results, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import finite, plain, write_json
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.motion.functional_joint.options import JointOptions
from geocontact.analyses.motion.functional_joint.read import MovedPair, Segment, marker_list, means_of, read
from geocontact.analyses.motion.functional_joint.show import joint_curves, joint_page
from geocontact.analyses.motion.goodness import goodness_of_joint
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.dynamics.functional_joint import JointPoints, apart_in_halves, axis_points, centre_points, segment_poses
from geocontact.io.mocap.trc import write_trc
from geocontact.view.curves.drawn import drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class JointResult(Result):
    """Centre or axis of a joint.

    Parameters
    ----------
    pair
        Both segments along the trial.
    points
        Of the joint, in both segments' frames [m].
    markers
        Of the standing trial, else of the trial, with the joint's own [m].
    summary
        What `joint.json` holds, with units in the names.
    """

    options: JointOptions
    pair: MovedPair
    points: JointPoints
    markers: MarkerTrajectories
    summary: dict[str, Any]

    @property
    def point(self) -> Float[np.ndarray, " 3"]:
        """Centre, or middle of the axis, in the first segment's frame [m]; `summary["frame"]` says which that is."""
        return self.points.middle

    @property
    def rms(self) -> float:
        """Residual between what both segments say, root mean square over the frames [m]."""
        return self.points.rms

    def places(self) -> tuple[Float[np.ndarray, "t 3"], Float[np.ndarray, "t 3"]]:
        """Middle of the joint in the laboratory, as the first and as the second segment have it [m]."""
        one = self.pair.first_poses.apply(self.points.middle)
        return one, self.pair.second_poses.apply(self.points.second.mean(axis=0))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`joint` over the frames of the trial that show both segments [mm]."""
        one, other = self.places()
        columns = {
            f"{which}_{axis} [mm]": 1e3 * places[:, k]
            for which, places in (("first", one), ("second", other))
            for k, axis in enumerate("xyz")
        }
        apart = 1e3 * np.linalg.norm(one - other, axis=1)
        return {"joint": pd.DataFrame({"time [s]": self.pair.time, **columns, "apart [mm]": apart})}

    def figure(self) -> Figure:
        """Distance between what both segments say, over time."""
        return drawn(joint_curves(self.pair, self.table()["apart [mm]"].to_numpy()))

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Both segments and the joint as they move, and how far it is off itself."""
        title, apart = f"Joint from {self.options.trial.name}", self.table()["apart [mm]"].to_numpy()
        return {REPORT: joint_page(title, self.sentences, self.facts(), self.pair, self.points, apart)}

    def facts(self) -> list[tuple[str, str]]:
        """The few numbers that belong to the answer, each with its name."""
        s, first = self.summary, self.summary["first"]
        place = ", ".join(f"{value:.1f}" for value in first["point_mm"]) + " mm"
        told = [] if self.fit_outcome == "contradicts" else [("place in the first segment", place)]
        if "point_sd_mm" in first:
            told.append(("largest standard error", f"{max(first['point_sd_mm']):.2f} mm"))
        if "direction" in first:
            told.append(("direction", ", ".join(f"{value:.3f}" for value in first["direction"])))
        told.append(("residual, root mean square", f"{s['apart_rms_mm']:.2f} mm"))
        if s["halves_apart_mm"] is not None:
            told.append(("halves of the trial apart", f"{s['halves_apart_mm']:.2f} mm"))
        return [*told, ("largest rotation between two frames", f"{s['turn_deg']:.0f}°")]

    def write_files(self, folder: Path) -> None:
        """joint.json and markers.trc [mm] besides."""
        write_json(folder / "joint.json", self.summary)
        write_trc(folder / "markers.trc", self.markers)
        super().write_files(folder)


SKIN = 0.01
"""m; markers of a segment that are farther from a rigid one move on the skin or were exchanged."""
APART = 0.02
"""m; halves of a trial that give the joint farther apart do not tell it; the number is a convention of this command."""
LOOSE = 0.5
"""Looseness of an axis from which on a point fits as well."""
LAGS, CLEARER = 0.25, 0.5
"""s of lag between two segments that are tried; share of the residual that stays without a lag which is one."""
FRAME = "axes of the markers as written, while standing or in the first whole frame; origin: the mean of its markers"
SEVERAL = {"axis": "axes", "centre": "centres"}
MOVE = "move the joint through its range, a hip forward, sideways and round, with all markers in sight"
BEND = "bend and stretch the hinge through its whole range several times, with all markers in sight"
COMPARED, AT_ONCE = 10_000, 250
"""Frames whose rotations are compared with each other, and rows of that table at a time."""


def run(pair: MovedPair, o: JointOptions) -> JointResult:
    """Points in both segments, over the trial, and as markers."""
    near = pair.near(None if o.near is None else marker_list(o.near)) if o.axis else None
    try:
        poses = pair.first_poses, pair.second_poses
        points = centre_points(*poses) if near is None else axis_points(*poses, near)
    except ValueError as error:
        raise InputError(o.trial, "", str(error), BEND if o.axis else f"{MOVE}; for a hinge give `axis`") from error
    halves = apart_in_halves(*poses, near)
    _warn_late(o, pair, points, near)
    judge(goodness_of_joint(points, _spread(pair), pair.off, halves), warned=True)
    if contradicted():  # without standard errors: they are those of a joint that is there
        points = replace(points, first_sd=None, second_sd=None)
    summary = _summary(o, pair, points, halves)
    results().update(plain(summary))
    _warn(o, pair, points)
    _report(o, pair, points, halves, summary)
    return JointResult(
        options=o,
        pair=pair,
        points=points,
        markers=_beside(pair.shown, o, pair.first, points),
        summary=summary,
    )


def turned(pair: MovedPair) -> float:
    """Largest angle by which the second segment turns in the first between any two frames [rad].

    Of longer trials every k-th frame is compared, `COMPARED` at most, and the angle may be larger between others.
    Rotations q and p differ by 2 arccos |q . p|, so that the least product of quaternions tells which two they are.
    """
    relative = pair.first_poses.rotation.inv() * pair.second_poses.rotation
    relative = relative[:: -(-len(relative) // COMPARED)]
    each = relative.as_quat()
    least, ends = 2.0, (0, 0)
    for start in range(0, len(each), AT_ONCE):
        products = np.abs(each[start : start + AT_ONCE] @ each[start:].T)
        row, column = divmod(int(products.argmin()), products.shape[1])
        if products[row, column] < least:
            least, ends = products[row, column], (start + row, start + column)
    return float((relative[ends[0]].inv() * relative[ends[1]]).magnitude())


def _spread(pair: MovedPair) -> float:
    """Root mean square by which the origins of the segments move against each other in the laboratory [m]."""
    away = pair.second_poses.translation - pair.first_poses.translation
    return float(np.sqrt(np.mean(np.sum((away - away.mean(axis=0)) ** 2, axis=1))))


def _summary(o: JointOptions, pair: MovedPair, points: JointPoints, halves: float) -> dict[str, object]:
    """What `joint.json` holds."""
    beside = {"first": pair.first, "second": pair.second}
    told: dict[str, object] = {
        "kind": "axis" if o.axis else "centre",
        "frames": len(pair.time),
        "turn_deg": float(np.degrees(turned(pair))),
        "apart_rms_mm": 1e3 * points.rms,
        "halves_apart_mm": finite(1e3 * halves),
        "frame": FRAME,
    }
    if points.looseness is not None:
        told["looseness"] = points.looseness
    of = (points.first, points.first_sd, pair.off[0]), (points.second, points.second_sd, pair.off[1])
    for (name, segment), (places, sd, off) in zip(beside.items(), of, strict=True):
        told[name] = {
            "markers": segment.names,
            "point_mm": (1e3 * places.mean(axis=0)).tolist(),
            **({} if sd is None else {"point_sd_mm": (1e3 * sd).tolist()}),
            **({} if len(places) == 1 else {"direction": _direction(places).tolist()}),
            "markers_rms_mm": 1e3 * off,
        }
    return told


def _direction(places: Float[np.ndarray, "2 3"]) -> Float[np.ndarray, " 3"]:
    along = places[1] - places[0]
    return np.asarray(along / np.linalg.norm(along))


def _late(pair: MovedPair, points: JointPoints, near: Float[np.ndarray, " 3"] | None) -> tuple[float, float] | None:
    """By how much the second segment is later than the first [s], and the residual without that [m].

    None where no lag up to `LAGS` makes the residual that of a joint, or frames are not evenly spaced.
    """
    step = float(np.median(np.diff(pair.time)))
    if points.rms <= APART or np.ptp(np.diff(pair.time)) > 0.5 * step:
        return None
    found, count = {}, len(pair.time)
    for k in range(1, min(round(LAGS / step), count // 2) + 1):
        for lag, first, second in ((k, slice(count - k), slice(k, None)), (-k, slice(k, None), slice(count - k))):
            poses = pair.first_poses[first], pair.second_poses[second]
            with suppress(ValueError):  # such a part does not determine the joint
                found[lag] = (centre_points(*poses) if near is None else axis_points(*poses, near)).rms
    if not found:
        return None
    best = min(found, key=found.__getitem__)
    return (best * step, found[best]) if found[best] < min(APART, CLEARER * points.rms) else None


def _warn_late(o: JointOptions, pair: MovedPair, points: JointPoints, near: Float[np.ndarray, " 3"] | None) -> None:
    late = _late(pair, points, near)
    if late is not None:
        when = "later" if late[0] > 0.0 else "earlier"
        what = f"markers of the second segment move {abs(late[0]):.2f} s {when} than those of the first"
        rests = f"residual of the joint {1e3 * points.rms:.0f} mm, and {1e3 * late[1]:.0f} mm without that lag"
        reserve(f"{o.trial}: {what} ({rests}): put both on one clock", cause=True)


def _warn(o: JointOptions, pair: MovedPair, points: JointPoints) -> None:
    for option, segment, off in (("`first`", pair.first, pair.off[0]), ("`second`", pair.second, pair.off[1])):
        if off > SKIN:
            what = f"{', '.join(segment.names)} are {1e3 * off:.0f} mm from a rigid segment, root mean square"
            reserve(f"{option}: {what}: skin that slides, or names exchanged")
    if points.rms > APART:
        what = f"the joint of one segment is {1e3 * points.rms:.0f} mm from that of the other, root mean square"
        reserve(f"{o.trial}: {what}: are these two neighbouring segments?")
    if points.looseness is not None and points.looseness > LOOSE:
        reserve(f"{o.trial}: a point fits as well as an axis (looseness {points.looseness:.2f}): is it a hinge?")


def _report(o: JointOptions, pair: MovedPair, points: JointPoints, halves: float, summary: Mapping[str, Any]) -> None:
    kind = "axis" if o.axis else "centre"
    say(f"{place_words(points)} in the frame of {', '.join(pair.first.names)}{_error_words(points)}")
    if points.looseness is not None and (turn := _from_near(o, pair, points)) is not None:
        say(f"the axis is {np.degrees(turn):.1f} deg from the line through {' and '.join(marker_list(o.near or ''))}")
    both = "" if np.isnan(halves) else f"; halves of the trial give {SEVERAL[kind]} {1e3 * halves:.1f} mm apart"
    off = f"residual between the segments {1e3 * points.rms:.1f} mm root mean square"
    range_of = f"{summary['turn_deg']:.0f} degrees between the two that are turned farthest apart"
    say(f"{len(pair.time)} frames, {range_of}: {off}{both}")
    if np.isnan(halves):
        reserve(f"{o.trial}: half of the trial does not determine the {kind}: its repeatability is unknown")
    elif halves > APART:
        what = f"two halves of the trial give the {kind} {1e3 * halves:.0f} mm apart"
        reserve(f"{o.trial}: {what}: {BEND if o.axis else MOVE}")


def place_words(points: JointPoints) -> str:
    """Where the joint is in the first segment's frame: "centre at 1.0, 2.0, 3.0 mm"."""
    at = ", ".join(f"{1e3 * value:.1f}" for value in points.middle)
    if len(points.first) == 1:
        return f"centre at {at} mm"
    return f"axis through {at} mm along {', '.join(f'{value:.3f}' for value in _direction(points.first))}"


def _error_words(points: JointPoints) -> str:
    sd = points.first_sd
    return "" if sd is None else f" (standard errors {', '.join(f'{1e3 * value:.1f}' for value in sd)} mm)"


def _from_near(o: JointOptions, pair: MovedPair, points: JointPoints) -> float | None:
    """Angle [rad] between the axis and the line of the two markers that `near` names; None for any other count."""
    names = () if o.near is None else marker_list(o.near)
    if len(names) != 2:
        return None
    means_of(pair.shown, names, "`near`")  # refuses markers that no frame shows
    poses, known, _ = segment_poses(pair.shown.of(pair.first.names), pair.first.template)
    ends = [np.nanmean(poses.inv().apply(pair.shown.of((name,))[known, 0]), axis=0) for name in names]
    line = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    return float(np.arccos(min(abs(line @ _direction(points.first)), 1.0)))


def _beside(shown: MarkerTrajectories, o: JointOptions, first: Segment, points: JointPoints) -> MarkerTrajectories:
    """Markers of a trial with the joint's own added, which move with the first segment."""
    names = (o.name,) if len(points.first) == 1 else (f"{o.name}_1", f"{o.name}_2")
    taken = [name for name in names if name in shown.names]
    if taken:
        raise InputError(shown.source, "`name`", f"there is a marker {taken[0]} already", "give another name")
    poses, known, _ = segment_poses(shown.of(first.names), first.template)
    places: Float[np.ndarray, "t p 3"] = np.full((len(shown), len(names), 3), np.nan)
    for k, point in enumerate(points.first):
        places[known, k] = poses.apply(point)
    together = np.concatenate([shown.positions, places], axis=1)
    return MarkerTrajectories(shown.time, together, (*shown.names, *names), shown.source)


functional_joint = Job("joint", JointOptions, read, run)
