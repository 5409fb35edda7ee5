"""Marker sets of real files, and one walk from .c3d to moments without the name of a marker."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.motion.naming import named_markers, recognised
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.markers import read_markers
from geocontact.io.opensim.marker_weights import read_marker_weights
from geocontact.io.opensim.osim_multibody import read_multibody

pytestmark = pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
SETS = {
    "bmclab_gait_c3d/Gait.c3d": "helen-hayes 22 of 22",
    "opensim_walk/subject01_static.trc": "cleveland 49 of 49",
    "opensim_walk/subject01_walk1.trc": "cleveland 41 of 49",
    "opensim_walk/markers_walk.trc": "rajagopal-walk 41 of 43",
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
    again = gc.inverse_kinematics(walk, model=scaled, axes="-x,z,y", time=(1.38, 3.2), naming="auto")
    assert again.rms == pytest.approx(angles.rms, rel=1e-9), "the pose has moved wands as well: all count alike"
    _doubts_of_a_walk(made.warnings)
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


def test_weights_of_gait2354_are_those_of_its_public_tasks(data_dir: Path, tmp_path: Path) -> None:
    """The set-up of the walk's own example, read from its file; markers that were not recorded have no task here."""
    walk = data_dir / "opensim_walk"
    example = read_marker_weights(walk / "subject01_Setup_IK.xml")
    model = walk / "subject01_simbody.osim"
    made = gc.inverse_kinematics(walk / "subject01_walk1.trc", model=model, model_setup="auto", time=(0.4, 0.5))
    tasks = made.seen.tasks
    assert len(tasks.markers) >= 30
    assert tasks.markers == {name: example.markers.get(name, 0.0) for name in tasks.markers}
    assert tasks.coordinates == example.coordinates


def test_the_set_up_of_gait2354_finds_the_size_of_the_model_that_it_once_made(data_dir: Path) -> None:
    """subject01 was scaled by OpenSim with the same pairs from the same static trial: factors are 1."""
    walk = data_dir / "opensim_walk"
    made = gc.scale(walk / "subject01_static.trc", model=walk / "subject01_simbody.osim", model_setup="auto")
    assert made.scale_factors == pytest.approx(dict.fromkeys(made.scale_factors, 1.0), abs=0.005)
    assert len(made.scale_factors) == 12
    assert made.rms < 0.008, "m"


SETUPS = {
    "opensim_walk/subject01_simbody.osim": ("gait2392", "3 of 5 measurements, 5 of 8 pairs", 13.5),
    "opencap/LaiArnoldModified2017_contacts.osim": ("laiuhlrich", "5 of 11 measurements, 7 of 26 pairs", 10.6),
}


@pytest.mark.parametrize("file", SETUPS)
def test_a_walk_from_c3d_to_moments_by_the_set_up_of_the_model(data_dir: Path, tmp_path: Path, file: str) -> None:
    """Not one marker's name, pair or weight is typed, whatever the model's markers are called."""
    walk, model = data_dir / "bmclab_gait_c3d" / "Gait.c3d", data_dir / file
    name, covered, off = SETUPS[file]
    axes, span = "-x,z,y", (1.38, 3.2)
    made = gc.scale(walk, model=model, model_setup="auto", axes=axes, time=(2.0, 2.0), sizes_time=span, mass=70.0)
    assert f"set-up {name}: {covered} were recorded" in made.sentences
    assert any("in their stead" in line for line in made.warnings)
    seen = _raw(walk)
    own = [_location(model, label) for label in OWN_ASIS[name]]
    measured = np.linalg.norm(seen["RASI"] - seen["LASI"], axis=1)[138:321]
    assert made.scale_factors["pelvis"] == pytest.approx(
        np.nanmean(measured) / np.linalg.norm(own[0] - own[1]), rel=1e-6
    )
    scaled = made.write(tmp_path / "s") / "scaled.osim"
    angles = gc.inverse_kinematics(walk, model=scaled, axes=axes, time=span, model_setup=name)
    assert 1e3 * angles.rms == pytest.approx(off, abs=0.5), "mm, each marker alike; weights are the set-up's"
    moments = gc.inverse_dynamics(
        angles.write(tmp_path / "a") / "ik.mot",
        model=scaled,
        plates=walk,
        plate=("1=calcn_l", "2=calcn_r"),
        axes=axes,
        time=(2.25, 3.0),
    )
    table = moments.tables()["forces"]
    residual = np.linalg.norm(table[[f"pelvis_t{axis}_force [N]" for axis in "xyz"]].to_numpy(), axis=1)
    assert np.median(residual) < 0.12 * 871.0, "N; 871 N is the largest plate force"


OWN_ASIS = {"gait2392": ("R.ASIS", "L.ASIS"), "laiuhlrich": ("r.ASIS_study", "L.ASIS_study")}


def _doubts_of_a_walk(warned: tuple[str, ...]) -> None:
    """The pair from the pelvis to the knee bends with the hip; shanks differ by 7 %, which the model's markers do."""
    pair = next(line for line in warned if "femur_r: RASI and RKNE" in line)
    assert re.search(r"are 44\d to 48\d mm apart, which changes with hip_flexion_r", pair)
    (sides,) = [line for line in warned if "scaled" in line and "longer" in line]
    assert sides.startswith("tibia: the left one is scaled")
    assert any("C7 of isb-trunk 3 of 4" in line for line in warned)


MODELS = {
    "opensim_walk/subject01_simbody.osim": ("cleveland", 36),
    "opencap/LaiArnoldModified2017_contacts.osim": ("opencap", 29),
}


def test_places_of_the_table_beside_the_markers_of_two_models(data_dir: Path) -> None:
    """The statement of the warning and of the head of body_places."""
    off: list[float] = []
    for file, (name, count) in MODELS.items():
        model = read_multibody(data_dir / file)
        own = {m.name: m for m in model.markers}
        bare = replace(model, markers=())
        seen = MarkerTrajectories(np.zeros(1), np.zeros((1, len(own), 3)), tuple(own), file)
        placed = named_markers(bare, seen, name).model.markers
        poses = model.poses(np.array([[c.default for c in model.coordinates]]))
        at = {
            marker.name: [np.asarray(poses[m.body][0].apply(m.location)) for m in (marker, own[marker.name])]
            for marker in placed
        }
        assert len(at) >= count, name
        off += [1e3 * float(np.linalg.norm(one - other)) for one, other in at.values()]
    assert np.median(off) == pytest.approx(17.0, abs=1.5), "mm; body_places says 17, the warning 2 cm"
    assert 60.0 < max(off) < 66.0, "mm; body_places says 65, the warning 7 cm"


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
