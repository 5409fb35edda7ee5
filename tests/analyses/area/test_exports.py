"""Models for other programs: poses, places and the contact law in the files, derived again without the package."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import igl
import numpy as np
import pandas as pd
import pytest
import trimesh

import geocontact as gc
from geocontact.analyses.area.result import AreaResult
from geocontact.data.errors import InputError
from meshes.simple_shapes import block, sphere
from tests import opensim_oracle
from tests.analyses.area.calls import area, pressed
from tests.cli.calls import FEMUR, INSERT, MESHES, PLATE, SPHERE, call, gait, poses, stl, storage, unpictured
from tests.cli.calls import written as saved
from tests.elsewhere import Elsewhere
from tests.io.test_osim import VISIBLE, model3
from tests.io.test_osim import written as write_model

LAYER = {"modulus": gc.MPa(500), "poisson": 0.46, "thickness": gc.mm(8), "piece": gc.mm(1)}
QUICK = {"rule": "clip"}
STIFFNESS = 500.0 * (1.0 - 0.46) / ((1.0 + 0.46) * (1.0 - 2.0 * 0.46)) / 8.0
"""MPa/mm: confined modulus by thickness."""


def turned(vector: np.ndarray) -> np.ndarray:
    """Rotation matrix of a rotation vector, by Rodrigues' formula."""
    angle = np.linalg.norm(vector)
    x, y, z = vector / angle if angle > 0.0 else (1.0, 0.0, 0.0)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def recorded(file: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, matrices of the quaternions and shifts [mm] of a table of poses."""
    table = pd.read_csv(file, skipinitialspace=True)
    q = table[["qw", "qx", "qy", "qz"]].to_numpy()
    w, x, y, z = (q / np.linalg.norm(q, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    shifts = table[["tx [mm]", "ty [mm]", "tz [mm]"]].to_numpy()
    return table["time [s]"].to_numpy(), np.moveaxis(np.array(rows), 2, 0), shifts


class Feb:
    """What a .feb file says, by the standard library."""

    def __init__(self, file: Path) -> None:
        self.root = ET.parse(file).getroot()
        self.nodes = {group.get("name"): self._rows(group) for group in self.root.findall("Mesh/Nodes")}
        first = len(self.nodes["FIXED"])
        faces = {g.get("name"): self._rows(g).astype(int) - 1 for g in self.root.findall("Mesh/Elements")}
        self.faces = {"FIXED": faces["FIXED"], "MOVING": faces["MOVING"] - first}
        touching = {g.get("name"): self._rows(g).astype(int) - 1 for g in self.root.findall("Mesh/Surface")}
        self.touching = {"FIXED": touching["FIXED_surface"], "MOVING": touching["MOVING_surface"] - first}
        curves = {c.get("id"): self._rows(c.find("points")) for c in self.root.findall("LoadData/load_controller")}
        self.time = curves["1"][:, 0]
        self.shift, self.turn = (
            np.column_stack([curves[str(k)][:, 1] for k in some]) for some in ((1, 2, 3), (4, 5, 6))
        )
        centre = self.root.find("Material/material[@name='MOVING']/center_of_mass").text
        self.centre = np.array(centre.split(","), float)

    @staticmethod
    def _rows(group: ET.Element) -> np.ndarray:
        return np.array([each.text.split(",") for each in group], float)

    def placed(self, k: int) -> np.ndarray:
        """MOVING's nodes in a frame: FEBio turns about the centre of mass, by the whole rotation vector."""
        return (self.nodes["MOVING"] - self.centre) @ turned(self.turn[k]).T + self.centre + self.shift[k]


def written(result: AreaResult, folder: Path) -> Path:
    """The folder of the models."""
    with unpictured():
        return result.write(folder) / "export"


@pytest.fixture(scope="module")
def knee(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, AreaResult]:
    """Six frames of the coarse knee with a layer: the motion's file, the folder of the models, the result."""
    folder = tmp_path_factory.mktemp("exported")
    motion = gait(folder, range(0, 101, 20))
    result = pressed(FEMUR, INSERT, motion, export=("febio", "abaqus"), **LAYER, **QUICK)
    return motion, written(result, folder / "out"), result


def test_rigid_motion_of_febio_is_the_recorded_one(knee: tuple[Path, Path, AreaResult]) -> None:
    motion, folder, _ = knee
    feb = Feb(folder / "contact.feb")
    time, R, t = recorded(motion)
    own = (feb.nodes["MOVING"] - t[0]) @ R[0]  # in MOVING's frame
    stl = trimesh.load(FEMUR)
    assert len(feb.faces["MOVING"]) == len(stl.faces)
    np.testing.assert_allclose(own[feb.faces["MOVING"]].mean(axis=(0, 1)), stl.triangles.mean(axis=(0, 1)), atol=1e-5)
    np.testing.assert_allclose(feb.time, time - time[0], atol=1e-9)
    for k in range(len(time)):
        np.testing.assert_allclose(feb.placed(k), own @ R[k].T + t[k], atol=1e-8)


def test_velocities_of_abaqus_lead_from_frame_to_frame(knee: tuple[Path, Path, AreaResult]) -> None:
    motion, folder, _ = knee
    time, R, t = recorded(motion)
    turn, place = R[0], t[0]
    steps = (folder / "contact.inp").read_text(encoding="ascii").split("*STEP")[1:]
    assert len(steps) == len(time) - 1
    for k, step in enumerate(steps, start=1):
        lines = step.splitlines()
        lasting = float(lines[lines.index("*STATIC") + 1].split(",")[0])
        start = lines.index("*BOUNDARY, TYPE=VELOCITY") + 1
        value = np.array([float(line.split(",")[3]) for line in lines[start : start + 6]])
        assert [line.split(",")[1].strip() for line in lines[start : start + 6]] == list("123456")
        place = place + value[:3] * lasting
        turn = turned(value[3:] * lasting) @ turn
        np.testing.assert_allclose(place, t[k], atol=1e-8)
        np.testing.assert_allclose(turn, R[k], atol=1e-9)


def test_areas_of_the_written_surfaces_are_those_of_the_result(
    knee: tuple[Path, Path, AreaResult], tmp_path: Path
) -> None:
    """Both surfaces of a frame, taken from the model, are analysed anew where they lie."""
    _, folder, result = knee
    feb = Feb(folder / "contact.feb")
    k = 3
    for name, nodes in (("FIXED", feb.nodes["FIXED"]), ("MOVING", feb.placed(k))):
        trimesh.Trimesh(nodes, feb.faces[name], process=False).export(tmp_path / f"{name}.stl")
    again = area(tmp_path / "MOVING.stl", tmp_path / "FIXED.stl", poses(tmp_path, (0, 0, 0)), **QUICK)
    assert again.area[0, 0] == pytest.approx(result.area[k, 0], rel=1e-5)
    assert again.area_moving[0, 0] == pytest.approx(result.area_moving[k, 0], rel=1e-5)


def test_contact_law_is_the_layers(knee: tuple[Path, Path, AreaResult]) -> None:
    _, folder, _ = knee
    law = Feb(folder / "contact.feb").root.find("Contact/contact")
    assert law.get("type") == "sliding-elastic" and law.findtext("auto_penalty") == "0"
    assert float(law.findtext("penalty")) == pytest.approx(STIFFNESS, rel=1e-9)
    lines = (folder / "contact.inp").read_text(encoding="ascii").splitlines()
    slope = lines[lines.index("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR") + 1]
    assert float(slope) == pytest.approx(STIFFNESS, rel=1e-9)


def middles_of_pieces(parts: int) -> np.ndarray:
    """Barycentric coordinates of the middles of parts^2 equal pieces of a triangle."""
    upright = [(i + 1 / 3, j + 1 / 3) for i in range(parts) for j in range(parts - i)]
    turned_over = [(i + 2 / 3, j + 2 / 3) for i in range(parts - 1) for j in range(parts - 1 - i)]
    first, second = np.array(upright + turned_over).T / parts
    return np.column_stack([first, second, 1.0 - first - second])


def triangles_press(feb: Feb, k: int, edge: float | None) -> float:
    """Penalty times depth times area over the triangles of a .feb [N], depths by libigl.

    At the middles of pieces with edges of at most `edge` [mm], or at the three points of each triangle where FEBio is.
    """
    moving = trimesh.Trimesh(feb.placed(k), feb.faces["MOVING"])
    assert moving.is_watertight and moving.volume > 0.0
    low, high = moving.bounds
    points, areas = [], []
    for corners in feb.nodes["FIXED"][feb.touching["FIXED"]]:
        across = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        if across[1] <= 0.0 or (corners.min(axis=0) > high).any() or (corners.max(axis=0) < low).any():
            continue  # of the underside, or beside
        longest = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).max()
        weights = (np.eye(3) * 3 + 1) / 6 if edge is None else middles_of_pieces(int(np.ceil(longest / edge)))
        points.append(weights @ corners)
        areas.append(np.full(len(weights), 0.5 * np.linalg.norm(across) / len(weights)))
    point, area_of = np.vstack(points), np.concatenate(areas)
    near = ((point >= low) & (point <= high)).all(axis=1)
    depth = -igl.signed_distance(point[near], moving.vertices.view(np.ndarray), moving.faces.astype(np.int64))[0]
    return float(feb.root.findtext("Contact/contact/penalty")) * float(np.maximum(depth, 0.0) @ area_of[near])


def forces_warned_of(result: AreaResult) -> tuple[float, ...]:
    """Force of the flat triangles, at FEBio's points, and the one computed [N]."""
    (line,) = (each for each in result.reservations("") if "triangles of the models are flat" in each)
    assert f"in frame {int(np.argmax(result.force)) + 1} of {len(result.force)} " in line
    found = re.search(r"press with (\S+) N, and (\S+) N at the three .* is (\S+) N; give finer meshes", line)
    return tuple(map(float, found.groups()))


def test_force_of_the_written_triangles_of_the_knee_is_said(knee: tuple[Path, Path, AreaResult]) -> None:
    """Smooth facets of the coarse knee lie higher than its triangles: the model has a part of the force."""
    _, folder, result = knee
    feb, k = Feb(folder / "contact.feb"), int(np.argmax(result.force))
    flat, at_points, computed = forces_warned_of(result)
    assert computed == pytest.approx(result.force[k], rel=1e-3)
    assert flat == pytest.approx(triangles_press(feb, k, 1.0), rel=2e-3) and flat < 0.5 * computed
    assert at_points == pytest.approx(triangles_press(feb, k, None), rel=2e-3, abs=1e-3)


def test_stiffness_times_the_volume_of_overlap_is_the_force(tmp_path: Path) -> None:
    """A ball over a plate: volume of the spherical cap of the depth that the model prescribes, and its triangles."""
    depths = (0.2, 0.4)
    motion = poses(tmp_path, *((0.0, 20.0 - depth, 0.0) for depth in depths))
    result = pressed(SPHERE, PLATE, motion, export=("febio",), threshold=0.0, **LAYER, **QUICK)
    feb = Feb(written(result, tmp_path / "out") / "contact.feb")
    top = feb.nodes["FIXED"][:, 1].max()
    for k, force in enumerate(result.force):
        depth = top - feb.placed(k)[:, 1].min()
        assert depth == pytest.approx(depths[k], abs=2e-3)
        assert STIFFNESS * np.pi * depth**2 * (20.0 - depth / 3.0) == pytest.approx(force, rel=0.04)
    flat, at_points, _ = forces_warned_of(result)
    assert flat == pytest.approx(triangles_press(feb, 1, 1.0), rel=2e-3)
    assert at_points == pytest.approx(triangles_press(feb, 1, None), rel=2e-3, abs=1e-3)


def test_fine_flat_triangles_have_the_force_and_are_not_doubted(tmp_path: Path) -> None:
    """With flat facets on both sides and triangles small beside the contact nothing is lost."""
    bent, top = sphere(20.0, 24), block(12.0, 12.0, 12.0, 24)
    ball = saved(tmp_path / "ball.stl", stl(bent[0][bent[1]]))
    plate = saved(tmp_path / "plate.stl", stl(top[0][top[1]]))
    result = pressed(
        ball, plate, poses(tmp_path, (0, 19.5, 0)), export=("febio",), facets="flat", threshold=0.0, **LAYER, **QUICK
    )
    feb = Feb(written(result, tmp_path / "out") / "contact.feb")
    assert not [line for line in result.reservations("") if "triangles" in line]
    assert triangles_press(feb, 0, None) == pytest.approx(result.force[0], rel=0.01)


@pytest.fixture(scope="module", params=["inwards", "repeated"])
def odd(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Models of a ball and a plate whose files are wound inwards, or have a face twice and one without area."""
    folder = tmp_path_factory.mktemp("odd")
    files = []
    for name, (vertices, faces) in (("ball", sphere(20.0, 8)), ("pl---ate", block(60.0, 30.0, 12.0, 4))):
        more = np.vstack([[[*faces[0, :2], faces[0, 1]]], faces, faces[:1]])
        rows = faces[:, ::-1] if request.param == "inwards" else more
        files.append(saved(folder / f"{name}.stl", stl(vertices[rows])))
    motion = poses(folder, (0, 19.7, 0))
    regions = {"region": "ny>0.5", "region_moving": "y<0"}
    return written(area(*files, motion, export=("febio", "abaqus"), **regions, **QUICK), folder / "out")


def test_faces_are_written_outwards_with_an_area_and_once(odd: Path) -> None:
    feb = Feb(odd / "contact.feb")
    for name, volume in (("FIXED", 60.0 * 30.0 * 12.0), ("MOVING", 4.0 / 3.0 * np.pi * 20.0**3)):
        corners = feb.nodes[name][feb.faces[name]]
        signed = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0
        assert signed == pytest.approx(volume, rel=0.1)
        rows = np.sort(feb.faces[name], axis=1)
        assert (np.diff(rows, axis=1) > 0).all() and len(np.unique(rows, axis=0)) == len(rows)
    abaqus = (odd / "contact.inp").read_text(encoding="ascii")
    first = len(feb.nodes["FIXED"])
    for name, start in (("FIXED", 0), ("MOVING", first)):
        rows = abaqus.partition(f"*ELEMENT, TYPE=S3, ELSET={name}\n")[2].partition("*")[0].splitlines()
        theirs = np.array([row.split(",")[1:] for row in rows], int) - 1 - start
        np.testing.assert_array_equal(theirs, feb.faces[name])


def test_regions_hold_for_the_faces_that_are_written(odd: Path) -> None:
    """The top of FIXED; `region_moving` is of MOVING's area alone, and all of MOVING presses."""
    feb = Feb(odd / "contact.feb")
    corners = feb.nodes["FIXED"][feb.touching["FIXED"]]
    assert len(corners) == 2 * 4 * 2 and (corners[:, :, 1] == feb.nodes["FIXED"][:, 1].max()).all()
    np.testing.assert_array_equal(feb.touching["MOVING"], feb.faces["MOVING"])


def test_two_layers_are_in_series(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, 19.9, 0), (0, 19.8, 0))
    second = {"modulus_moving": gc.MPa(250), "poisson_moving": 0.3, "thickness_moving": gc.mm(3)}
    result = pressed(SPHERE, PLATE, motion, export=("febio",), threshold=0.0, **LAYER, **second, **QUICK)
    feb = Feb(written(result, tmp_path / "out") / "contact.feb")
    other = 250.0 * 0.7 / (1.3 * 0.4) / 3.0
    series = 1.0 / (1.0 / STIFFNESS + 1.0 / other)
    assert float(feb.root.findtext("Contact/contact/penalty")) == pytest.approx(series, rel=1e-9)


def test_what_the_models_leave_out_is_a_warning(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, 21, 0), (0, 20.5, 0))
    plain = area(SPHERE, PLATE, motion, export=("febio", "abaqus"), **QUICK)
    folder = written(plain, tmp_path / "plain")
    assert sum("no contact law, since no pressures were computed" in line for line in plain.reservations("")) == 1
    assert Feb(folder / "contact.feb").root.find("Contact") is None
    assert "*CONTACT PAIR" not in (folder / "contact.inp").read_text(encoding="ascii")
    rays = LAYER | {"thickness": "rays", "foundation": "logarithmic"}
    knee = pressed(FEMUR, INSERT, gait(tmp_path, (0, 20)), export=("febio",), **rays, **QUICK)
    written(knee, tmp_path / "knee")
    said = " ".join(knee.reservations(""))
    assert "one stiffness, of the median thickness" in said and "`foundation` is logarithmic" in said


def test_regions_are_the_surfaces_that_touch(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, 21, 0))
    result = area(SPHERE, PLATE, motion, export=("febio", "abaqus"), region="ny>0.5", **QUICK)
    folder = written(result, tmp_path / "out")
    feb = Feb(folder / "contact.feb")
    surface = feb.root.find("Mesh/Surface[@name='FIXED_surface']")
    corners = feb.nodes["FIXED"][np.array([each.text.split(",") for each in surface], int) - 1]
    assert np.ptp(corners[:, :, 1]) == 0.0 and corners[0, 0, 1] == feb.nodes["FIXED"][:, 1].max()
    whole = feb.faces["FIXED"]
    assert 0 < len(corners) < len(whole)
    listed = (folder / "contact.inp").read_text(encoding="ascii").partition("*ELSET, ELSET=FIXED_FACES\n")[2]
    numbers = [int(word) for line in listed.partition("*")[0].splitlines() for word in line.split(",")]
    np.testing.assert_allclose(feb.nodes["FIXED"][whole[np.array(numbers) - 1]], corners)


def test_one_frame_stands_still(tmp_path: Path) -> None:
    result = area(SPHERE, PLATE, poses(tmp_path, (1, 21, 2)), export=("febio", "abaqus"), **QUICK)
    folder = written(result, tmp_path / "out")
    feb = Feb(folder / "contact.feb")
    np.testing.assert_array_equal(feb.time, [0.0, 1.0])
    assert not feb.shift.any() and not feb.turn.any()
    assert (folder / "contact.inp").read_text(encoding="ascii").count("*STEP") == 1


def exported_model(folder: Path) -> Path:
    """A copy of the sample knee's model with both meshes: the femoral component is the joint's parent."""
    given = {"osim": MESHES / "knee.osim", "joint": "knee_r", "moving_body": "parent"}
    result = area(FEMUR, INSERT, storage(folder), export=("opensim", "febio"), **given, **QUICK)
    return written(result, folder / "out")


def test_meshes_hang_on_the_bodies_of_the_joint(tmp_path: Path) -> None:
    folder = exported_model(tmp_path)
    root = ET.parse(folder / "knee.osim").getroot()
    for body, name, mesh in (("femoral_component", "moving", FEMUR), ("tibial_insert", "fixed", INSERT)):
        (shown,) = root.findall(f".//Body[@name='{body}']/attached_geometry/Mesh[@name='geocontact_{name}']")
        scale = np.array(shown.findtext("scale_factors").split(), float)
        ours = trimesh.load(folder / "Geometry" / shown.findtext("mesh_file")).triangles * scale
        theirs = trimesh.load(mesh).triangles * 1e-3
        np.testing.assert_allclose(ours, theirs, atol=1e-8)
    assert len(root.findall(".//Mesh")) == 4


def test_opensim_opens_the_copy_and_moves_the_mesh_as_the_model_for_febio(tmp_path: Path, opensim: Elsewhere) -> None:
    folder = exported_model(tmp_path)
    shown = opensim(opensim_oracle.meshes, folder / "knee.osim")
    assert shown["geocontact_fixed"] == ("tibial_insert", "fixed.stl", [0.001] * 3)
    assert shown["geocontact_moving"] == ("femoral_component", "moving.stl", [0.001] * 3)
    lines = storage(tmp_path).read_text(encoding="utf-8").splitlines()
    start = lines.index("endheader") + 1
    names, values = lines[start].split()[1:], np.array([line.split()[1:] for line in lines[start + 1 :]], float)
    values[:, [not name.endswith(("tx", "ty", "tz")) for name in names]] *= np.pi / 180.0
    pair = ("femoral_component", "tibial_insert")
    matrices = opensim(opensim_oracle.poses, folder / "knee.osim", names, values, [pair])[:, 0]
    mesh = trimesh.load(folder / "Geometry" / "moving.stl").vertices
    feb = Feb(folder / "contact.feb")
    for k, X in enumerate(matrices):
        theirs = mesh @ X[:3, :3].T + X[:3, 3] * 1e3
        np.testing.assert_allclose(theirs.min(axis=0), feb.placed(k).min(axis=0), atol=1e-4)
        np.testing.assert_allclose(theirs.max(axis=0), feb.placed(k).max(axis=0), atol=1e-4)


def test_a_copy_that_is_exported_again_has_each_mesh_once_and_is_not_replaced(tmp_path: Path) -> None:
    """The command refuses its own folder before it computes; Python knows the folder when it writes."""
    copy = exported_model(tmp_path) / "knee.osim"
    before = copy.read_bytes()
    given = {"osim": copy, "joint": "knee_r", "moving_body": "parent", "export": ("opensim",)}
    result = area(FEMUR, INSERT, storage(tmp_path), **given, **QUICK)
    again = ET.parse(written(result, tmp_path / "second") / "knee.osim").getroot()
    names = sorted(name for e in again.iter("Mesh") if (name := e.get("name")).startswith("geocontact_"))
    assert names == ["geocontact_fixed", "geocontact_moving"]
    with pytest.raises(InputError, match="is a copy in `out`"):
        result.write(tmp_path / "out")
    joint = ("--osim", copy, "--joint", "knee_r", "--moving", "parent", "--export", "opensim")
    words = ("area", FEMUR, INSERT, "--unit", "mm", "--motion", storage(tmp_path), *joint)
    refused = call(*words, "--out", tmp_path / "out")
    assert refused.code == 2 and "is a copy in --out" in refused.err, refused.err
    assert copy.read_bytes() == before


def test_a_model_that_cannot_take_the_meshes_is_refused_before_the_motion_is_read(tmp_path: Path) -> None:
    """OpenSim 3 draws this body in another frame; the motion, which is read next, is no table."""
    model = write_model(tmp_path, model3("PinJoint", "", ("a",), "false", VISIBLE))
    no_motion = tmp_path / "motion.mot"
    no_motion.write_text("no table")
    with pytest.raises(InputError, match="drawn in a frame that is not its own"):
        area(FEMUR, INSERT, no_motion, export=("opensim",), osim=model, joint="j", **QUICK)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (("ansys",), r"`export`: 'ansys' is not a program; name one of: febio, abaqus, opensim"),
        (("febio", "febio"), "one twice"),
        (("opensim",), "there is no model; give `osim` and `joint`"),
    ],
)
def test_programs_that_cannot_be_written_for(tmp_path: Path, asked: tuple[str, ...], said: str) -> None:
    with pytest.raises(InputError, match=said):
        area(SPHERE, PLATE, poses(tmp_path, (0, 20, 0)), export=asked)


def test_the_command_line_takes_several_programs(tmp_path: Path) -> None:
    with unpictured():
        done = call(
            "area", SPHERE, PLATE, "--unit", "mm", "--motion", poses(tmp_path, (0, 20, 0)), "--out", tmp_path / "out",
            "--rule", "clip", "--export", "febio,abaqus",
        )  # fmt: skip
    assert done.code == 0 and "--export: the models for finite elements have no contact law" in done.err
    assert {"contact.feb", "contact.inp"} == {file.name for file in (tmp_path / "out" / "export").iterdir()}
    refused = call("area", SPHERE, PLATE, "--unit", "mm", "--motion", "x.csv", "--out", tmp_path, "--export", "ansys")
    assert refused.code == 2 and "--export" in refused.err
