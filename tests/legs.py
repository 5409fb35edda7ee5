"""A synthetic pelvis with one leg as an OpenSim model, its motion, markers and ground reaction, written to files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.storage_writer import write_storage
from meshes.leg_files import BODIES, GRAVITY, leg_model

__all__ = ["BODIES", "GRAVITY"]

RATE = 100.0
OSIM = leg_model()


def model_file(folder: Path) -> Path:
    file = folder / "leg.osim"
    file.write_text(OSIM, encoding="utf-8")
    return file


def motion(model: Multibody, frames: int = 61, amplitude: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """Time [s] and smooth coordinates [rad, m]; with amplitude 0 the leg hangs straight, its foot 1 m lower."""
    time = np.arange(frames) / RATE
    phase = 2.0 * np.pi * (1.3 * time[:, None] + np.linspace(0.0, 0.8, len(model.coordinates)))
    swing = amplitude * 0.25 * np.sin(phase)
    swing[:, [c.name == "ty" for c in model.coordinates]] += 1.0
    return time, swing


def planted(folder: Path, amplitude: float = 1.0) -> tuple[Path, Multibody, np.ndarray, np.ndarray]:
    """The model's file, the model, time and coordinates."""
    file = model_file(folder)
    model = read_multibody(file)
    return (file, model, *motion(model, amplitude=amplitude))


def markers_of(model: Multibody, time: np.ndarray, values: np.ndarray) -> MarkerTrajectories:
    return MarkerTrajectories(time, model.marker_places(values), tuple(m.name for m in model.markers))


def trc_file(folder: Path, markers: MarkerTrajectories) -> Path:
    file = folder / "walk.trc"
    write_trc(file, markers)
    return file


def mot_file(folder: Path, model: Multibody, time: np.ndarray, values: np.ndarray) -> Path:
    """Coordinates in degrees and metres."""
    file = folder / "walk.mot"
    factor = np.array([np.degrees(1.0) if c.kind == "rotational" else 1.0 for c in model.coordinates])
    names = [c.name for c in model.coordinates]
    write_storage(file, time, names, values * factor, title="Coordinates", degrees=True)
    return file


def plate_files(
    folder: Path,
    time: np.ndarray,
    force: tuple[float, ...],
    point: tuple[float, ...],
    torque: tuple[float, ...] = (0.0, 0.0, 0.0),
) -> Path:
    """A constant reaction on the foot, and OpenSim's file that says so."""
    names = [f"plate_force_{kind}{axis}" for kind in "vp" for axis in "xyz"] + [f"plate_torque_{a}" for a in "xyz"]
    row = np.array([*force, *point, *torque])
    write_storage(folder / "grf.mot", time, names, np.tile(row, (len(time), 1)), title="Plates", degrees=False)
    file = folder / "loads.xml"
    file.write_text(
        """<?xml version="1.0"?><OpenSimDocument Version="40000"><ExternalLoads name="loads"><objects>
<ExternalForce name="right"><applied_to_body>foot_r</applied_to_body><force_identifier>plate_force_v</force_identifier>
<point_identifier>plate_force_p</point_identifier><torque_identifier>plate_torque_</torque_identifier></ExternalForce>
</objects><datafile>grf.mot</datafile></ExternalLoads></OpenSimDocument>""",
        encoding="utf-8",
    )
    return file
