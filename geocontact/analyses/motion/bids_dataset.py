"""Recorded markers and the coordinates found from them as a BIDS dataset of motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.analyses.motion.panels import printed
from geocontact.data.bids_name import BidsName
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.data.version import VERSION
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.io.motion.bids import BidsChannels, write_bids

FOLDER = "bids"
"""Folder of the dataset in the results."""
_UPRIGHT = 1.0 - 1e-6
"""Cosine to gravity from which an axis points up."""


def write_dataset(
    folder: Path, name: BidsName, model: Multibody, poses: Poses, markers: MarkerTrajectories | None
) -> None:
    """Markers as they were read and turned [m], and coordinates [deg, m], at the same times, into `folder`."""
    units = ["deg" if c.kind == "rotational" else "m" for c in model.coordinates]
    systems = [BidsChannels.of_coordinates(poses.names, units, printed(model.coordinates, poses.values))]
    if markers is not None:
        systems.insert(0, BidsChannels.of_markers(markers))
    upright = np.flatnonzero(np.asarray(model.up) > _UPRIGHT)
    write_bids(folder, name, poses.time, systems, VERSION, "xyz"[upright[0]] if len(upright) else None)
