"""Joint angles from markers."""

from __future__ import annotations

import time

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.motion.exchanged_markers import exchanged_markers
from geocontact.analyses.motion.gait_cycles import GaitCycles, gait_cycles
from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.analyses.motion.inverse_kinematics.read import KinematicsInputs
from geocontact.analyses.motion.inverse_kinematics.result import IkResult
from geocontact.analyses.motion.marker_errors import MOVING, MarkerErrors
from geocontact.analyses.motion.printed import printed
from geocontact.analyses.motion.upright import warn_of_tilt
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.tree import tree_of
from geocontact.io.text.tables import listed

UNTOLD = 1.0 / 3.0  # share of the coordinates beyond which the rest means little


def run(seen: KinematicsInputs, o: IkOptions, record: Record) -> IkResult:
    """Coordinates of every frame, how far the markers are from the model, and what sums them up."""
    tree = tree_of(seen.model)
    began = time.perf_counter()
    with record.listener.progress("frames", len(seen.markers)) as step:
        try:
            found = inverse_kinematics(tree, seen.markers, seen.tasks, lambda _: step(), fill=o.fill)
        except ValueError as error:
            raise InputError(o.markers, "", str(error), "is it the right file?") from error
    summary = _summary(found, time.perf_counter() - began)
    cycles = _cycles(seen, found)
    if cycles:
        summary["gait_cycles"] = cycles.counts
    result = IkResult(record=record, options=o, seen=seen, poses=found, cycles=cycles, summary=summary)
    record.results.update(plain(summary))
    errors = MarkerErrors.of(found)
    exchanged = exchanged_markers(tree, seen.markers, seen.tasks, found)
    errors.warn(record, MOVING, "" if exchanged is None else exchanged.words)
    if exchanged is None:
        warn_of_tilt(record, seen.model, found.values, o.axes)
    _warn(record, found)
    told = "" if (free := _never(found)) <= UNTOLD * len(found.names) else f"{free} of {len(found.names)} coordinates "
    told = told and f"{told}are not determined; "
    record.say(f"{told}{len(found.time)} frames, {len(found.markers)} markers: {errors.words(MOVING)}")
    return result


def _never(found: Poses) -> int:
    """Coordinates that no frame tells."""
    return int((~found.determined.any(axis=0)).sum())


def _cycles(seen: KinematicsInputs, found: Poses) -> GaitCycles:
    coordinates = seen.model.coordinates
    units = ["deg" if c.kind == "rotational" else "m" for c in coordinates]
    return gait_cycles(found.time, found.names, units, printed(coordinates, found.values), seen.strikes)


def _summary(found: Poses, seconds: float) -> dict[str, object]:
    """Numbers of the whole recording, as `ik.json` holds them."""
    squares = {
        name: {"rms_mm": float(np.sqrt(np.mean(d[there] ** 2))), "max_mm": float(d[there].max())}
        for name, d in zip(found.markers, 1e3 * found.distances.T, strict=True)
        if (there := np.isfinite(d)).any()
    }
    missing = ~np.isfinite(found.values)
    filled = ~found.determined & ~missing & found.determined.any(axis=0)
    return {
        "frames": len(found.time),
        "frames_per_second": len(found.time) / seconds,
        "steps_mean": float(found.steps.mean()),
        "unsettled_frames": int((~found.settled).sum()),
        "filled_frames": {n: int(k) for n, k in zip(found.names, filled.sum(axis=0), strict=True) if k},
        "missing_frames": {n: int(k) for n, k in zip(found.names, missing.sum(axis=0), strict=True) if k},
        "rms_mm": 1e3 * float(np.sqrt(np.nanmean(found.distances**2))),
        "max_mm": 1e3 * float(np.nanmax(found.distances)),
        "markers": squares,
    }


def _warn(record: Record, found: Poses) -> None:
    if not found.settled.all():
        count = int((~found.settled).sum())
        record.warn(f"{count} frames did not settle: markers and model may not belong together")
    never = np.asarray(~found.determined.any(axis=0))
    if never.any():
        names = tuple(name for name, each in zip(found.names, never, strict=True) if each)
        record.warn(f"no frame tells {listed(names)}: kept at the model's default")
    for lost, what in (
        (~found.determined & np.isfinite(found.values) & ~never, "filled between frames that tell them"),
        (~np.isfinite(found.values), "left empty, markers do not tell them"),
    ):
        names = tuple(name for name, each in zip(found.names, lost.any(axis=0), strict=True) if each)
        if names:
            frames = found.time[lost.any(axis=1)]
            span = f"{len(frames)} frames from {frames[0]:g} to {frames[-1]:g} s"
            record.warn(f"{span}: {what}: {listed(names)}")
