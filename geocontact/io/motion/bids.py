"""Recorded markers and coordinates of a model as a BIDS dataset of motion, which other laboratories' tools read.

Files, columns and terms after the Brain Imaging Data Structure, version 1.10.0, with its extension for motion (Jeung et
al. 2024, Scientific Data 11:716, doi:10.1038/s41597-024-03559-8): values without a head, their channels and the
reference frame in files beside. Each tracking system has its own files: `markers` for what was recorded, `model` for
the coordinates that were found from it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.bids_name import BidsName
from geocontact.data.multibody.markers import MarkerTrajectories

VERSION = "1.10.0"
MISSING = "n/a"
FRAME = "reference_frame"
KINDS = ("ACCEL", "ANGACCEL", "GYRO", "JNTANG", "MAGN", "ORNT", "POS", "VEL")
"""Types of channels that are counted beside LATENCY."""
_EVEN = 1e-3
"""Share of the step by which steps of even sampling may differ: times are often rounded."""


@dataclass(frozen=True, eq=False)
class BidsChannels:
    """Values of a tracking system over time, a channel a column.

    Parameters
    ----------
    tracksys
        Its label.
    system
        What it is, in words.
    samples
        A column for each channel; NaN where nothing was seen.
    channels
        Columns name, component, type, tracked_point, units; a row a channel.
    """

    tracksys: str
    system: str
    samples: Float[np.ndarray, "t n"]
    channels: pd.DataFrame

    @classmethod
    def of_markers(cls, markers: MarkerTrajectories) -> BidsChannels:
        """Places of markers [m]."""
        rows = [(f"{name}_{axis}", axis, "POS", name, "m") for name in markers.names for axis in "xyz"]
        values = np.asarray(markers.positions).reshape(len(markers.time), -1)
        return cls("markers", "optical markers", values, _channels(rows))

    @classmethod
    def of_coordinates(
        cls, names: Sequence[str], units: Sequence[str], values: Float[np.ndarray, "t n"]
    ) -> BidsChannels:
        """Coordinates of a model, in deg or m."""
        kinds = {"deg": "JNTANG", "m": "POS"}
        rows = [(name, MISSING, kinds[unit], name, unit) for name, unit in zip(names, units, strict=True)]
        return cls("model", "coordinates of a model by inverse kinematics", values, _channels(rows))


def _channels(rows: Sequence[tuple[str, str, str, str, str]]) -> pd.DataFrame:
    return pd.DataFrame(rows, columns=["name", "component", "type", "tracked_point", "units"])


def write_bids(
    folder: Path,
    name: BidsName,
    time: Float[np.ndarray, " t"],
    systems: Sequence[BidsChannels],
    version: str,
    up: str | None = None,
) -> None:
    """A dataset with one recording.

    Parameters
    ----------
    folder
        The dataset's, made if it is not there.
    name
        Subject, task and so on.
    time
        Time of the frames [s]; written as a channel LATENCY, from 0, beside the nominal rate.
    systems
        Values of each tracking system at these times.
    version
        The package's, for the files' account of where they come from.
    up
        Axis of the ground's frame that points up: x, y or z; the others are not known to point anywhere.
    """
    below = folder / name.folder
    below.mkdir(parents=True, exist_ok=True)
    _write_json(folder / "dataset_description.json", _dataset(name, version))
    participants = pd.DataFrame({"participant_id": [f"sub-{name.labels['sub']}"]})
    participants.to_csv(folder / "participants.tsv", sep="\t", index=False)
    about = f"Motion of sub-{name.labels['sub']}, task {name.labels['task']}, written by geocontact {version}.\n"
    (folder / "README").write_text(about, encoding="utf-8")
    for each in systems:
        _write_system(below, name, time, each, up)
        _write_json(below / name.file(each.tracksys, "motion.json"), _sidecar(name, time, each, version))


def _write_system(
    below: Path, name: BidsName, time: Float[np.ndarray, " t"], system: BidsChannels, up: str | None
) -> None:
    """Values, their channels and the reference frame of one tracking system."""
    framed = system.channels["component"] != MISSING
    latency = pd.DataFrame([("latency", MISSING, "LATENCY", MISSING, "s", MISSING)], columns=[*system.channels, FRAME])
    own = system.channels.assign(**{FRAME: np.where(framed, "ground", MISSING)})
    channels = pd.concat([latency, own], ignore_index=True)
    channels.to_csv(below / name.file(system.tracksys, "channels.tsv"), sep="\t", index=False)
    values = pd.DataFrame(np.column_stack([time - time[0], system.samples]))
    values.to_csv(
        below / name.file(system.tracksys, "motion.tsv"),
        sep="\t",
        header=False,
        index=False,
        na_rep=MISSING,
        float_format="%.9g",
    )
    if framed.any():
        axes = {} if up is None else {"SpatialAxes": "".join("U" if axis == up else "_" for axis in "xyz")}
        level = {"Description": "frame of the laboratory", **axes, "RotationRule": MISSING, "RotationOrder": MISSING}
        described = {FRAME: {"Description": "frame of the values", "Levels": {"ground": level}}}
        _write_json(below / name.file(system.tracksys, "channels.json"), described)


def _sidecar(name: BidsName, time: Float[np.ndarray, " t"], system: BidsChannels, version: str) -> dict[str, object]:
    """Rate, duration and counts of channels of a tracking system."""
    steps = np.diff(time)
    rate = float(1.0 / np.median(steps))
    even = float(np.ptp(steps)) <= max(_EVEN * float(np.median(steps)), 2e-6)
    counts = system.channels["type"].value_counts()
    return {
        "TaskName": name.labels["task"],
        "SamplingFrequency": round(rate, 6),
        "SamplingFrequencyEffective": round((len(time) - 1) / float(time[-1] - time[0]), 6),
        **({} if even else {"TaskDescription": "Sampled unevenly: the channel latency holds the times."}),
        "TrackingSystemName": system.system,
        "MotionChannelCount": len(system.channels) + 1,
        "TrackedPointsCount": int(system.channels["tracked_point"].nunique()),
        **{f"{kind}ChannelCount": int(counts.get(kind, 0)) for kind in KINDS},
        "LATENCYChannelCount": 1,
        "MissingValues": MISSING,
        "RecordingType": "continuous",
        "RecordingDuration": float(time[-1] - time[0]),
        "SoftwareVersions": f"geocontact {version}",
    }


def _dataset(name: BidsName, version: str) -> dict[str, object]:
    """The dataset, as its description has it."""
    return {
        "Name": f"Motion of sub-{name.labels['sub']}",
        "BIDSVersion": VERSION,
        "DatasetType": "raw",
        "GeneratedBy": [{"Name": "geocontact", "Version": version}],
    }


def _write_json(file: Path, content: Mapping[str, object]) -> None:
    file.write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
