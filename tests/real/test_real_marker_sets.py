"""Marker sets of real files, and one walk from .c3d to moments without the name of a marker."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.motion.naming import recognised
from geocontact.io.mocap.markers import read_markers

pytestmark = pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
SETS = {
    "bmclab_gait_c3d/Gait.c3d": "helen-hayes 22 of 22",
    "opensim_walk/subject01_static.trc": "cleveland 49 of 49",
    "opensim_walk/subject01_walk1.trc": "cleveland 41 of 49",
    "c3d_variety/Eb015pr.c3d": "cast-clusters 26 of 28",
    "gc6_dm_knee/gait/DM_ngait_og1_new.trc": "grand-challenge 58 of 58",
    "gc4_jw_knee/c3d/jw_ngait_og3.c3d": "grand-challenge 48 of 58",
}


@pytest.mark.parametrize("file", SETS)
def test_sets_of_real_files(data_dir: Path, file: str) -> None:
    assert recognised(read_markers(data_dir / file).names, file).words == SETS[file]


def _raw(file: Path) -> dict[str, np.ndarray]:
    """Markers in metres by ezc3d alone, the first of each label, in the model's axes."""
    import ezc3d

    content = ezc3d.c3d(str(file))
    points = 1e-3 * content["data"]["points"][:3]
    found: dict[str, np.ndarray] = {}
    for k, label in enumerate(content["parameters"]["POINT"]["LABELS"]["value"]):
        x, y, z = points[:, k]
        found.setdefault(label, np.where((points[:, k] == 0.0).all(axis=0)[:, None], np.nan, np.stack([-x, z, y], 1)))
    return found


def _location(osim: Path, marker: str) -> np.ndarray:
    entry = re.search(rf'<Marker name="{re.escape(marker)}">.*?<location>(.*?)</location>', osim.read_text(), re.DOTALL)
    assert entry is not None
    return np.array([float(each) for each in entry[1].split()])


def test_a_walk_from_c3d_to_moments_without_a_marker_name(data_dir: Path, tmp_path: Path) -> None:
    """No pair, map or weight of a marker is typed; the factor and the fit of the pelvis are derived once more."""
    walk, model = data_dir / "bmclab_gait_c3d" / "Gait.c3d", data_dir / "opensim_walk" / "subject01_simbody.osim"
    made = gc.scale(walk, model=model, naming="auto", axes="-x,z,y", time=(2.0, 2.0), sizes_time=(1.38, 3.2), mass=70.0)
    seen = _raw(walk)
    measured = np.linalg.norm(seen["RASI"] - seen["LASI"], axis=1)[138:321]
    own = np.linalg.norm(_location(model, "R.ASIS") - _location(model, "L.ASIS"))
    assert made.scale_factors["pelvis"] == pytest.approx(np.nanmean(measured) / own, rel=1e-6)
    scaled = made.write(tmp_path / "s") / "scaled.osim"
    angles = gc.inverse_kinematics(walk, model=scaled, axes="-x,z,y", time=(1.38, 3.2))
    folder = angles.write(tmp_path / "a")
    assert 1e3 * angles.rms == pytest.approx(9.6, abs=0.3), "mm; markers on skin, one frame of a walk as static pose"
    _residuals_once_more(angles.tables(), scaled, seen)
    moments = gc.inverse_dynamics(
        folder / "ik.mot",
        model=scaled,
        plates=walk,
        plate=("1=calcn_l", "2=calcn_r"),
        axes="-x,z,y",
        time=(2.25, 3.0),
    )
    table = moments.tables()["forces"]
    residual = np.linalg.norm(table[[f"pelvis_t{axis}_force [N]" for axis in "xyz"]].to_numpy(), axis=1)
    assert np.median(residual) < 0.1 * 871.0, "N; 871 N is the largest plate force"


def _residuals_once_more(tables: dict[str, pd.DataFrame], scaled: Path, seen: dict[str, np.ndarray]) -> None:
    """Distances of the pelvis' markers by its six coordinates: turns about z, then x, then y."""
    angles, distances = tables["coordinates"], tables["markers"]
    frames = np.round(100.0 * angles["time [s]"].to_numpy()).astype(int)
    z, x, y = (np.radians(angles[f"pelvis_{name} [deg]"].to_numpy()) for name in ("tilt", "list", "rotation"))
    shift = angles[[f"pelvis_t{axis} [m]" for axis in "xyz"]].to_numpy()
    one, zero = np.ones_like(x), np.zeros_like(x)

    def stacked(*rows: list[np.ndarray]) -> np.ndarray:
        return np.moveaxis(np.array(rows), 2, 0)

    about_z = stacked([np.cos(z), -np.sin(z), zero], [np.sin(z), np.cos(z), zero], [zero, zero, one])
    about_x = stacked([one, zero, zero], [zero, np.cos(x), -np.sin(x)], [zero, np.sin(x), np.cos(x)])
    about_y = stacked([np.cos(y), zero, np.sin(y)], [zero, one, zero], [-np.sin(y), zero, np.cos(y)])
    for label in ("RASI", "LASI", "VSAC"):
        there = shift + (about_z @ about_x @ about_y) @ _location(scaled, label)
        off = 1e3 * np.linalg.norm(there - seen[label][frames], axis=1)
        np.testing.assert_allclose(distances[f"{label} [mm]"], off, atol=1e-3, err_msg=label)
