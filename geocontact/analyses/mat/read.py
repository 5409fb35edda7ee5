"""What a mat's loads are computed from: recording, scan, the mat's place on it, and what is put beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.bodies import read_surface
from geocontact.analyses.mat.comparison.model_forces import ModelForces, read_model
from geocontact.analyses.mat.comparison.phases import Phase, read_phases
from geocontact.analyses.mat.motion import read_segment_motion
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.placement.registration import BodyModel, read_body_model
from geocontact.analyses.mat.placement.second_scan import SecondScan, read_second_scan
from geocontact.analyses.mat.recording import read_recording
from geocontact.analyses.mat.segments import read_segments
from geocontact.analyses.quantities import centre
from geocontact.analyses.run_record import Record
from geocontact.data.motion import Motion
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_landmarks import MatLandmarks, read_mat_landmarks


@dataclass(frozen=True, eq=False)
class MatInputs:
    """Everything that was read; None for what was not asked for.

    Parameters
    ----------
    recorded
        Frames of the mat as they were read.
    listed_dead
        Row and column of cells that the layout lists as dead.
    motion
        Poses of the segment that carries the mat.
    scan
        Surface that the mat lies on, its faces as the file has them.
    landmarks
        Places of the mat and their points of the scan [m].
    second_scan
        Instead of landmarks: the scan with the mat on.
    point
        That moments refer to [m], in the frame of the results.
    body
        Body model that the scan is registered to.
    segments
        Expression of each named part, or the faces that belong to it where a file names them.
    phases
        Of the recording, for a comparison.
    model
        Forces to compare with.
    """

    recorded: PressureFrames
    listed_dead: tuple[tuple[int, int], ...]
    motion: Motion | None
    scan: Surface
    landmarks: MatLandmarks | None
    second_scan: SecondScan | None
    point: Float[np.ndarray, " 3"]
    body: BodyModel | None
    segments: Mapping[str, str | Bool[np.ndarray, " f"]]
    phases: tuple[Phase, ...] | None
    model: ModelForces | None


def read(o: MatOptions, record: Record) -> MatInputs:
    """Everything the options name."""
    recorded, listed_dead = read_recording(record, o)
    motion = read_segment_motion(record, o)
    scan = read_surface(record, "surface", o.surface, o.unit, None)
    return MatInputs(
        recorded,
        listed_dead,
        motion,
        scan,
        _landmarks(record, recorded, o),
        read_second_scan(record, o),
        np.zeros(3) if o.point is None else np.array(centre(o.point, o.unit, "`point`")),
        read_body_model(record, o),
        read_segments(record, scan, o),
        read_phases(record, o),
        read_model(record, o),
    )


def _landmarks(record: Record, frames: PressureFrames, o: MatOptions) -> MatLandmarks | None:
    if o.landmarks is None:
        return None
    marks = read_mat_landmarks(o.landmarks, frames.rows, frames.columns)
    record.add_input("`landmarks`", o.landmarks, landmarks=len(marks.name))
    return marks
