"""Several bodies at rest on each other: `knee settle` for one pair, a hip with a ball on its head by hand, refusals."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.analyses.area.pairs.rest import SettlePairsResult, goodness_of
from geocontact.analyses.area.pairs.virtual_work import imbalance
from geocontact.data.errors import InputError, InputWarning
from geocontact.view.page.content import Scene, Table
from meshes.simple_shapes import cup, sphere
from tests.analyses.area.test_pairs import described, few, solid, turned
from tests.cli.calls import FEMUR, INSERT, PLATE, SPHERE, call, corners, done, stl, unpictured, written

E, NU = 500.0, 0.46
M = 1e6 * E * (1 - NU) / ((1 + NU) * (1 - 2 * NU))
LAYER = f'modulus = {{ value = {E:g}, unit = "MPa" }}, poisson = {NU}'


def settle(file: Path) -> SettlePairsResult:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return gc.settle_pairs(file)


def knee(folder: Path, more: str = "") -> Path:
    """Femur and insert of the shipped knee in three frames."""
    motion = few(folder, "gait.csv")
    text = f"""unit = "mm"
[[bodies]]
name = "femur"
mesh = "{FEMUR.as_posix()}"
motion = "{motion.as_posix()}"
[[bodies]]
name = "insert"
mesh = "{INSERT.as_posix()}"
[[pairs]]
moving = "femur"
fixed = "insert"
region = "ny > 0.25"
layer = {{ {LAYER}, piece = {{ value = 1, unit = "mm" }} }}
[[free]]
body = "femur"
axes = "insert"
settles = ["rx", "ty"]
fy = {{ value = -2000, unit = "N" }}
"""
    return described(folder, text + more)


def test_one_pair_comes_to_rest_where_knee_settle_has_it(tmp_path: Path) -> None:
    """Both stop at residuals of a millionth of the load, from other starts: 2e-3 N over 10 kN/mm is 2e-10 m."""
    ours = settle(knee(tmp_path))
    theirs = gc.knee.settle(
        FEMUR,
        INSERT,
        unit="mm",
        side="right",
        motion=tmp_path / "gait.csv",
        load=2000.0,
        modulus=gc.MPa(E),
        poisson=NU,
        region="ny>0.25",
        piece=gc.mm(1),
        free=("adduction",),
    )
    assert theirs.settled.converged.all() and ours.resting.converged.all()
    away = ours.resting.coordinates("femur") - theirs.settled.coordinates
    assert np.abs(away[:, :3]).max() < 1e-9 and np.abs(away[:, 3:]).max() < 1e-7
    np.testing.assert_allclose(ours.pressure["femur_insert"], theirs.pressure, rtol=1e-5)
    np.testing.assert_allclose(ours.area["femur_insert"], theirs.area, rtol=1e-12)
    np.testing.assert_allclose(-ours.loads["insert"][:, 1], theirs.force["total"], rtol=1e-5)
    np.testing.assert_allclose(-ours.loads["insert"][:, 1], 2000.0, rtol=1e-5)


def test_settled_poses_are_a_motion_whose_pressures_are_the_same(tmp_path: Path) -> None:
    file = knee(tmp_path)
    rest = settle(file)
    with unpictured():
        rest.write(tmp_path / "out")
    text = file.read_text("utf-8").replace((tmp_path / "gait.csv").as_posix(), "out/poses_femur.csv")
    with pytest.warns(InputWarning, match=r"\[\[free\]\] has no effect"):
        again = gc.area_pairs(described(tmp_path, text), rule="clip", workers=1)
    table = again.table("femur_insert/pressure")
    np.testing.assert_allclose(table["peak [MPa]"], rest.pressure["femur_insert"] * 1e-6, rtol=1e-4)
    np.testing.assert_allclose(table["force [N]"], rest.force["femur_insert"], rtol=1e-4)


RADII = {"cup": 24e-3, "head": 18e-3, "ball": 10e-3}
THICK = {"cup": 5e-3, "head": 6e-3}


def ball_on_sphere(layer: float, rigid: float, thickness: float, between: float) -> float:
    """Force of a rigid ball on a layer with the radius `layer`, hollow or full, middles `between` apart.

    A point at the angle a from the line of the middles is s = sqrt(R^2 + e^2 - 2 R e cos a) from the ball's middle, as
    deep as r - s; the force is the derivative of the energy of all points to e.
    """

    def of_ring(a: float) -> float:
        s = np.sqrt(layer**2 + between**2 - 2.0 * layer * between * np.cos(a))
        depth = rigid - s
        pull = (layer * np.cos(a) - between) / s
        return 2.0 * np.pi * layer**2 * np.sin(a) * M * max(depth, 0.0) / thickness * pull

    reach = (layer**2 + between**2 - rigid**2) / (2.0 * layer * between)
    return float(quad(of_ring, 0.0, np.arccos(np.clip(reach, -1.0, 1.0)))[0])


TURN, PLACE = Rotation.from_rotvec([0.4, -0.7, 1.1]), np.array([100.0, -30.0, 70.0])


def hip(folder: Path, head: float = -900.0, ball: float = -400.0) -> Path:
    """A cup that lies askew, a head in it and a ball on the head, apart at first; forces along the cup's y."""
    meshes = {
        "cup": solid(folder, "cup", cup(24.0, 5.0, 40)),
        "head": solid(folder, "head", sphere(18.0, 40)),
        "ball": solid(folder, "ball", sphere(10.0, 32)),
    }
    places = {"cup": 0.0, "head": -5.6, "ball": -5.6 + 18.0 + 10.3}
    text = 'unit = "mm"\n'
    for name, mesh in meshes.items():
        turn = TURN * Rotation.from_rotvec([0.0, 0.0, 0.3] if name == "head" else [0.0, 0.0, 0.0])
        turned(folder, f"{name}.csv", PLACE + TURN.apply([0.0, places[name], 0.0]), turn)
        text += f'[[bodies]]\nname = "{name}"\nmesh = "{mesh}"\nmotion = "{name}.csv"\n'
    for moving, fixed in (("head", "cup"), ("ball", "head")):
        thick = f'thickness = {{ value = {1e3 * THICK[fixed]:g}, unit = "mm" }}, piece = {{ value = 0.7, unit = "mm" }}'
        text += f'[[pairs]]\nmoving = "{moving}"\nfixed = "{fixed}"\nlayer = {{ {LAYER}, {thick} }}\n'
    for name, force in (("head", head), ("ball", ball)):
        text += f'[[free]]\nbody = "{name}"\naxes = "cup"\nsettles = ["ty"]\nfy = {{ value = {force:g}, unit = "N" }}\n'
    return described(folder, text)


@pytest.fixture(scope="module")
def resting(tmp_path_factory: pytest.TempPathFactory) -> SettlePairsResult:
    return settle(hip(tmp_path_factory.mktemp("hip")))


def sunk(fixed: str, moving: str, start: float, sign: float, load: float) -> float:
    """How far MOVING sinks from touching, by the closed form."""
    layer, rigid = RADII[fixed], RADII[moving]

    def excess(depth: float) -> float:
        return abs(ball_on_sphere(layer, rigid, THICK[fixed], start + sign * depth)) - load

    return float(brentq(excess, 1e-7, 1e-3))


def test_a_head_in_a_socket_with_a_ball_on_it_is_the_closed_form(resting: SettlePairsResult) -> None:
    """The socket bears both forces, the head that of the ball: how far each sinks, peaks, and who bears what."""
    assert resting.resting.converged.all()
    in_cup = sunk("cup", "head", RADII["cup"] - RADII["head"], 1.0, 1300.0)
    on_head = sunk("head", "ball", RADII["head"] + RADII["ball"], -1.0, 400.0)
    head, ball = resting.resting.coordinates("head")[:, 1], resting.resting.coordinates("ball")[:, 1]
    np.testing.assert_allclose(-head - (RADII["cup"] - RADII["head"]), in_cup, rtol=0.01)
    np.testing.assert_allclose(RADII["head"] + RADII["ball"] - (ball - head), on_head, rtol=0.01)
    off_pole = 0.5 * (0.7e-3 / np.sqrt(3.0)) ** 2  # squared; the middle of the nearest piece of 0.7 mm
    for pair, fixed, depth, curved in (
        ("head_cup", "cup", in_cup, 1.0 / RADII["head"] - 1.0 / RADII["cup"]),
        ("ball_head", "head", on_head, 1.0 / RADII["ball"] + 1.0 / RADII["head"]),
    ):
        deepest = resting.pressure[pair] * THICK[fixed] / M
        assert (deepest < 1.005 * depth).all() and (deepest > 0.995 * (depth - off_pole * curved)).all(), pair
    down = TURN.apply([0.0, -1.0, 0.0])
    for body, along in (("cup", 1300.0), ("head", -900.0), ("ball", -400.0)):
        np.testing.assert_allclose(resting.loads[body][:, :3] @ down, along, rtol=1e-4)
    np.testing.assert_allclose(sum(resting.loads.values()), 0.0, atol=1e-9)


def test_loads_of_pairs_are_about_the_origin_of_the_common_frame(resting: SettlePairsResult) -> None:
    """By hand from the file's own columns: the centre of pressure times the force, which has no moment about it."""
    table = resting.table("contacts")
    force = table[["fx [N]", "fy [N]", "fz [N]"]].to_numpy()
    centre = table[["cop_x [mm]", "cop_y [mm]", "cop_z [mm]"]].to_numpy() * 1e-3
    moment = table[["mx [N m]", "my [N m]", "mz [N m]"]].to_numpy()
    assert np.linalg.norm(moment, axis=1).min() > 20.0
    np.testing.assert_allclose(moment, np.cross(centre, force), atol=2e-3 * np.abs(moment).max())
    rows = table[table["on"] == "cup"][["fx [N]", "fy [N]", "fz [N]", "mx [N m]", "my [N m]", "mz [N m]"]]
    np.testing.assert_array_equal(rows.to_numpy(), resting.loads["cup"])


def test_the_page_shows_all_bodies_where_they_rest(resting: SettlePairsResult) -> None:
    page = resting.pages({})["report.html"].of(101)
    scene = next(one for one in page.sections if isinstance(one, Scene))
    assert [body.name for body in scene.bodies] == ["head", "cup", "ball"]
    assert [scene.bodies[one.body].name for one in scene.maps] == ["cup", "head"]
    assert [one.values.max() > 1.0 for one in scene.maps] == [True, True]
    table = next(one for one in page.sections if isinstance(one, Table))
    whole = [("all pairs", body) for body in ("cup", "head", "ball")]
    assert [row[:2] for row in table.rows] == [("head_cup", "cup"), ("ball_head", "head"), *whole]


def on_plate(folder: Path, free: str, last: tuple[int, int, int] = (0, 20, 0)) -> Path:
    """A ball over a plate in three frames; `last` is its place in the last one [mm]."""
    head = "time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz"
    rows = [head, *(f"{t}, 0, 20, 0, 1, 0, 0, 0" for t in (0, 1)), f"2, {', '.join(map(str, last))}, 1, 0, 0, 0"]
    written(folder / "ball.csv", "\n".join(rows) + "\n")
    text = f"""unit = "mm"
[[bodies]]
name = "ball"
mesh = "{SPHERE.as_posix()}"
motion = "ball.csv"
[[bodies]]
name = "plate"
mesh = "{PLATE.as_posix()}"
[[pairs]]
moving = "ball"
fixed = "plate"
layer = {{ {LAYER}, piece = {{ value = 2, unit = "mm" }} }}
{free}"""
    return described(folder, text)


DOWN = '[[free]]\nbody = "ball"\nsettles = ["ty"]\nfy = { value = -300, unit = "N" }\n'


def test_a_frame_without_rest_has_no_numbers(tmp_path: Path) -> None:
    """Far beside the plate the ball falls on: that frame is empty, and said."""
    result = settle(on_plate(tmp_path, DOWN, (500, 20, 0)))
    assert result.resting.converged.tolist() == [True, True, False]
    assert any("1 of 3 frames did not come to rest (at 2 s)" in line for line in result.warnings)
    assert any("at 2 s 300 N of 300 N on ball remained after " in line for line in result.warnings)
    for name in ("bodies", "contacts", "loads"):
        numbers = result.table(name).drop(columns=["pair", "on", "at_rest", "ball_residual [N]"], errors="ignore")
        assert numbers.iloc[1].notna().all() and numbers.iloc[2].drop("time [s]").isna().all(), name
    assert result.table("bodies")["ball_residual [N]"][2] == pytest.approx(300.0)
    assert len(result.table("poses_ball")) == 2


@pytest.mark.parametrize(
    ("free", "said"),
    [
        (DOWN.replace("-300", "300"), "no frame came to rest: no layer presses on ball wherever its force leads"),
        (DOWN + DOWN, "[[free]] 2 body: ball is free twice"),
        (DOWN.replace('"ball"', '"bowl"'), "[[free]] 1 body: no body is called bowl; there are ball, plate"),
        (DOWN + 'axes = "ball"\n', "[[free]] 1 axes: ball comes to rest itself"),
        (DOWN + 'axes = "floor"\n', "[[free]] 1 axes: no body is called floor"),
        (DOWN.replace("ty", "t"), "[[free]] 1 settles: 't' is no coordinate; there are tx, ty"),
        (DOWN.replace('"ty"', ""), "[[free]] 1 settles: is empty"),
        (DOWN.replace('"ty"', '"ty", "tx"'), "nothing holds ball tx: contacts and springs have no stiffness along it"),
        (DOWN.replace("fy", "# fy"), "[[free]]: no force acts on any of the bodies"),
        (
            DOWN + '[free.springs]\nrx = { value = 1, unit = "N m/deg" }\n',
            "rx: is held, and its spring has no effect; add rx to settles",
        ),
        (DOWN + 'fx = { value = 20, unit = "kN" }\n', "[[free]] 1 fx: has no effect: tx is held; add tx to settles"),
        ("", "[[free]]: no body is free"),
    ],
)
def test_what_cannot_come_to_rest_is_refused(tmp_path: Path, free: str, said: str) -> None:
    with pytest.raises(InputError) as refused:
        settle(on_plate(tmp_path, free))
    assert said in str(refused.value), refused.value
    assert "\n" not in str(refused.value)


def test_a_steep_body_that_only_sinks_comes_to_rest(tmp_path: Path) -> None:
    """A ball lies about the same at a right angle: no turn of it settles."""
    file = on_plate(tmp_path, DOWN)
    straight = settle(file).resting.coordinates("ball")
    steep = (
        (tmp_path / "ball.csv").read_text("utf-8").replace("1, 0, 0, 0", "0.7071067811865476, 0.7071067811865476, 0, 0")
    )
    written(tmp_path / "ball.csv", steep)
    result = settle(file)
    assert result.resting.converged.all()
    np.testing.assert_allclose(result.resting.coordinates("ball")[:, 1], straight[:, 1], atol=2e-5)


def test_a_start_pose_is_not_taken_for_a_copied_motion(tmp_path: Path) -> None:
    """A ball that is constant over a plate is where the search begins; a body without a motion has none to copy."""
    file = on_plate(tmp_path, DOWN)
    for what in (gc.settle_pairs, gc.area_pairs):
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always", InputWarning)
            what(file)
        assert not any("keep their place" in str(one.message) for one in found)
    for name in ("ball", "plate"):
        turned(tmp_path, f"{name}.csv", np.array([0.0, 20.0 * (name == "ball"), 0.0]), TURN)
    both = file.read_text("utf-8").replace(
        f'mesh = "{PLATE.as_posix()}"', f'mesh = "{PLATE.as_posix()}"\nmotion = "plate.csv"'
    )
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", InputWarning)
        gc.area_pairs(described(tmp_path, both))
    assert any("ball and plate keep their place" in str(one.message) for one in found)


def test_pairs_without_a_layer_bear_nothing_and_it_is_said(tmp_path: Path) -> None:
    file = on_plate(tmp_path, DOWN)
    more = '[[pairs]]\nname = "bare"\nmoving = "plate"\nfixed = "ball"\n'
    with pytest.warns(InputWarning, match="no layer in bare: nothing presses there"):
        result = gc.settle_pairs(described(tmp_path, file.read_text("utf-8") + more))
    assert set(result.force) == {"ball_plate"}
    without = "\n".join(line for line in file.read_text("utf-8").splitlines() if not line.startswith("layer"))
    with pytest.raises(InputError, match=r"\[\[free\]\] 1 body: ball is in no pair that has a layer"):
        settle(described(tmp_path, without))


def test_an_open_body_is_warned_of_by_what_is_written(tmp_path: Path) -> None:
    """No areas are written: an open plate bears what the closed one does, and only as MOVING has nothing to press."""
    thick = (
        on_plate(tmp_path, DOWN)
        .read_text("utf-8")
        .replace("piece =", 'thickness = { value = 8, unit = "mm" }, piece =')
    )
    file = described(tmp_path, thick)
    closed = settle(file)
    faces = corners(PLATE)
    far = np.delete(faces, np.argmin(faces[:, :, 1].mean(axis=1)), axis=0)
    text = file.read_text("utf-8").replace(PLATE.as_posix(), written(tmp_path / "open.stl", stl(far)).as_posix())
    bare = '[[pairs]]\nname = "bare"\nmoving = "plate"\nfixed = "ball"\n'
    for more, said in (("", []), (bare, ["it has no inside, so no force and pressure of it as MOVING"])):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = gc.settle_pairs(described(tmp_path, text + more))
        told = [str(one.message) for one in caught]
        assert not any("area_" in line for line in told), told
        assert [line.rpartition(": ")[2] for line in told if "open.stl is open" in line] == said
        np.testing.assert_allclose(result.force["ball_plate"], closed.force["ball_plate"], rtol=1e-9)


def test_a_light_body_beside_a_heavy_one_is_not_taken_for_at_rest(tmp_path: Path) -> None:
    """What is off is a share of what each body bears: 1 N hangs in the air beside 5 kN."""
    text = on_plate(tmp_path, DOWN.replace("-300", "-5000")).read_text("utf-8")
    written(tmp_path / "light.csv", (tmp_path / "ball.csv").read_text("utf-8").replace(", 0, 20,", ", 400, 20,"))
    light = f'[[bodies]]\nname = "light"\nmesh = "{SPHERE.as_posix()}"\nmotion = "light.csv"\n'
    pair = '[[pairs]]\nmoving = "light"\nfixed = "plate"\n' + next(
        line for line in text.splitlines() if "layer" in line
    )
    body = DOWN.replace('"ball"', '"light"').replace("-300", "-1")
    with pytest.raises(InputError, match="no layer presses on light wherever its force leads"):
        settle(described(tmp_path, f"{text}{light}{pair}\n{body}"))


def loaded(folder: Path, rows: dict[str, list[float]], settles: str = '"ty"', constant: str = "") -> Path:
    """A ball on a plate with forces from a table."""
    lines = [", ".join(rows), *(", ".join(map(str, row)) for row in zip(*rows.values(), strict=True))]
    written(folder / "forces.csv", "\n".join(lines) + "\n")
    free = f'[[free]]\nbody = "ball"\nsettles = [{settles}]\nforces = "forces.csv"\n{constant}'
    return on_plate(folder, free)


@pytest.mark.parametrize("column", ["fy", "ball_fy"])
def test_forces_over_time_are_those_of_single_runs(tmp_path: Path, column: str) -> None:
    """Of a table in kN at other times than the motion's: 200, 300 and 400 N at 0, 1 and 2 s."""
    table = {"time [s]": [-1.0, 3.0], f"{column} [kN]": [-0.1, -0.5]}
    result = settle(loaded(tmp_path, table))
    np.testing.assert_allclose(result.loads["plate"][:, 1], [-200.0, -300.0, -400.0], rtol=1e-4)
    single = settle(on_plate(tmp_path, DOWN))
    assert result.resting.coordinates("ball")[1, 1] == pytest.approx(single.resting.coordinates("ball")[1, 1], abs=1e-9)
    assert not any("all of the layer" in line for line in result.warnings)
    with unpictured():
        out = Path(result.write(tmp_path / "out"))
    assert "forces.csv" in (out / "run.json").read_text("utf-8")


@pytest.mark.parametrize(
    ("rows", "more", "said"),
    [
        ({"time [s]": [0, 1], "fy [N]": [-1, -1]}, {}, "runs from 0 to 1 s, the motion from 0 to 2 s"),
        ({"time [s]": [0, 2], "force [N]": [-1, -1]}, {}, "no column fx, fy, fz or ball_fx, ball_fy, ball_fz"),
        ({"time [s]": [0, 2], "fx [N]": [-1, -1]}, {}, "column 'fx' has no effect: tx of ball is held"),
        ({"time [s]": [0, 2], "fy [N]": [0, 0]}, {}, "no force acts on ball"),
        ({"time [s]": [0, 2], "fy": [-1, -1]}, {}, "column 'fy' has no unit; write it behind the name: fy [N]"),
        ({"time [s]": [0, 2], "fy [N]": [-1, -1], "ball_fy [N]": [-2, -2]}, {}, "columns fy and ball_fy, both of ball"),
        (
            {"time [s]": [0, 2], "fy [N]": [-1, -1]},
            {"constant": 'fy = { value = -3, unit = "N" }\n'},
            "[[free]] 1 fy: stands beside forces over time; keep one of them",
        ),
    ],
)
def test_forces_over_time_that_cannot_be_are_refused(
    tmp_path: Path, rows: dict[str, list[float]], more: dict[str, str], said: str
) -> None:
    with pytest.raises(InputError) as refused:
        settle(loaded(tmp_path, rows, **more))
    assert said in str(refused.value), refused.value


def test_forces_of_storage_files_are_in_newtons_and_other_columns_are_named(tmp_path: Path) -> None:
    """OpenSim's files have no units of columns; a column that is no force of this body is said to be unused."""
    file = loaded(tmp_path, {"time [s]": [0, 2], "fy [N]": [-1, -1]})
    head = "forces\nversion=1\nnRows=2\nnColumns=3\ninDegrees=no\nendheader\n"
    written(tmp_path / "forces.sto", f"{head}time\tball_fy\tfemur_fy\n0\t-200\t-9\n2\t-400\t-9\n")
    described(tmp_path, file.read_text("utf-8").replace("forces.csv", "forces.sto"))
    with pytest.warns(InputWarning) as said:
        result = gc.settle_pairs(file)
    np.testing.assert_allclose(result.loads["plate"][:, 1], [-200.0, -300.0, -400.0], rtol=1e-4)
    assert [1 for each in said if str(each.message).endswith("not used as forces on ball: femur_fy")]


def test_forces_balance_by_virtual_work(resting: SettlePairsResult) -> None:
    """By hand from the written table: contacts and applied forces on each ball along the cup's y, 1 N of 900 apart."""
    found = imbalance(resting.resting)
    table = resting.table("contacts").set_index("pair")
    up = TURN.apply([0.0, 1.0, 0.0])
    on_cup, on_head = (
        table.loc[[pair], ["fx [N]", "fy [N]", "fz [N]"]].to_numpy()[0] @ up for pair in ("head_cup", "ball_head")
    )
    left = max(abs(on_head - on_cup - 900.0) / abs(on_cup), abs(-on_head - 400.0) / abs(on_head))
    assert found[0] == pytest.approx(left, rel=1e-3, abs=1e-7)
    assert found.max() < 1e-3
    spoilt = resting.resting
    spoilt.wrenches["ball_head"][:, :3] *= 1.1
    try:
        spoilt.__dict__.pop("loads", None)
        assert imbalance(spoilt)[0] == pytest.approx(0.1, rel=0.02)
    finally:
        spoilt.wrenches["ball_head"][:, :3] /= 1.1


def test_a_body_that_bears_nothing_hides_no_imbalance(tmp_path: Path) -> None:
    """A ball on a spring, apart from the head: loads of the head doubled are 900 N of 1800 that it then bears."""
    apart = hip(tmp_path, ball=0.0).read_text("utf-8")
    spring = 'springs.ty = { value = 10, unit = "N/mm" }\n'
    free = (
        apart.replace('fy = { value = -0, unit = "N" }\n', "").replace('fy = { value = 0, unit = "N" }\n', "") + spring
    )
    file = described(tmp_path, free.replace('motion = "ball.csv"', 'motion = "away.csv"'))
    turned(tmp_path, "away.csv", PLACE + TURN.apply([0.0, 40.0, 0.0]), TURN)
    result = settle(file)
    assert (result.loads["ball"] == 0.0).all() and imbalance(result.resting).max() < 1e-3
    spoilt = result.resting
    spoilt.wrenches["head_cup"][:] *= 2.0
    np.testing.assert_allclose(imbalance(spoilt), 1.0, rtol=1e-3)
    assert [each for each in goodness_of(spoilt).doubts if "virtual work" in each.what and each.contradicts]


def test_a_ramp_from_no_force_at_all(tmp_path: Path) -> None:
    """0, 200 and 400 N at 0, 1 and 2 s: the first frame bears nothing, which is said; nothing is divided by it."""
    result = settle(loaded(tmp_path, {"time [s]": [0.0, 2.0], "fy [N]": [0.0, -400.0]}))
    np.testing.assert_allclose(result.loads["plate"][:, 1], [0.0, -200.0, -400.0], rtol=1e-4, atol=1e-9)
    found = imbalance(result.resting)
    assert found[0] == 0.0 and (found[1:] < 1e-3).all()
    spoilt = result.resting
    spoilt.wrenches["ball_plate"][:] *= 2.0
    np.testing.assert_allclose(imbalance(spoilt), [0.0, 1.0, 1.0], rtol=1e-3)
    with pytest.warns(InputWarning) as said:
        gc.settle_pairs(tmp_path / "pairs.toml")
    assert [1 for each in said if "no force acts at 0 s: bodies stay" in str(each.message)]


def test_a_layer_that_is_pressed_everywhere_is_doubted(tmp_path: Path) -> None:
    """A cap of the ball, 2 mm about its lowest point, that the plate covers: no frame of the whole ball is so."""
    text = on_plate(tmp_path, DOWN.replace("-300", "-5000")).read_text("utf-8")
    cap = 'moving = "plate"\nfixed = "ball"\nregion = "ny < -0.99"'
    whole = described(tmp_path, text)
    small = text.replace('moving = "ball"\nfixed = "plate"', cap)
    small = small.replace("piece = {", 'thickness = { value = 5, unit = "mm" }, piece = {')
    result = settle(written(tmp_path / "cap.toml", small))
    line = "plate_ball: all of the layer is under pressure, so that the contact ends with it, for 100% of the time"
    assert line in result.sentences[0] and not any("all of the layer" in each for each in settle(whole).sentences)


def test_the_command_writes_poses_loads_and_a_page(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with unpictured():
        said = done(call("settle-pairs", on_plate(tmp_path, DOWN), "--out", out, folder=out))
    assert "3 of 3 frames at rest: ball" in said.out and "ball_plate: force up to 300" in said.out
    for name in ("bodies.csv", "contacts.csv", "loads.csv", "poses_ball.csv", "run.json"):
        assert (out / name).is_file(), name
