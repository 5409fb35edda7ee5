"""Values as Python has them: texts with units, tables, arrays and meshes where a file is asked for."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import open3d
import pandas as pd
import pytest
import pyvista as pv
import trimesh
from matplotlib.figure import Figure
from scipy.spatial.transform import RigidTransform

import geocontact as gc
from geocontact.analyses.frame.in_memory import InMemory
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import Declared, declared
from geocontact.analyses.shape.options import ShapeOptions
from geocontact.data.errors import InputError
from geocontact.data.plausible import KNOWN, ByName, ByPlace, Plausible, Range, numbers_in
from geocontact.data.units import Unit
from geocontact.io.mocap.force_plates import read_force_plates
from geocontact.io.text.tables import read_table
from geocontact.io.text.units import LENGTH, si_unit
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
        ("knee settle", "load", "2 kN", 2000.0),
        ("elbow design", "limit", "5 N", 5.0),
        ("elbow design", "limit", "5", 5.0),
        ("area", "rate", "0.1 kHz", 100.0),
        ("area", "threshold", np.array([1e-3, 4e-3]), (1e-3, 4e-3)),
        ("area", "threshold", pd.Series([1e-3, 4e-3]), (1e-3, 4e-3)),
        ("area", "threshold", np.float64(4e-3), (4e-3,)),
        ("id", "time", np.array([0.4, 1.6]), (0.4, 1.6)),
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
        ("elbow design", "l", "16 kg", "`l`: '16 kg' is not a value in m; write gc.mm(30)"),
        ("knee settle", "modulus", "463", "`modulus`: '463' is not a pressure; write 500MPa"),
        ("prosthesis simulate", "mass", "77.3 m", "`mass`: 'm' is not a unit of mass"),
        ("ik", "follow", None, None),
        ("elbow design", "limit", "5 m", "`limit`: '5 m' is not a value in N; check the unit"),
        ("elbow design", "limit", "five", "`limit`: 'five' is not a number; give a number"),
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
    with pytest.raises(
        gc.InputError, match=r"`level`: 10000 % cannot be a level of support: that is 0 to 100 %; is 100 % meant\?"
    ):
        gc.shoulder.simulate(SAMPLES / "overhead_P1T1S100" / "markers.trc", level=100)


@pytest.mark.parametrize(
    ("command", "name", "value", "said"),
    [
        ("area", "threshold", 4, "4000 mm cannot be a threshold of contact: that is 0 to 200 mm; is 4 mm meant?"),
        ("knee settle", "modulus", 463, "0.000463 MPa cannot be Young's modulus: .* is 463 MPa meant?"),
        ("prosthesis simulate", "mass", 0.08, "0.08 kg cannot be the mass of a walking person: .* is 0.08 t meant?"),
        ("prosthesis simulate", "mass", 77300, "77300 kg cannot be the mass of a walking person: .* is 77300 g meant?"),
        ("knee settle", "piece", 2, "2000 mm cannot be the edge of a piece of a surface: .* is 2 mm meant?"),
        ("elbow simulate", "pressure", (10, 60), "0.450037 mmHg cannot be the pressure of a cuff: .* 60 mmHg meant?"),
        ("elbow design", "range", (0, 120), "6875.49 deg cannot be an angle of a joint: .* is 120 deg meant?"),
        ("sit-to-stand predict", "time_limit", 0, "0 s cannot be the time of a search: that is 0.001 to 1e"),
        ("knee settle", "poisson", 46, "46 cannot be Poisson's ratio of a layer, below 0.5: that is 0 to 0.4999"),
    ],
)
def test_bare_numbers_that_cannot_be_meant_are_refused_with_the_likely_unit(
    command: str, name: str, value: Any, said: str
) -> None:
    one = option(command, name)
    *_, (_, known, number) = numbers_in(one.range, one.coerced(value))
    with pytest.raises(gc.InputError, match=said.replace("?", r"\?")):
        known.require(number, name)


def mixed_up() -> Iterator[tuple[str, Plausible, float, Unit]]:
    """Usual values of every quantity that an option can have, written as the bare number of every other unit."""
    for (command, name), one in OPTIONS.items():
        for known in dict.fromkeys(ranges_in(one.range)):
            low, high = known.usual or known.possible
            usual = (max(low, 1e-3 * high) * high) ** 0.5 * known.unit.factor
            for unit in KNOWN:
                if unit.si == known.unit.si and (unit.factor < 0.01 or unit.factor > 100.0):
                    yield f"{command} {name}", known, float(f"{usual / unit.factor:.3g}"), unit


def ranges_in(known: Range | None) -> Iterator[Plausible]:
    match known:
        case ByName():
            for _, one in known.ranges:
                yield from ranges_in(one)
        case ByPlace():
            for one in known.ranges:
                yield from ranges_in(one)
        case Plausible():
            yield known


WIDE = {
    "Young's modulus": "phantoms of gel have some kPa, bone some GPa",
    "a damping": "no one order of magnitude: sensors, skin and oil",
    "the force of a person": "of a finger as of a jump",
    "the noise of a force": "none is as good as any",
    "the largest force on a limb": "of a finger as of a leg",
    "a time of a recording": "clocks count from 1970",
    "the pressure of a cuff": "GPa are no unit of cuffs",
}
"""Quantities that are usual over more orders of magnitude than units are apart, and why."""


def test_a_number_in_another_unit_is_refused_or_warned_of() -> None:
    silent = {known.what for _, known, number, _ in mixed_up() if not known.refusal(number) and not known.doubt(number)}
    assert silent <= set(WIDE)
    assert len(list(mixed_up())) > 100


SINGLE = [
    pytest.param(one, one.range, id=f"{command} {name}")
    for (command, name), one in OPTIONS.items()
    if isinstance(one.range, Plausible) and one.range.unit.si != "1"
    if one.kind in (float, tuple[float, ...])
]


@pytest.mark.parametrize(("one", "known"), SINGLE)
def test_every_number_is_taken_with_its_unit_as_text(one: Declared, known: Plausible) -> None:
    units = [unit for unit in KNOWN if unit.si == known.unit.si and si_unit(unit.name) is not None]
    for unit in (known.unit, *units):
        value = one.coerced(f"{12.5 * known.unit.factor / unit.factor!r} {unit.name}")
        assert np.ravel(value) == pytest.approx(12.5 * known.unit.factor, rel=1e-12), unit.name


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


def scene(file: Path) -> trimesh.Scene:
    return trimesh.Scene(trimesh.load(file))


def grid(file: Path) -> pv.UnstructuredGrid:
    return pv.read(file).cast_to_unstructured_grid()


@pytest.mark.parametrize(
    "load", [trimesh.load, pv.read, opened, scene, grid], ids=["trimesh", "pyvista", "open3d", "scene", "grid"]
)
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


def test_a_surface_of_geocontact_beside_a_file_in_mm() -> None:
    """Each body has its own unit: MOVING in m in memory, FIXED in mm in a file, and rows of poses like it."""
    over = np.array([[1.0, 0, 0, 0, 0, 1, 0, 21, 0, 0, 1, 0]])
    given: dict[str, Any] = {"unit": "mm", "motion": over, "rate": 1.0, "threshold": "4mm"}
    surface = gc.read_surface(SAMPLES / "sphere_r20.stl", "mm")
    plate = SAMPLES / "plate_80x80x12.stl"
    ours = gc.area(surface, plate, unit_moving="m", **given).table()
    pd.testing.assert_frame_equal(ours, gc.area(SAMPLES / "sphere_r20.stl", plate, **given).table())
    with pytest.raises(gc.InputError, match='whose numbers are metres; give unit_moving="m"'):
        gc.area(surface, plate, unit_moving="mm", **given)


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
    given = held.replaced({"motion": TABLE, "moving": [TABLE, "b.csv"]})
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
        (
            np.zeros((4, 3)),
            "`moving` (array, 4 x 3): is a table, not a surface of triangles; make triangles of its points first",
        ),
        (None, "`moving`: is None; give a value"),
        (
            {"vertices": []},
            "`moving`: is a dict; give a path, a DataFrame, an array of rows or a mesh of trimesh, pyvista or open3d",
        ),
    ],
)
def test_a_value_that_holds_no_surface_is_refused(value: object, said: str) -> None:
    with pytest.raises(gc.InputError) as refused:
        gc.area(value, INSERT, unit="mm", motion=SAMPLES / "gait.csv")
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


PERSON = SAMPLES / "gait_P1_medium_1"
SI = {"v": "N", "p": "m", "m": "N m", "t": "N m"}


def plates_in_memory(unit: str) -> pd.DataFrame:
    """The shipped plates as a table with units, places in any."""
    table = read_table(PERSON / "plates.mot")
    columns: dict[str, Any] = {"time [s]": table.time}
    for name in table.channels:
        si = "N m" if "torque" in name or "moment" in name else SI[name[-2]]
        factor = LENGTH[unit] if si == "m" else 1.0
        columns[f"{name} [{unit if si == 'm' else si}]"] = table.column(name) / factor
    return pd.DataFrame(columns)


def test_force_plates_of_a_table_are_those_of_their_file(tmp_path: Path) -> None:
    plates_in_memory("mm").to_csv(tmp_path / "plates.csv", index=False)
    found, wanted = read_force_plates(tmp_path / "plates.csv"), read_force_plates(PERSON / "plates.mot")
    assert [each.name for each in found] == [each.name for each in wanted]
    for one, other in zip(found, wanted, strict=True):
        np.testing.assert_allclose(one.wrench.force, other.wrench.force, rtol=1e-12)
        np.testing.assert_allclose(one.wrench.moment, other.wrench.moment, rtol=1e-12)
        np.testing.assert_allclose(one.wrench.origin, other.wrench.origin, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (" [mm]", "", r"column '.*px' has no unit; name it '.*px \[m\]'"),
        ("vx [N]", "vx [kg]", r"'kg' is not a unit in which .*vx can be; name it '.*vx \[N\]'"),
    ],
)
def test_force_plates_of_a_table_have_units(tmp_path: Path, old: str, new: str, said: str) -> None:
    table = plates_in_memory("mm")
    table.columns = [name.replace(old, new) for name in table.columns]
    table.to_csv(tmp_path / "plates.csv", index=False)
    with pytest.raises(gc.InputError, match=said):
        read_force_plates(tmp_path / "plates.csv")


FILES = [
    pytest.param(job, one, id=f"{job.command} {one.name}")
    for job in JOBS
    for one in declared(job.options)
    if one.settable and "Path" in str(one.kind)
]


@pytest.mark.parametrize(("job", "one"), FILES)
def test_a_table_is_taken_wherever_a_file_is(job: Job[Any, Any], one: Declared) -> None:
    held = InMemory()
    (file,) = np.atleast_1d(one.coerced(held.replaced({one.name: TABLE})[one.name]))
    assert isinstance(file, Path) and pd.read_csv(file).equals(TABLE.reset_index(drop=True))
    assert held.spelled(str(file)) == f"`{one.name}` (DataFrame, 5 x 8)"


LEG = SAMPLES / "leg.osim"


@pytest.mark.filterwarnings("ignore:residual force")  # nothing but gravity acts on the leg
def test_an_hour_with_tables_alone() -> None:
    """Markers to coordinates to moments: results of one job go into the next without a file."""
    seen = gc.virtual_markers(SAMPLES / "leg_swing.mot", model=LEG)
    moved = gc.inverse_kinematics(seen.table(), model=LEG)
    forces = gc.inverse_dynamics(moved.table("coordinates"), model=LEG)
    by_file = gc.inverse_dynamics(SAMPLES / "leg_swing.mot", model=LEG)
    assert moved.rms < 1e-6
    for name, moment in by_file.moments.items():
        np.testing.assert_allclose(forces.moments[name], moment, atol=1e-2 * np.abs(moment).max() + 1e-3)


def test_results_in_a_loop_and_in_a_plot() -> None:
    found = [
        gc.area(FEMUR, INSERT, unit="mm", motion=TABLE, threshold=f"{threshold} mm").area[:, 0].max() * 1e6
        for threshold in (1, 2, 4)
    ]
    assert found == sorted(found) and found[-1] > 2000.0
    result = gc.area(FEMUR, INSERT, unit="mm", motion=TABLE, threshold=["1 mm", "4 mm"])
    axes = Figure().subplots()
    one, four = axes.plot(result.time, 1e6 * result.area, label=[f"{1e3 * t:g} mm" for t in result.thresholds])
    assert four.get_label() == "4 mm" and one.get_ydata().max() == pytest.approx(found[0])


def test_numbers_of_several_motions_are_asked_for_one_by_one() -> None:
    both = gc.area(FEMUR, INSERT, unit="mm", motion=[TABLE, TABLE.iloc[:2]], threshold="4 mm")
    with pytest.raises(ValueError, match=r"there are 2 motions \(motion, motion2\): take `motions\[0\].evolution`"):
        _ = both.area
    with pytest.raises(ValueError, match=r"there are no loads: call `gc.pressure`, or give `modulus` and `poisson`"):
        _ = gc.area(FEMUR, INSERT, unit="mm", motion=TABLE.iloc[:1], threshold="4 mm").force


@pytest.mark.parametrize(
    ("value", "what"),
    [
        (np.zeros(7), "is an array of 7;"),
        (np.zeros((5, 3)), "is an array of 5 x 3;"),
        (np.zeros((0, 16)), "is an array of 0 x 16;"),
        ([1.0, 2.0], "is a number;"),
    ],
)
def test_an_array_that_is_no_motion_is_refused_with_what_is_wanted(value: object, what: str) -> None:
    with pytest.raises(InputError, match=re.escape(f"`motion`: {what} give 4 x 4 matrices")):
        InMemory().replaced({"motion": value, "unit": "mm"})
