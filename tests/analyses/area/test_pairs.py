"""Several pairs of bodies in one motion: the numbers of single runs to the last digit, sums, loads, and refusals."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.analyses.area.pairs.result import PairsResult
from geocontact.data.errors import InputError, InputWarning
from geocontact.view.page.content import Scene, Table
from meshes.simple_shapes import cup, sphere
from meshes.stl import stl_bytes
from tests.analyses.area.calls import area, pressed
from tests.cli.calls import FEMUR, INSERT, MESHES, PLATE, SPHERE, call, done, in_metres, unpictured, written
from tests.closed_forms import sphere_cup_on_cup, sphere_sphere_on_first

PATELLA = MESHES / "patella_right_coarse.stl"
FRAMES = [0, 14, 72]


def few(folder: Path, name: str) -> Path:
    """Some rows of a shipped motion."""
    lines = (MESHES / name).read_text("utf-8").splitlines()
    return written(folder / name, "\n".join([lines[0], *(lines[1 + k] for k in FRAMES)]) + "\n")


def described(folder: Path, text: str) -> Path:
    return written(folder / "pairs.toml", text)


def knee(folder: Path, more: str = "") -> Path:
    """The shipped description with three frames, beside its meshes."""
    text = (MESHES / "knee_pairs.toml").read_text("utf-8")
    for name in ("gait.csv", "gait_patella.csv"):
        text = text.replace(name, few(folder, name).as_posix())
    for mesh in (FEMUR, INSERT, PATELLA):
        text = text.replace(f'"{mesh.name}"', f'"{mesh.as_posix()}"')
    return described(folder, text + more)


def run(file: Path, **options: Any) -> PairsResult:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return gc.area_pairs(file, **{"threshold": (1e-3, 4e-3), "workers": 1, "rule": "clip", **options})


def same(one: pd.DataFrame, other: pd.DataFrame) -> None:
    pd.testing.assert_frame_equal(one, other, check_exact=True)


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> PairsResult:
    return run(knee(tmp_path_factory.mktemp("pairs")))


def test_each_pair_is_its_single_run_to_the_last_digit(found: PairsResult, tmp_path: Path) -> None:
    femur, patella = few(tmp_path, "gait.csv"), few(tmp_path, "gait_patella.csv")
    given: dict[str, Any] = {"threshold": (1e-3, 4e-3), "workers": 1, "rule": "clip"}
    medial = area(FEMUR, INSERT, femur, region="z < 0", **given).table()
    lateral = area(FEMUR, INSERT, femur, region="z > 0", **given).table()
    behind = area(PATELLA, FEMUR, patella, motion_fixed=str(femur), **given).table()
    for name, alone in (("medial", medial), ("lateral", lateral), ("patellofemoral", behind)):
        same(found.table(f"{name}/area"), alone)
        rows = found.table("pairs")
        own = rows[rows["pair"] == name].drop(columns="pair").reset_index(drop=True)
        same(own[alone.columns], alone)
        assert own.drop(columns=alone.columns).isna().all().all(), "coverage of a region that another pair has"
    totals = found.table()
    np.testing.assert_array_equal(totals["area_medial [mm^2]"], medial["area_fixed [mm^2]"])
    three = medial["area_fixed [mm^2]"] + lateral["area_fixed [mm^2]"] + behind["area_fixed [mm^2]"]
    np.testing.assert_allclose(totals["area_total [mm^2]"], three, rtol=1e-14)
    least = np.minimum(
        np.minimum(medial["min_distance [mm]"], lateral["min_distance [mm]"]), behind["min_distance [mm]"]
    )
    np.testing.assert_array_equal(totals["min_distance [mm]"], least)
    assert behind["area_fixed [mm^2]"].min() > 50.0, "the button lies in the groove in every frame"


def test_a_body_in_a_unit_of_its_own_gives_the_same_rows(found: PairsResult, tmp_path: Path) -> None:
    """The femur in m is MOVING of two pairs and FIXED of the third; a wrong unit is refused by its key."""
    file = knee(tmp_path)
    femur = in_metres(tmp_path, FEMUR).as_posix()
    text = file.read_text("utf-8").replace(f'mesh = "{FEMUR.as_posix()}"', f'mesh = "{femur}"\nunit = "m"')
    other = run(described(tmp_path, text))
    same(other.table("pairs"), found.table("pairs"))
    same(other.table(), found.table())
    with pytest.raises(InputError, match=r"femoral.*: bounding box .*, pass `unit` m$"):
        run(described(tmp_path, text.replace('unit = "m"', 'unit = "cm"')))
    with pytest.raises(InputError, match=r"pairs\.toml \[\[bodies\]\] .*unit"):
        run(described(tmp_path, text.replace('unit = "m"', 'unit = "km"')))


def test_vertices_of_all_meshes_are_merged_within_a_tolerance(found: PairsResult, tmp_path: Path) -> None:
    text = 'merge_tolerance = { value = 1e-4, unit = "mm" }\n' + knee(tmp_path).read_text("utf-8")
    other = run(described(tmp_path, text))
    same(other.table(), found.table())
    assert sum("`merge_tolerance` has no effect" in line for line in other.warnings) == 3


def turned(folder: Path, name: str, place: np.ndarray, turn: Rotation) -> Path:
    """The same pose at two times [mm]."""
    cells = [*place.tolist(), *turn.as_quat(scalar_first=True).tolist()]
    head = "time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz"
    return written(folder / name, "\n".join([head, *(", ".join(map(repr, [t, *cells])) for t in (0.0, 1.0))]) + "\n")


def facets_within(vertices: np.ndarray, faces: np.ndarray, radius: float) -> float:
    """How far facets lie inside the sphere of this radius that their corners are on."""
    corners = vertices[faces]
    on = np.abs(np.linalg.norm(corners, axis=2) - radius).max(axis=1) < 1e-6
    normal = np.cross(corners[on, 1] - corners[on, 0], corners[on, 2] - corners[on, 0])
    height = np.abs(np.einsum("ij,ij->i", normal, corners[on, 0])) / np.linalg.norm(normal, axis=1)
    return float(radius - height.min())


def solid(folder: Path, name: str, body: tuple[np.ndarray, np.ndarray]) -> str:
    file = folder / f"{name}.stl"
    file.write_bytes(stl_bytes(*body, name))
    return file.as_posix()


def test_a_head_in_a_cup_and_a_ball_on_the_head_are_the_closed_forms(tmp_path: Path) -> None:
    """A hip: the areas on cup and head of smooth spheres, but for what facets cost; the third body changes nothing."""
    away, gap, apart = np.array([0.6, -0.8, 0.0]), 0.3, 0.5
    head = turned(tmp_path, "head.csv", (24.0 - 18.0 - gap) * away, Rotation.from_rotvec([0.2, 0.1, -0.3]))
    ball = turned(tmp_path, "ball.csv", (24.0 - 18.0 - gap) * away - (18.0 + 10.0 + apart) * away, Rotation.identity())
    bodies = {"cup": cup(24.0, 5.0, 28), "head": sphere(18.0, 24), "ball": sphere(10.0, 16)}
    meshes = {name: solid(tmp_path, name, body) for name, body in bodies.items()}
    text = f"""unit = "mm"
[[bodies]]
name = "cup"
mesh = "{meshes["cup"]}"
[[bodies]]
name = "head"
mesh = "{meshes["head"]}"
motion = "{head.as_posix()}"
[[bodies]]
name = "ball"
mesh = "{meshes["ball"]}"
motion = "{ball.as_posix()}"
[[pairs]]
moving = "head"
fixed = "cup"
[[pairs]]
name = "above"
moving = "ball"
fixed = "head"
"""
    result = run(described(tmp_path, text), threshold=(1e-3, 2e-3))
    radii = {"cup": 24.0, "head": 18.0, "ball": 10.0}
    deep = {name: facets_within(*bodies[name], radius) for name, radius in radii.items()}
    for k, threshold in enumerate((1.0, 2.0)):
        for pair, off, smooth in (
            ("head_cup", deep["cup"] + deep["head"], lambda t: sphere_cup_on_cup(18.0, 24.0, 6.0 - gap, t)),
            ("above", deep["head"] + deep["ball"], lambda t: sphere_sphere_on_first(18.0, 10.0, apart, t)),
        ):
            least, most = 0.998 * smooth(threshold - off), smooth(threshold + off)  # facets also shrink the surface
            assert most < 1.1 * least
            assert least < 1e6 * result.areas[pair][0, k] < most, (pair, threshold)
    np.testing.assert_allclose(result.table()["min_distance [mm]"], gap, atol=0.02)
    assert set(result.table()["nearest"]) == {"head_cup"}


BALLS = f"""unit = "mm"
[[bodies]]
name = "ball"
mesh = "{SPHERE.as_posix()}"
motion = "ball.csv"
[[bodies]]
name = "plate"
mesh = "{PLATE.as_posix()}"
motion = "plate.csv"
[[pairs]]
moving = "ball"
fixed = "plate"
layer = {{ modulus = {{ value = 500, unit = "MPa" }}, poisson = 0.46, piece = {{ value = 2, unit = "mm" }} }}
"""


def balls(folder: Path, text: str = BALLS) -> Path:
    """A ball pressed into a plate that lies askew in the common frame."""
    turn, place = Rotation.from_rotvec([0.4, -0.7, 1.1]), np.array([100.0, -30.0, 70.0])
    turned(folder, "plate.csv", place, turn)
    turned(folder, "ball.csv", place + turn.apply([2.0, 19.9, 3.0]), turn)
    return described(folder, text)


def test_loads_are_those_of_the_pair_in_the_common_frame(tmp_path: Path) -> None:
    """By hand from the pair's own table: R F, R M + t x R F; the ball bears the opposite."""
    result = run(balls(tmp_path))
    layer: dict[str, Any] = {"modulus": 500e6, "poisson": 0.46, "piece": 2e-3, "workers": 1, "rule": "clip"}
    alone = pressed(SPHERE, PLATE, tmp_path / "ball.csv", motion_fixed=str(tmp_path / "plate.csv"), **layer)
    same(result.table("ball_plate/pressure"), alone.table("pressure"))
    own = alone.table("pressure")
    force, moment = (
        own[[f"{kind}_{x} [{unit}]" for x in "xyz"]].to_numpy() for kind, unit in (("force", "N"), ("moment", "N m"))
    )
    assert force[0, 1] < -100.0 and abs(moment[0]).max() > 0.1, "pressed down, beside the origin"
    angle = np.linalg.norm([0.4, -0.7, 1.1])
    k = np.array([0.4, -0.7, 1.1]) / angle
    cross = np.array([[0.0, -k[2], k[1]], [k[2], 0.0, -k[0]], [-k[1], k[0], 0.0]])
    turn = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross  # Rodrigues
    for t in range(2):
        there = turn @ force[t]
        about = turn @ moment[t] + np.cross([0.1, -0.03, 0.07], there)
        np.testing.assert_allclose(result.loads["plate"][t], [*there, *about], rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(result.loads["plate"], -result.loads["ball"])
    table = result.table("loads")
    np.testing.assert_array_equal(table["ball_fx [N]"], result.loads["ball"][:, 0])
    np.testing.assert_allclose(result.table()["force_ball_plate [N]"].iloc[::2], own["force [N]"], rtol=1e-12)
    names = ["fx [N]", "fy [N]", "fz [N]", "mx [N m]", "my [N m]", "mz [N m]"]
    by_pair = result.table("pair_loads")
    for body in ("plate", "ball"):
        np.testing.assert_array_equal(by_pair[by_pair["on"] == body][names], result.loads[body])
    assert set(by_pair["pair"]) == {"ball_plate"}
    shown = [one for one in result.pages({})["report.html"].of(101).sections if isinstance(one, Table)]
    rows = next(one.rows for one in shown if one.title.startswith("Loads at"))
    assert [row[:2] for row in rows] == [("ball_plate", "plate"), ("all pairs", "plate"), ("all pairs", "ball")]
    assert rows[0][2].split(", ")[1] == f"{result.loads['plate'][0, 1]:.1f}"


def test_bodies_of_a_model_move_with_its_segments(tmp_path: Path) -> None:
    """One .mot for all bodies: as the joint of that model moves the one in the other."""
    coordinates = tmp_path / "few.mot"
    lines = (MESHES / "gait.mot").read_text("utf-8").splitlines()
    written(
        coordinates, "\n".join([*lines[:7], *(lines[7 + k] for k in FRAMES)]).replace("nRows=101", "nRows=3") + "\n"
    )
    text = f"""unit = "mm"
model = "{(MESHES / "knee.osim").as_posix()}"
coordinates = "few.mot"
[[bodies]]
name = "femur"
mesh = "{FEMUR.as_posix()}"
segment = "femoral_component"
[[bodies]]
name = "insert"
mesh = "{INSERT.as_posix()}"
segment = "tibial_insert"
[[pairs]]
moving = "femur"
fixed = "insert"
"""
    ours = run(described(tmp_path, text)).table("femur_insert/area")
    given: dict[str, Any] = {
        "osim": MESHES / "knee.osim",
        "joint": "knee_r",
        "moving_body": "parent",
        "workers": 1,
        "rule": "clip",
    }
    theirs = area(FEMUR, INSERT, coordinates, threshold=(1e-3, 4e-3), **given).table()
    pd.testing.assert_frame_equal(ours, theirs, check_exact=False, rtol=1e-6, atol=1e-6)
    unknown = described(tmp_path, text.replace('segment = "tibial_insert"', 'segment = "shank"'))
    with pytest.raises(
        InputError, match=r"\[\[bodies\]\] segment: insert: no segment 'shank' in knee.osim; there are ground"
    ):
        run(unknown)


def test_the_page_shows_all_bodies_and_leads_to_each_pair(found: PairsResult) -> None:
    pages = found.pages({})
    assert set(pages) == {"report.html", *(f"{name}/report.html" for name in ("medial", "lateral", "patellofemoral"))}
    page = pages["report.html"].of(101)
    scene = next(one for one in page.sections if isinstance(one, Scene))
    assert [body.name for body in scene.bodies] == ["femur", "insert", "patella"]
    moves = [body.poses is not None for body in scene.bodies]
    assert moves == [True, False, True] and len(page.time) == 3
    femur = scene.bodies[0].distance
    parts = [one.maps.moving for one in found.motions[:2]] + [found.motions[2].maps.fixed]
    np.testing.assert_array_equal(femur, np.fmin(np.fmin(*parts[:2]), parts[2]))
    links = [one.links for one in page.sections if isinstance(one, Table) and one.links]
    assert links == [["medial/report.html", "lateral/report.html", "patellofemoral/report.html"]]
    assert f"{1e6 * found.area[:, 1].max():.4g} mm²" in page.headline[0]


def test_what_counts_twice_or_does_not_fit_is_said(tmp_path: Path) -> None:
    both = knee(tmp_path).read_text("utf-8").replace('region = "z > 0"', 'region = "z > -5"')
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        gc.area_pairs(described(tmp_path, both), rule="clip", workers=1)
    told = [str(one.message) for one in caught]
    assert "faces of insert count in medial and in lateral: where both touch, the total has them twice" in told
    for change, said in (
        (
            ('moving = "patella"', 'moving = "tibia"'),
            "[[pairs]] 3 moving: no body is called tibia; there are femur, insert",
        ),
        (('fixed = "femur"', 'fixed = "patella"'), "patella is both moving and fixed; name two bodies"),
        (('region = "z < 0"', 'region = "z < -900"'), "[[pairs]] medial `region`: 'z < -900' holds for no face"),
        (('unit = "mm"', 'unit = "mm"\nrate = { value = 50, unit = "Hz" }'), "rate: has no effect here"),
        (('name = "lateral"', 'name = "total"'), "[[pairs]] 2 name: total is what the sums of all pairs are called"),
        (('name = "lateral"', 'name = "medial"'), "two have the name 'medial'"),
        (('name = "insert"', 'name = "insert"\nsegment = "tibia"'), "segment: needs a model and its coordinates"),
    ):
        text = knee(tmp_path).read_text("utf-8")
        assert text.count(change[0]) == 1
        with pytest.raises(InputError) as refused:
            run(described(tmp_path, text.replace(*change)))
        assert said in str(refused.value), refused.value


def test_poses_without_times_ask_for_what_the_description_may_say(tmp_path: Path) -> None:
    """What the message writes is taken by the reader, at the head of the file; and the times are those of the rate."""
    text = BALLS.replace('motion = "plate.csv"\n', "")
    rows = np.tile(np.eye(4).ravel(), (2, 1))
    rows[:, 7] = 19.9, 19.8
    written(tmp_path / "ball.csv", "\n".join(" ".join(f"{x:g}" for x in row) for row in rows) + "\n")
    with pytest.raises(InputError) as refused:
        run(described(tmp_path, text))
    found = re.search(r'write (rate = \{ value = (\d+), unit = "Hz" \}) into pairs\.toml, above', str(refused.value))
    assert found is not None and "pass `rate`" not in str(refused.value), refused.value
    result = run(described(tmp_path, f"{found[1]}\n{text}"))
    assert result.time.tolist() == [0.0, 1.0 / float(found[2])]


def test_a_body_with_other_times_is_interpolated_and_said(tmp_path: Path) -> None:
    file = balls(tmp_path)
    text = (tmp_path / "plate.csv").read_text("utf-8").splitlines()
    longer = [text[0], text[1].replace("0.0", "-1.0", 1), text[1].replace("0.0", "3.0", 1)]
    written(tmp_path / "plate.csv", "\n".join(longer) + "\n")
    result = run(file)
    assert any("has other times than" in line for line in result.warnings)
    assert result.time.tolist() == [0.0, 1.0]
    written(tmp_path / "plate.csv", "\n".join([text[0], text[1]]) + "\n")
    with pytest.raises(InputError, match="is known from 0 to 0 s only, not from 0 to 1"):
        run(file)


def test_two_bodies_in_reverse_are_one_contact_and_it_is_said(tmp_path: Path) -> None:
    """Each pair has a layer: the loads on both bodies are those of two contacts."""
    layer = BALLS[BALLS.index("layer = ") :]
    said = "faces of plate count in ball_plate and in reversed: where both touch, the {} them twice"

    def told(more: str, text: str = BALLS) -> list[str]:
        added = f'[[pairs]]\nname = "reversed"\nmoving = "plate"\nfixed = "ball"\n{more}'
        result = run(balls(tmp_path, text + added))
        assert (abs(result.loads["plate"][0]) > 1.0).any()
        return [line for line in result.warnings if line.startswith("faces of")]

    alone = run(balls(tmp_path))
    assert told("") == [said.format("total has")]
    assert told(layer) == [said.format("total and loads have")]
    both = run(tmp_path / "pairs.toml")
    whole, once = (np.linalg.norm(found.loads["plate"][0, :3]) for found in (both, alone))
    assert whole / once == pytest.approx(1.0 + 12.0 / 40.0, rel=0.03), "as thick as plate and ball: forces go by 1/h"
    apart = 'region_moving = "y < 0"\n'
    assert told('region = "y > 0"\n', BALLS.replace("layer =", f"{apart}layer =")) == []


def test_a_body_of_no_pair_sets_no_times(tmp_path: Path) -> None:
    """It stands first, with a motion of other times."""
    turned(tmp_path, "idle.csv", np.zeros(3), Rotation.identity())
    idle = f'[[bodies]]\nname = "idle"\nmesh = "{SPHERE.as_posix()}"\nmotion = "idle.csv"\n'
    text = (tmp_path / "idle.csv").read_text("utf-8").splitlines()
    written(tmp_path / "idle.csv", "\n".join([text[0], text[1].replace("0.0", "-7.0", 1), text[1]]) + "\n")
    result = run(balls(tmp_path, BALLS.replace("[[bodies]]", f"{idle}[[bodies]]", 1)))
    assert result.time.tolist() == [0.0, 1.0]
    assert any("idle is in no pair and is left out" in line for line in result.warnings)
    rest = BALLS.replace('motion = "ball.csv"\n', "").replace('motion = "plate.csv"\n', "")
    with pytest.raises(InputError, match="no body of a pair moves; write a motion for one"):
        run(described(tmp_path, rest.replace("[[bodies]]", f"{idle}[[bodies]]", 1)))


def test_the_command_writes_a_folder_for_each_pair(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with unpictured():
        told = done(call("pairs", balls(tmp_path), "--rule", "clip", "--out", out, folder=out))
    assert "ball_plate: linear foundation: force up to" in told.out
    for name in ("totals.csv", "pairs.csv", "loads.csv", "pair_loads.csv", "run.json"):
        assert (out / name).is_file(), name
    for name in ("area.csv", "pressure.csv", "run.json"):
        assert (out / "ball_plate" / name).is_file(), name


def test_a_pair_that_never_comes_near_is_named(tmp_path: Path) -> None:
    file = balls(tmp_path)
    turned(tmp_path, "far.csv", np.array([0.0, 0.0, 5000.0]), Rotation.identity())
    far = f'[[bodies]]\nname = "far"\nmesh = "{SPHERE.as_posix()}"\nmotion = "far.csv"\n'
    text = file.read_text("utf-8") + far + '[[pairs]]\nmoving = "far"\nfixed = "plate"\n'
    with pytest.raises(InputError, match=r"pairs.toml \[\[pairs\]\] far_plate: bodies are 4.* mm apart in every frame"):
        run(described(tmp_path, text))
