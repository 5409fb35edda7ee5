"""Files to damage: shipped ones, those that the runs of `same_outputs` read, and what the project's writers write."""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.damage import texts
from benchmarks.same_outputs.inputs import make

MESHES = Path(__file__).resolve().parents[2] / "meshes"


@dataclass(frozen=True)
class Sample:
    """A file of a folder that one reader reads.

    Parameters
    ----------
    reader
        Key in `readers.READERS`.
    kind
        Key in `mutations.KINDS`.
    home
        Folder with all that the reader may want.
    file
        Which file is damaged, from `home`.
    """

    reader: str
    kind: str
    home: Path
    file: str

    @property
    def name(self) -> str:
        return f"{self.reader}: {self.home.name}/{self.file}"


def samples(folder: Path) -> list[Sample]:
    """All of them, made in `folder`."""
    make(folder, MESHES)
    home = folder / "own"
    home.mkdir(exist_ok=True)
    _meshes(home)
    _tables(folder, home)
    _opensim(folder, home)
    _settings(home)
    with_c3d = _recording(home / "walk.c3d")
    small = [(name, kind, "own", file) for name, kind, file in OWN]
    return [
        Sample(reader, kind, folder / where, file)
        for reader, kind, where, file in (*small, *THERE, *(C3D if with_c3d else ()))
    ]


OWN = (
    ("mesh", "binary", "ball.stl"),
    ("mesh", "table", "ascii.stl"),
    ("mesh", "binary", "ball.ply"),
    ("mesh", "table", "ascii.ply"),
    ("mesh", "table", "ball.obj"),
    ("mesh", "markup", "ball.vtp"),
    ("mesh", "markup", "ascii.vtp"),
    ("table", "archive", "gait.xlsx"),
    ("poses", "table", "semicolons.csv"),
    ("poses", "table", "euler.csv"),
    ("rows of matrices", "table", "rows.txt"),
    ("markers", "table", "markers.csv"),
    ("marker map", "table", "map.txt"),
    ("osim multibody", "markup", "leg.osim"),
    ("osim multibody", "markup", "written.osim"),
    ("osim forces", "markup", "leg.osim"),
    ("osim spheres", "markup", "foot.osim"),
    ("loads", "markup", "loads.xml"),
    ("ik setup", "markup", "ik.xml"),
    ("id setup", "markup", "id.xml"),
    ("scale setup", "markup", "scale.xml"),
    ("device", "settings", "device.toml"),
    ("person", "settings", "person.toml"),
    ("overhead study", "settings", "overhead.toml"),
    ("contact parameters", "table", "parameters.csv"),
    ("profile", "table", "profile.csv"),
    ("fit.json", "settings", "fit.json"),
    ("elbow.json", "settings", "elbow.json"),
    ("run.json", "settings", "run.json"),
)
"""Reader, kind, file of those that are made here."""
THERE = (
    ("poses", "table", "area", "gait_a.csv"),
    ("table", "table", "area", "gait.mot"),
    ("table", "table", "meshes/standing_up", "T1_rates.sto"),
    ("joint motion", "table", "area", "gait.mot"),
    ("mapped motion", "table", "area", "gait.mot"),
    ("clinical motion", "table", "area", "clinical.csv"),
    ("placement", "table", "area", "place.txt"),
    ("faces", "table", "area", "faces.txt"),
    ("particles", "table", "area", "plate.particles"),
    ("study", "settings", "area", "study.toml"),
    ("markers", "table", "leg", "walk.trc"),
    ("plates", "table", "leg", "grf.mot"),
    ("plates", "table", "foot", "plate.mot"),
    ("osim joint", "markup", "meshes", "knee.osim"),
    ("osim placement", "markup", "meshes", "knee.osim"),
    ("osim multibody", "markup", "leg", "leg.osim"),
    ("marker weights", "markup", "leg", "tasks.xml"),
    ("loads", "markup", "leg", "loads.xml"),
    ("gap case", "settings", "gap/elbow", "case.toml"),
    ("gap case", "table", "gap/elbow", "trials/t01.csv"),
    ("gap case", "settings", "gap/chain", "case.toml"),
    ("gathering", "settings", "gather/foot", "plan.toml"),
    ("gathering", "settings", "gather/mats", "plan.toml"),
    ("areas", "table", "knee", "step_area.csv"),
    ("area over force", "table", "knee", "calibration.csv"),
    ("cycles", "table", "knee", "cycles.csv"),
    ("load cells", "table", "knee", "walk.csv"),
    ("forces", "table", "knee", "step_forces.csv"),
    ("regression", "settings", "knee", "tray.toml"),
    ("elbow recording", "table", "elbow", "angle.csv"),
    ("drift", "table", "elbow", "knee.csv"),
    ("population", "settings", "elbow", "correlated.toml"),
    ("mat grid", "table", "meshes/mat_thigh_16x8", "frames_quantised.csv"),
    ("mat layout", "settings", "meshes/mat_thigh_16x8", "layout_faulty.toml"),
    ("mat landmarks", "table", "meshes/mat_thigh_16x8", "landmarks.csv"),
    ("mat export", "table", "exports", "tekscan.asf"),
    ("mat export", "table", "exports", "xsensor.csv"),
    ("mat pedar", "table", "exports", "pedar.asc"),
    ("wrench head", "table", "mats", "model.csv"),
    ("spheres", "table", "foot", "spheres.csv"),
    ("law", "settings", "foot", "law.toml"),
    ("gait study", "settings", "walk", "study.toml"),
    ("standing study", "settings", "meshes/standing_up_exoskeleton", "study.toml"),
)
"""Reader, kind, folder, file of those that `same_outputs` makes."""
C3D = tuple((name, "binary", "own", "walk.c3d") for name in ("c3d markers", "c3d plates", "c3d analogs", "c3d events"))


def _meshes(home: Path) -> None:
    import pyvista as pv
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=1, radius=31.4159)
    for name, how in (
        ("ball.stl", {"file_type": "stl"}),
        ("ascii.stl", {"file_type": "stl_ascii"}),
        ("ball.ply", {"file_type": "ply"}),
        ("ascii.ply", {"file_type": "ply", "encoding": "ascii"}),
        ("ball.obj", {"file_type": "obj"}),
    ):
        data = ball.export(**how)
        (home / name).write_bytes(data if isinstance(data, bytes) else data.encode())
    surface = pv.make_tri_mesh(ball.vertices, ball.faces)
    surface.save(home / "ball.vtp")
    surface.save(home / "ascii.vtp", binary=False)


def _tables(folder: Path, home: Path) -> None:
    poses = pd.read_csv(folder / "area" / "gait_11.csv", skipinitialspace=True)
    poses.to_excel(home / "gait.xlsx", index=False)
    poses.to_csv(home / "semicolons.csv", sep=";", decimal=",", index=False)
    angles = {f"r{axis} [deg]": np.linspace(0.0, 20.0, len(poses)) for axis in "xyz"}
    pd.concat([poses.iloc[:, :4], pd.DataFrame(angles)], axis=1).to_csv(home / "euler.csv", index=False)
    rows = np.tile(np.eye(4).ravel(), (8, 1))
    rows[:, 3] = np.arange(8)
    np.savetxt(home / "rows.txt", rows, fmt="%.6f")
    time = np.arange(6) / 100.0
    places = {f"{name}_{axis} [mm]": 100.0 * k + 50.0 * time for k, name in enumerate("ABC") for axis in "xyz"}
    pd.DataFrame({"time [s]": time, **places}).to_csv(home / "markers.csv", index=False)


def _opensim(folder: Path, home: Path) -> None:
    from geocontact.io.opensim.external_loads import write_external_loads
    from geocontact.io.opensim.osim_multibody import read_multibody
    from geocontact.io.opensim.osim_writer import write_osim
    from tests.cli.test_opensim_setup import ID, IK, SCALE
    from tests.dynamics.test_passive_loads import planar_leg
    from tests.io.test_osim_contact_spheres import HUNT
    from tests.io.test_osim_contact_spheres import model as foot

    for name in ("walk.mot", "walk.trc", "grf.mot", "tasks.xml"):
        shutil.copy(folder / "leg" / name, home / name)
    planar_leg(home)
    foot(home, HUNT)
    write_osim(home / "written.osim", read_multibody(folder / "leg" / "leg.osim"))
    write_external_loads(home / "loads.xml", "grf.mot", {"plate_force": "foot_r"})
    for name, text in (("id", ID.format(exclude="stops")), ("ik", IK), ("scale", SCALE.format(""))):
        (home / f"{name}.xml").write_text(text)


def _settings(home: Path) -> None:
    for name, text in (
        ("device.toml", texts.DEVICE),
        ("person.toml", texts.PERSON),
        ("overhead.toml", texts.OVERHEAD),
        ("parameters.csv", texts.CONTACT_PARAMETERS),
        ("profile.csv", texts.PROFILE),
        ("map.txt", texts.MARKER_MAP),
        *((name, json.dumps(content, indent=1)) for name, content in texts.JSON.items()),
    ):
        (home / name).write_text(text)


def _recording(file: Path) -> bool:
    """Markers, one plate of type 2 and an event; False where ezc3d is not installed."""
    try:
        import ezc3d
    except ImportError:
        return False
    content = ezc3d.c3d()
    p = content["parameters"]
    p["POINT"]["RATE"]["value"], p["ANALOG"]["RATE"]["value"] = [100.0], [100.0]
    p["POINT"]["LABELS"]["value"], p["POINT"]["UNITS"]["value"] = ["A", "B"], ["mm"]
    channels = ["Fx", "Fy", "Fz", "Mx", "My", "Mz"]
    p["ANALOG"]["LABELS"]["value"] = channels
    p["ANALOG"]["UNITS"]["value"] = ["N"] * 3 + ["Nmm"] * 3
    for name, value in (
        ("USED", np.array([1])),
        ("TYPE", np.array([2])),
        ("CHANNEL", np.arange(1, 7)[:, None]),
        ("ORIGIN", np.array([[0.0], [0.0], [-40.0]])),
        ("CORNERS", np.array([[500.0, 0, 0], [0, 0, 0], [0, 500, 0], [500, 500, 0]]).T[:, :, None]),
    ):
        p["FORCE_PLATFORM"][name]["value"] = value
    content.add_event([0.0, 0.05], "Right", "Foot Strike")
    content["data"]["points"] = np.ones((4, 2, 20))
    content["data"]["points"][:3] = 100.0 * np.random.default_rng(3).random((3, 2, 20))
    content["data"]["analogs"] = np.random.default_rng(4).random((1, 6, 20)) + 5.0
    content.write(str(file))
    return True
