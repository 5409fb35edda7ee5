"""Joint angles from recorded markers: `geocontact ik`, `gc.inverse_kinematics`.

>>> import geocontact as gc
>>> markers = gc.virtual_markers("meshes/leg_swing.mot", model="meshes/leg.osim").write("virtual") / "markers.trc"
>>> result = gc.inverse_kinematics(markers, model="meshes/leg.osim")
>>> print(result)
101 frames, 16 markers: 0.0 mm from the model, root mean square, and 0.0 mm at most, foot_r2 at 0.57 s
(OpenSim advises less than 20 and 40 mm)
>>> list(result.table("coordinates"))[:3]
['time [s]', 'tilt [deg]', 'list [deg]']
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import judge, listener, reserve, results, say, seen_from_results
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain, write_json
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.motion.bids_dataset import FOLDER, write_dataset
from geocontact.analyses.motion.gait_cycles import cycles_table
from geocontact.analyses.motion.goodness import goodness_of_poses, of_ends
from geocontact.analyses.motion.inverse_kinematics.knees import knee_table
from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.analyses.motion.inverse_kinematics.read import KinematicsInputs, read
from geocontact.analyses.motion.inverse_kinematics.segment_fit import SegmentFit
from geocontact.analyses.motion.inverse_kinematics.show import kinematics_curves, kinematics_page, segments_page
from geocontact.analyses.motion.joint_angles import joint_angles_table, warn_of_gimbal_lock
from geocontact.analyses.motion.marker_tasks import MOVING, MarkerErrors
from geocontact.analyses.motion.markers import exchange_question, warn_of_tilt
from geocontact.analyses.motion.panels import printed
from geocontact.data.bids_name import BidsName
from geocontact.data.errors import InputError
from geocontact.data.gait_events import STANCE
from geocontact.dynamics.exchanged_markers import exchanged_markers
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.dynamics.inverse_kinematics import inverse_kinematics as kinematics_of
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.identify.signals.gait_cycles import GaitCycles, gait_cycles
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.osim_scaler import write_scaled_model
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.opensim.tool_setup_writer import write_ik_setup
from geocontact.io.text.tables import listed
from geocontact.view.curves.drawn import drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class IkResult(Result):
    """Coordinates of a model over time.

    Parameters
    ----------
    seen
        Model, markers and weights.
    poses
        Coordinates [rad, m] and distances of the markers [m] of every frame.
    cycles
        Coordinates [deg, m] over the gait cycle, where there are heel strikes.
    summary
        Numbers of the whole recording, with units in their names.
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"coordinates"})

    options: IkOptions
    seen: KinematicsInputs
    poses: Poses
    cycles: GaitCycles
    summary: dict[str, Any]

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of the frames [s]."""
        return self.poses.time

    @property
    def coordinates(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Each coordinate over time [rad, m], by its name."""
        return dict(zip(self.poses.names, np.asarray(self.poses.values).T, strict=True))

    @property
    def rms_mm(self) -> float:
        """Distance of the markers, or origins of segments, from the model, root mean square [mm].

        NaN where sensors recorded no place.
        """
        return float(self.summary.get("rms_mm", np.nan))

    @property
    def markers_mm(self) -> dict[str, dict[str, float]]:
        """Root mean square and largest distance of each marker that was seen [mm]; nothing of segments."""
        return dict(self.summary.get("markers", {}))

    @property
    def segment_fit(self) -> SegmentFit | None:
        """Angles and distances of segments from the model; None where markers were recorded."""
        return None if self.seen.segments is None else SegmentFit.of(self.poses, self.seen.segments)

    @property
    def rms(self) -> float:
        """Distance of the markers from the model, root mean square over markers and frames [m]."""
        return 1e-3 * self.rms_mm

    @property
    def distances(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Distance of each marker from the model over time [m]; NaN where it was not seen."""
        return dict(zip(self.poses.markers, np.asarray(self.poses.distances).T, strict=True))

    @property
    def squared_error(self) -> Float[np.ndarray, " t"]:
        """Sum of the squared distances of the markers from the model in every frame [m^2]; 0 where none was seen."""
        return squares_of(self.poses)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`coordinates` [deg, m], `markers` or `segments`; `knees`, `angles`, `cycles`, `naming` if any."""
        p = self.poses
        units = ["deg" if c.kind == "rotational" else "m" for c in self.seen.model.coordinates]
        values = printed(self.seen.model.coordinates, p.values).T
        angles = {f"{name} [{unit}]": v for name, unit, v in zip(p.names, units, values, strict=True)}
        found = {"coordinates": pd.DataFrame({"time [s]": p.time, **angles})}
        fit = self.segment_fit
        found |= {"markers": self._distances()} if fit is None else {"segments": fit.table()}
        if self.seen.knees:
            found["knees"] = knee_table(self.seen.model, p, self.seen.knees)
        if (form := self.options.joint_angles) is not None:
            found["angles"] = joint_angles_table(self.seen.model, p.time, np.asarray(p.values), form)
        if self.seen.naming is not None:
            found["naming"] = self.seen.naming.table()
        return {**found, "cycles": cycles_table(self.cycles)} if self.cycles else found

    def figure(self) -> Figure:
        """Angles of all joints over time, and how far the markers are from the model."""
        return drawn(kinematics_curves(self.seen.model, self.poses, self.segment_fit))

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Coordinates over time, and how far each marker is from the model."""
        title, seen = f"Inverse kinematics of {self.options.markers.name}", self.seen
        said = self.sentences[1:] if self.fit_outcome == "contradicts" else self.sentences
        if (fit := self.segment_fit) is not None and seen.segments is not None:
            return {REPORT: segments_page(title, seen.model, self.poses, self.cycles, said, seen.segments, fit)}
        return {REPORT: kinematics_page(title, seen.model, self.poses, seen.markers, self.cycles, said, seen.naming)}

    def write_files(self, folder: Path) -> None:
        """ik.mot for OpenSim, its set-up with markers as read and ik.json besides; analog.sto if asked for."""
        values = printed(self.seen.model.coordinates, self.poses.values)
        file = folder / "ik.mot"
        write_storage(file, self.poses.time, self.poses.names, values, title="Coordinates", degrees=True)
        if self.seen.segments is None:
            self._write_marker_errors(folder)
            self._write_setup(folder)
        if (analog := self.seen.analog) is not None:
            names = [name.replace(" ", "_") for name in analog.channels]
            write_storage(folder / "analog.sto", analog.time, names, analog.values, title="Analog", degrees=False)
        if self.options.bids is not None:
            markers = self.seen.markers if self.seen.segments is None else None
            write_dataset(folder / FOLDER, BidsName.of(self.options.bids), self.seen.model, self.poses, markers)
        write_json(folder / "ik.json", self.summary)
        super().write_files(folder)

    def _write_marker_errors(self, folder: Path) -> None:
        """Errors as OpenSim's tool writes them: m^2 and m, not weighted, over the markers that were seen in a frame."""
        off = self.poses.distances
        seen = np.isfinite(off).sum(axis=1)
        rms = np.sqrt(self.squared_error / np.maximum(seen, 1))
        largest = np.max(np.where(np.isfinite(off), off, 0.0), axis=1, initial=0.0)
        values = np.column_stack([self.squared_error, rms, largest])
        file = folder / f"{self.options.markers.stem}_ik_marker_errors.sto"
        write_storage(file, self.poses.time, MARKER_ERRORS, values, title="Model Marker Errors from IK", degrees=False)

    def _write_setup(self, folder: Path) -> None:
        """With which OpenSim's own tool finds the same."""
        o, seen = self.options, self.seen
        model = seen_from_results(o.model)
        if o.marker_set is not None or seen.naming is not None:  # OpenSim's tool takes the model's own markers only
            model = "model.osim"
            write_scaled_model(o.model, folder / model, seen.model, {})
        write_trc(folder / "seen.trc", seen.markers)
        span = float(self.poses.time[0]), float(self.poses.time[-1])
        follow = "" if o.follow is None else seen_from_results(o.follow)
        write_ik_setup(folder / "setup_ik.xml", model, "seen.trc", follow, seen.tasks, span, out="opensim_ik.mot")

    def _distances(self) -> pd.DataFrame:
        off = {f"{name} [mm]": 1e3 * d for name, d in zip(self.poses.markers, self.poses.distances.T, strict=True)}
        return pd.DataFrame({"time [s]": self.poses.time, **off})


MARKER_ERRORS = ("total_squared_error", "marker_error_RMS", "marker_error_max")
"""Columns of OpenSim's file of marker errors [m^2, m, m]."""
UNTOLD = 1.0 / 3.0  # share of the coordinates beyond which the rest means little


def run(seen: KinematicsInputs, o: IkOptions) -> IkResult:
    """Coordinates of every frame, how far the markers are from the model, and what sums them up."""
    tree = tree_of(seen.model)
    if o.bids is not None and len(seen.markers) < 2:
        raise InputError(o.markers, "`bids`", "needs a rate, and there is one frame", "give a recording of several")
    began = time.perf_counter()
    with listener().progress("frames", len(seen.markers)) as step:
        try:
            found = kinematics_of(tree, seen.markers, seen.tasks, lambda _: step(), fill=o.fill)
        except ValueError as error:
            raise InputError(o.markers, "", str(error), "is it the right file?") from error
    fit = None if seen.segments is None else SegmentFit.of(found, seen.segments)
    summary = {**_summary(found, time.perf_counter() - began), **(_of_markers(found) if fit is None else fit.summary())}
    cycles = _cycles(seen, found, o)
    if cycles:
        summary["gait_cycles"] = cycles.counts
    result = IkResult(options=o, seen=seen, poses=found, cycles=cycles, summary=summary)
    results().update(plain(summary))
    exchanged = fit is None and _warn_of_markers(tree, seen, found)
    if not exchanged and "upright" not in seen.doubts:
        warn_of_tilt(seen.model, found.values, o.axes)
    _warn(found, "markers" if fit is None else "segments")
    if o.joint_angles is not None:
        warn_of_gimbal_lock(seen.model, found.time, np.asarray(found.values), o.joint_angles)
    for end in of_ends(found, seen.model):
        reserve(f"{end.what}: the {'markers ask' if fit is None else 'segments ask'} for an angle beyond it")
    for doubt in () if fit is None else fit.doubts():
        reserve(f"{doubt.what}: check `markers_map`, `axes`, `heading` and the pose of the calibration")
    judge(goodness_of_poses(found, seen.model, MOVING, fit), warned=True)
    told = "" if (free := _never(found)) <= UNTOLD * len(found.names) else f"{free} of {len(found.names)} coordinates "
    told = told and f"{told}are not determined; "
    what = f"{len(found.markers)} markers: {MarkerErrors.of(found).words(MOVING)}" if fit is None else fit.sentence()
    say(f"{told}{len(found.time)} frames, {what}")
    return result


def _warn_of_markers(tree: Tree, seen: KinematicsInputs, found: Poses) -> bool:
    """A warning of markers far from the model; whether exchanged names explain it."""
    exchanged = exchanged_markers(tree, seen.markers, seen.tasks, found, MOVING.rms, MOVING.largest)
    MarkerErrors.of(found).warn(MOVING, "" if exchanged is None else exchange_question(exchanged))
    return exchanged is not None


def _never(found: Poses) -> int:
    """Coordinates that no frame tells."""
    return int((~found.determined.any(axis=0)).sum())


def _cycles(seen: KinematicsInputs, found: Poses, o: IkOptions) -> GaitCycles:
    coordinates = seen.model.coordinates
    units = ["deg" if c.kind == "rotational" else "m" for c in coordinates]
    values = printed(coordinates, found.values)
    cycles = gait_cycles(found.time, found.names, units, values, seen.strikes, seen.offs, o.part)
    if o.part is not None and not cycles:
        what = (
            "has no effect: no cycle with a toe off" if o.part == STANCE else "has no effect without two heel strikes"
        )
        raise InputError("", "`part`", what, "give `events`, or leave it out")
    return cycles


def squares_of(found: Poses) -> Float[np.ndarray, " t"]:
    """Sum of the squared distances of the markers from the model in every frame [m^2]."""
    return np.asarray(np.nansum(np.square(found.distances), axis=1))


def _summary(found: Poses, seconds: float) -> dict[str, object]:
    """Numbers of the whole recording, as `ik.json` holds them."""
    missing = ~np.isfinite(found.values)
    filled = ~found.determined & ~missing & found.determined.any(axis=0)
    return {
        "frames": len(found.time),
        "frames_per_second": len(found.time) / seconds,
        "steps_mean": float(found.steps.mean()),
        "unsettled_frames": int((~found.settled).sum()),
        "filled_frames": {n: int(k) for n, k in zip(found.names, filled.sum(axis=0), strict=True) if k},
        "missing_frames": {n: int(k) for n, k in zip(found.names, missing.sum(axis=0), strict=True) if k},
    }


def _of_markers(found: Poses) -> dict[str, object]:
    """Distances of markers, as `ik.json` holds them."""
    squares = {
        name: {"rms_mm": float(np.sqrt(np.mean(d[there] ** 2))), "max_mm": float(d[there].max())}
        for name, d in zip(found.markers, 1e3 * found.distances.T, strict=True)
        if (there := np.isfinite(d)).any()
    }
    return {
        "rms_mm": 1e3 * float(np.sqrt(np.nanmean(found.distances**2))),
        "total_squared_error_m2": [float(np.min(squares_of(found))), float(np.max(squares_of(found)))],
        "max_mm": 1e3 * float(np.nanmax(found.distances)),
        "markers": squares,
    }


def _warn(found: Poses, recorded: str) -> None:
    if not found.settled.all():
        count = int((~found.settled).sum())
        reserve(f"{count} frames did not converge: {recorded} and model may not match")
    never = np.asarray(~found.determined.any(axis=0))
    if never.any():
        names = tuple(name for name, each in zip(found.names, never, strict=True) if each)
        reserve(f"no frame determines {listed(names)}: set to the model's default")
    for lost, what in (
        (~found.determined & np.isfinite(found.values) & ~never, "filled between frames that determine them"),
        (~np.isfinite(found.values), f"left empty, {recorded} do not determine them"),
    ):
        names = tuple(name for name, each in zip(found.names, lost.any(axis=0), strict=True) if each)
        if names:
            frames = found.time[lost.any(axis=1)]
            span = f"{len(frames)} frames from {frames[0]:g} to {frames[-1]:g} s"
            reserve(f"{span}: {what}: {listed(names)}")


inverse_kinematics = Job("ik", IkOptions, read, run)
