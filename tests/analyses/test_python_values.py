"""Values as Python has them: texts with units, tables, arrays and meshes where a file is asked for."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import open3d
import pandas as pd
import pytest
import pyvista as pv
import trimesh
from scipy.spatial.transform import RigidTransform

import geocontact as gc
from geocontact.analyses.frame.in_memory import InMemory
from geocontact.analyses.frame.options import Declared, declared
from geocontact.analyses.shape.options import ShapeOptions
from tests.analyses.jobs import JOBS

SAMPLES = Path(__file__).parents[2] / "meshes"
FEMUR, INSERT = SAMPLES / "femoral_component_right_coarse.stl", SAMPLES / "tibial_insert_right_coarse.stl"
OPTIONS = {(job.command, one.name): one for job in JOBS for one in declared(job.options)}


def option(command: str, name: str) -> Declared:
    return OPTIONS[command, name]


@pytest.mark.parametrize(
    ("command", "name", "text", "value"),
    [
        ("knee settle", "modulus", "463MPa", 463e6),
        ("knee settle", "modulus", "0.463 GPa", 463e6),
        ("area", "threshold", "4mm", (4e-3,)),
        ("area", "threshold", ("1mm", "0.4 cm"), (1e-3, 4e-3)),
        ("area", "thickness", "8mm", 8e-3),
        ("area", "thickness", "rays", "rays"),
        ("prosthesis simulate", "mass", "170 lb", 170 * 0.45359237),
        ("prosthesis simulate", "mass", "77.3", 77.3),
        ("shoulder simulate", "level", "50%", 0.5),
        ("elbow design", "l", "160 mm", 0.16),
        ("elbow fit", "bin", "5 deg", np.radians(5.0)),
        ("elbow design", "range", "0:120deg", (0.0, np.radians(120.0))),
        ("id", "time", "0.4:1.6", (0.4, 1.6)),
        ("knee settle", "bodies", "femur_r,tibia_r", ("femur_r", "tibia_r")),
        ("gap plant", "value", "damping.b=25", {"damping.b": 25.0}),
        ("modulus", "poisson", "0.25,0.46", (0.25, 0.46)),
    ],
)
def test_a_text_is_read_as_on_the_command_line(command: str, name: str, text: Any, value: Any) -> None:
    found = option(command, name).coerced(text)
    numbers = isinstance(value, float) or (isinstance(value, tuple) and isinstance(value[0], float))
    assert found == (pytest.approx(value, rel=1e-12) if numbers else value)


@pytest.mark.parametrize(
    ("command", "name", "text", "said"),
    [
        ("area", "threshold", "4", "`threshold`: '4' has no unit; write the unit, or gc.mm(1, 4)"),
        ("area", "threshold", "1,4", "`threshold`: '1,4' has no unit"),
        ("area", "thickness", "8", "`thickness`: '8' has no unit; write the unit, or gc.mm(8)"),
        ("elbow design", "l", "160", "`l`: '160' has no unit; write the unit, or gc.mm(30)"),
        ("elbow design", "l", "16 kg", "`l`: '16 kg' is no value in m; write gc.mm(30)"),
        ("knee settle", "modulus", "463", "`modulus`: '463' is not a pressure; write 500MPa"),
        ("prosthesis simulate", "mass", "77.3 m", "`mass`: 'm' is no unit of mass"),
        ("ik", "follow", None, None),
        ("elbow design", "limit", "5 N", "`limit`: '5 N' is not a number; give a number"),
        ("elbow design", "limit", pd.DataFrame(), "`limit`: a DataFrame is not a number; give a number"),
    ],
)
def test_a_text_that_may_be_meant_in_two_units_is_refused(command: str, name: str, text: Any, said: str | None) -> None:
    if said is None:
        assert option(command, name).coerced(text) is None
        return
    with pytest.raises(gc.InputError) as refused:
        option(command, name).coerced(text)
    assert str(refused.value).startswith(said)


def test_a_bare_number_that_cannot_be_meant_names_the_likely_unit() -> None:
    layer = {"unit": "mm", "side": "right", "poisson": 0.46, "motion": SAMPLES / "gait.csv"}
    with pytest.raises(gc.InputError, match=r"`modulus`: 0.000463 MPa cannot be .*; is 463 MPa meant\?"):
        gc.knee.settle(FEMUR, INSERT, modulus=463, **layer)
    with pytest.raises(gc.InputError, match=r"`level`: 10000 % is not 0 to 100 %; is 100 % meant\?"):
        gc.shoulder.simulate(SAMPLES / "overhead_P1T1S100" / "markers.trc", level=100)


POSES = RigidTransform.from_translation([[0.0, 0.0, 0.0], [0.0, 0.01, 0.0]])
TABLE = pd.read_csv(SAMPLES / "gait.csv").iloc[::25]


def opened(file: Path) -> open3d.geometry.TriangleMesh:
    mesh = trimesh.load(file)
    return open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(mesh.vertices), open3d.utility.Vector3iVector(mesh.faces)
    )


@pytest.fixture(scope="module")
def from_files(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    file = tmp_path_factory.mktemp("motion") / "gait.csv"
    TABLE.to_csv(file, index=False)
    return gc.area(FEMUR, INSERT, unit="mm", motion=file, threshold=gc.mm(4)).table()


@pytest.mark.parametrize("load", [trimesh.load, pv.read, opened], ids=["trimesh", "pyvista", "open3d"])
def test_meshes_and_tables_in_memory_give_the_numbers_of_their_files(load, from_files: pd.DataFrame) -> None:
    result = gc.area(load(FEMUR), load(INSERT), unit="mm", motion=TABLE, threshold="4mm")
    pd.testing.assert_frame_equal(result.table(), from_files)


def test_a_motion_and_rows_of_poses_are_taken(from_files: pd.DataFrame) -> None:
    motion = gc.read_motion(SAMPLES / "gait.csv")
    every = type(motion)(motion.time[::25], motion.poses[::25])
    result = gc.area(FEMUR, INSERT, unit="mm", motion=every, threshold="4mm").table()
    pd.testing.assert_frame_equal(result, from_files, rtol=1e-9)
    poses = every.poses.as_matrix()
    poses[:, :3, 3] *= 1e3
    rows = gc.area(FEMUR, INSERT, unit="mm", motion=poses, rate=4.0, threshold="4mm").table()
    pd.testing.assert_frame_equal(rows, from_files, rtol=1e-9)


def test_surfaces_of_geocontact_are_in_metres() -> None:
    surface = gc.read_surface(SAMPLES / "sphere_r20.stl", "mm")
    assert gc.fit_shape(surface, shape="sphere", unit="m").fit.radius == pytest.approx(20e-3, rel=1e-6)
    with pytest.raises(gc.InputError, match='whose numbers are metres; give unit="m"'):
        gc.fit_shape(surface, shape="sphere", unit="mm")


def test_records_and_messages_name_the_argument_and_no_path(tmp_path: Path) -> None:
    result = gc.area(trimesh.load(FEMUR), INSERT, unit="mm", motion=TABLE, threshold="4mm")
    told = json.loads((result.write(tmp_path / "out") / "run.json").read_text(encoding="utf-8"))
    assert told["options"]["moving"] == "`moving` (Trimesh, 1738 points, 3472 faces)"
    assert told["options"]["motion"] == ["`motion` (DataFrame, 5 x 8)"]
    held = result.record.held
    (folder,) = {str(Path(file).parent) for file in held.words}
    assert folder not in json.dumps(told) and folder not in (tmp_path / "out" / "report.html").read_text("utf-8")
    with pytest.raises(gc.InputError) as refused:
        gc.area(FEMUR, INSERT, unit="mm", motion=TABLE.drop(columns="time [s]"))
    assert str(refused.value).startswith("`motion` (DataFrame, 5 x 7) line 1: no columns named 'time'")


def test_files_of_values_go_with_the_result() -> None:
    held = InMemory()
    given = held.replaced({"motion": TABLE, "moving": [TABLE, "b.csv"]}, None)
    file = Path(given["motion"])
    assert file.is_file() and file.name == "motion.csv" and given["moving"][1] == "b.csv"
    assert pd.read_csv(given["moving"][0]).equals(TABLE.reset_index(drop=True))
    del held
    assert not file.exists()


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (pv.PolyData(np.zeros((3, 3))), "`moving`: is a PolyData without triangles; give a surface of triangles"),
        (np.array([["a", "b"]]), "`moving`: is an array of <U1; give numbers, or a DataFrame"),
    ],
)
def test_a_value_that_holds_no_surface_is_refused(value: object, said: str) -> None:
    with pytest.raises(gc.InputError) as refused:
        gc.area(value, INSERT, unit="mm")
    assert str(refused.value) == said


@pytest.mark.parametrize("job", JOBS, ids=lambda job: job.command)
def test_help_names_the_result_and_shows_an_example(job) -> None:
    told = job.__doc__
    assert "\nReturns\n-------\n" in told and told.index("Returns\n") > told.index("Parameters\n")
    assert len(repr(job)) < 100 and "\n" not in repr(job)


def test_help_of_a_fit_names_its_numbers() -> None:
    told = gc.fit_shape.__doc__ or ""
    assert "fit : Shape of the whole patch: axis, point and radius [m]" in told
    assert "\nExamples\n--------\n>>> import geocontact as gc\n>>> result = gc.fit_shape(" in told


@pytest.mark.parametrize("room", [gc, gc.shoulder, gc.prosthesis, gc.knee, gc.misalignment, gc.sit_to_stand])
def test_tab_lists_public_names_only(room) -> None:
    assert [name for name in dir(room) if not name.startswith("__")] == sorted(room.__all__)


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (
            lambda: gc.read_surface(SAMPLES / "sphere_r20.stl", "mm"),
            "<Surface sphere_r20.stl, 1442 points, 2880 faces, 40 x 40 x 40 mm, closed>",
        ),
        (
            lambda: gc.read_mesh(SAMPLES / "sphere_r20.stl", "mm"),
            "<Mesh sphere_r20.stl, 1442 points, 2880 faces, 40 x 40 x 40 mm>",
        ),
        (lambda: gc.Motion(np.array([0.0, 0.5]), POSES, "walk.csv"), "<Motion, 2 frames, 0 … 0.5 s, walk.csv>"),
        (lambda: gc.Motion(np.array([0.0, 50.0]), POSES, "", "%"), "<Motion, 2 frames, 0 … 50%>"),
        (
            lambda: ShapeOptions(SAMPLES / "a.stl", shape="sphere", unit="mm"),
            f"ShapeOptions(mesh='{SAMPLES}/a.stl', shape='sphere', unit='mm')",
        ),
    ],
)
def test_what_a_notebook_shows_is_one_line(value, said: str) -> None:
    assert repr(value()) == said
