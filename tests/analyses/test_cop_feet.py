"""Feet of a synthetic OpenSim model: forces and chain against formulas written out by hand, and against OpenSim."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.data.errors import InputError, InputWarning
from tests import opensim_oracle
from tests.elsewhere import Elsewhere

RADIUS, HEEL, TOE = 0.03, np.array([-0.02, -0.03, 0.01]), np.array([0.05, -0.02, -0.01])
"""Of both spheres of each side; centres in the foot and in the toes [m]."""
ANKLE, MTP = np.array([0.0, -0.4, 0.0]), np.array([0.15, -0.02, 0.0])
"""Joints in the shank and in the foot [m]."""
SIDE = {"r": 0.1, "l": -0.1}
"""z of each ankle [m]."""
SMOOTH = (2e6, 1.4, 0.8, 0.6, 0.3, 0.15)
"""Modulus, dissipation, static, dynamic, viscous friction, transition velocity."""
SPHERE, FLOOR = (3e6, 0.9, 0.8, 0.7, 0.2), (5e7, 0.3, 0.5, 0.4, 0.4)
"""Modulus, dissipation, static, dynamic, viscous friction of each surface."""
NAMES = ("stiffness", "dissipation", "static_friction", "dynamic_friction", "viscous_friction", "transition_velocity")
BALLS = [f"{ball}_{side}" for side in SIDE for ball in ("heel", "toe")]


def _numbers(values) -> str:
    return "".join(f"<{name}>{value}</{name}>" for name, value in zip(NAMES, values, strict=False))


def _sets(balls: str, values) -> str:
    return f"""<HuntCrossleyForce::ContactParameters><geometry>{balls}</geometry>{_numbers(values)}
</HuntCrossleyForce::ContactParameters>"""


FORCES = {
    "smooth": "".join(
        f"""<SmoothSphereHalfSpaceForce name="on_{ball}"><socket_sphere>/contactgeometryset/{ball}</socket_sphere>
<socket_half_space>/contactgeometryset/floor</socket_half_space>{_numbers(SMOOTH)}</SmoothSphereHalfSpaceForce>"""
        for ball in BALLS
    ),
    "hunt": "".join(
        f"""<HuntCrossleyForce name="on_{ball}"><HuntCrossleyForce::ContactParametersSet><objects>
{_sets(ball, SPHERE)}{_sets("floor", FLOOR)}</objects></HuntCrossleyForce::ContactParametersSet>
<transition_velocity>0.15</transition_velocity></HuntCrossleyForce>"""
        for ball in BALLS
    ),
}


def _body(name: str) -> str:
    return (
        f"""<Body name="{name}"><mass>2</mass><mass_center>0 0 0</mass_center><inertia>1 1 1 0 0 0</inertia></Body>"""
    )


def _pin(name: str, parent: str, child: str, place: np.ndarray) -> str:
    return f"""<PinJoint name="{name}"><socket_parent_frame>at</socket_parent_frame>
<socket_child_frame>/bodyset/{child}</socket_child_frame><coordinates><Coordinate name="{name}"/></coordinates>
<frames><PhysicalOffsetFrame name="at"><socket_parent>/bodyset/{parent}</socket_parent>
<translation>{" ".join(map(str, place))}</translation></PhysicalOffsetFrame></frames></PinJoint>"""


def _ball(name: str, body: str, centre: np.ndarray) -> str:
    return f"""<ContactSphere name="{name}"><socket_frame>/bodyset/{body}</socket_frame><radius>{RADIUS}</radius>
<location>{" ".join(map(str, centre))}</location></ContactSphere>"""


def model(folder: Path, kind: str, tilt: float = 0.0, height: float = 0.0) -> Path:
    """A shank in a plane with two feet and toes; the floor's normal leans by `tilt` from y towards -x."""
    chain, bodies, balls = "", _body("shank"), ""
    for side, z in SIDE.items():
        bodies += _body(f"foot_{side}") + _body(f"toes_{side}")
        chain += _pin(f"ankle_{side}", "shank", f"foot_{side}", ANKLE + np.array([0.0, 0.0, z]))
        chain += _pin(f"mtp_{side}", f"foot_{side}", f"toes_{side}", MTP)
        balls += _ball(f"heel_{side}", f"foot_{side}", HEEL) + _ball(f"toe_{side}", f"toes_{side}", TOE)
    text = f"""<?xml version="1.0"?><OpenSimDocument Version="40000"><Model name="synthetic_feet">
<gravity>0 0 0</gravity><Ground name="ground"/><BodySet><objects>{bodies}</objects></BodySet><JointSet><objects>
<PlanarJoint name="base"><socket_parent_frame>/ground</socket_parent_frame>
<socket_child_frame>/bodyset/shank</socket_child_frame><coordinates><Coordinate name="rz"/><Coordinate name="tx"/>
<Coordinate name="ty"/></coordinates></PlanarJoint>{chain}</objects></JointSet><ContactGeometrySet><objects>{balls}
<ContactHalfSpace name="floor"><socket_frame>/ground</socket_frame><location>0 {height} 0</location>
<orientation>0 0 {tilt - np.pi / 2}</orientation></ContactHalfSpace></objects></ContactGeometrySet>
<ForceSet><objects>{FORCES.get(kind, "")}</objects></ForceSet></Model></OpenSimDocument>"""
    (folder / "feet.osim").write_text(text)
    return folder / "feet.osim"


TIME = np.array([0.0, 0.01, 0.02])
LEAN, LIFT, BEND = 0.1, {"r": -0.15, "l": 0.05}, {"r": 0.2, "l": -0.1}
"""Of the shank, each ankle and toe joint [rad]."""
START, SPEED = np.array([0.3, 0.445]), np.array([0.4, -0.2])
"""Of the shank's origin [m, m/s]: a straight way, so that the spline's velocity is exact."""


def coordinates(folder: Path) -> Path:
    names = ["rz", "tx", "ty", *(f"{joint}_{side}" for side in SIDE for joint in ("ankle", "mtp"))]
    still = [angle[side] for side in SIDE for angle in (LIFT, BEND)]
    rows = "\n".join("\t".join(f"{v:.15g}" for v in (t, LEAN, *(START + t * SPEED), *still)) for t in TIME)
    head = f"synthetic\nversion=1\nnRows=3\nnColumns={len(names) + 1}\ninDegrees=no\nendheader\n"
    (folder / "ik.mot").write_text(head + "\t".join(["time", *names]) + "\n" + rows + "\n")
    return folder / "ik.mot"


def _turn(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])


def centre_by_hand(side: str, ball: str) -> np.ndarray:
    """Centre of a sphere at all times, (t, 3), through the joints."""
    local = HEEL if ball == "heel" else MTP + _turn(BEND[side]) @ TOE
    in_shank = ANKLE + [0.0, 0.0, SIDE[side]] + _turn(LIFT[side]) @ local
    way = np.column_stack([START + np.outer(TIME, SPEED), np.zeros(3)])
    return way + _turn(LEAN) @ in_shank


def force_by_hand(kind: str, depth: float, velocity: np.ndarray, up: np.ndarray) -> tuple[float, np.ndarray, float]:
    """Normal force [N], force on the foot [N], and how far below the ground it acts, of a sphere."""
    rate = -velocity @ up
    sliding = velocity - (velocity @ up) * up
    if kind == "smooth":
        modulus, c, static, dynamic, viscous, transition = SMOOTH
        share, constant = 0.5, 1e-5
        hertz = 4 / 3 * (0.5 * modulus ** (2 / 3)) ** 1.5 * RADIUS**0.5 * (depth**2 + 1e-5) ** 0.75
        normal = hertz * (0.5 + 0.5 * np.tanh(300 * depth)) * (1 + 1.5 * c * rate)
        normal *= 0.5 + 0.5 * np.tanh(50 * (rate + 2 / (3 * c)))
    else:
        mine, theirs = SPHERE[0] ** (2 / 3), FLOOR[0] ** (2 / 3)
        share, constant, transition = theirs / (mine + theirs), 0.0, 0.15
        c = share * SPHERE[1] + (1 - share) * FLOOR[1]
        static, dynamic, viscous = (2 * a * b / (a + b) for a, b in zip(SPHERE[2:], FLOOR[2:], strict=True))
        modulus = (mine * theirs / (mine + theirs)) ** 1.5
        normal = 4 / 3 * modulus * RADIUS**0.5 * max(depth, 0.0) ** 1.5 * (1 + 1.5 * c * rate)
    speed = (sliding @ sliding + constant) ** 0.5
    u = speed / transition
    friction = min(u, 1.0) * (dynamic + 2 * (static - dynamic) / (1 + u * u)) + viscous * speed
    return normal, normal * (up - friction * sliding / speed), (1 - share) * depth


def feet_by_hand(kind: str, tilt: float = 0.0, height: float = 0.0) -> dict[str, dict[str, np.ndarray]]:
    """Force, normal force, centre [m] and free moment of each foot at all times."""
    up, velocity = np.array([-np.sin(tilt), np.cos(tilt), 0.0]), np.array([*SPEED, 0.0])
    found = {}
    for side in SIDE:
        rows = []
        for k in range(len(TIME)):
            each = []
            for ball in ("heel", "toe"):
                centre = centre_by_hand(side, ball)[k]
                above = (centre - [0.0, height, 0.0]) @ up
                normal, force, below = force_by_hand(kind, RADIUS - above, velocity, up)
                each.append((normal, force, centre - (above + below) * up))
            total, push = sum(f for _, f, _ in each), sum(n for n, _, _ in each)
            where = sum(n * p for n, _, p in each) / push
            turning = sum(np.cross(p - where, f) for _, f, p in each) @ up
            rows.append((total, push, where, turning))
        found[side] = dict(zip(("force", "normal", "cop", "free"), map(np.array, zip(*rows, strict=True)), strict=True))
    return found


FEET = "foot_r+toes_r,foot_l+toes_l"


def _columns(table: pd.DataFrame, name: str, unit: str) -> np.ndarray:
    return table[[f"{name}_{axis} [{unit}]" for axis in "xyz"]].to_numpy()


@pytest.mark.parametrize("kind", ["smooth", "hunt"])
@pytest.mark.parametrize(("tilt", "height"), [(0.0, 0.0), (0.06, -0.01)])
@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_feet_and_their_sum_are_those_by_hand(tmp_path: Path, kind: str, tilt: float, height: float) -> None:
    """Chain, floor and law written out above; the spheres are 0 to 20 mm deep, and one of the smooth ones is above."""
    file = model(tmp_path, kind, tilt, height)
    result = gc.centre_of_pressure(file, motion=coordinates(tmp_path), body=FEET, gate=1.0)
    wanted, table = feet_by_hand(kind, tilt, height), result.tables()["feet"]
    for side, hand in wanted.items():
        name = f"foot_{side}"
        np.testing.assert_allclose(_columns(table, f"{name} force", "N"), hand["force"], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(table[f"{name} normal [N]"], hand["normal"], rtol=1e-9)
        np.testing.assert_allclose(_columns(table, f"{name} cop", "mm"), 1e3 * hand["cop"], rtol=0, atol=1e-9)
        np.testing.assert_allclose(table[f"{name} free_moment [N m]"], hand["free"], rtol=0, atol=1e-9)
        assert hand["normal"].min() > 10.0
    total = sum(hand["force"] for hand in wanted.values())
    np.testing.assert_allclose(result.force, total, rtol=1e-9, atol=1e-9)
    push = sum(hand["normal"] for hand in wanted.values())
    where = sum(hand["normal"][:, None] * hand["cop"] for hand in wanted.values()) / push[:, None]
    np.testing.assert_allclose(result.centre_of_pressure, where, rtol=0, atol=1e-12)


@pytest.mark.oracle
@pytest.mark.parametrize("kind", ["smooth", "hunt"])
@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_forces_are_those_of_opensim(tmp_path: Path, opensim: Elsewhere, kind: str) -> None:
    """Generalised forces of the shank's x and y: OpenSim's accelerations through masses that hold the same bodies.

    Two models with the same coordinates and speeds, one without contact: the difference of M a is the contact's.
    """
    file = model(tmp_path, kind)
    result = gc.centre_of_pressure(file, motion=coordinates(tmp_path), body=FEET, gate=1.0)
    names = ("rz", "tx", "ty", "ankle_r", "mtp_r", "ankle_l", "mtp_l")
    q = np.array([[LEAN, *START, LIFT["r"], BEND["r"], LIFT["l"], BEND["l"]]])
    u = np.array([[0.0, *SPEED, 0.0, 0.0, 0.0, 0.0]])
    theirs = opensim(opensim_oracle.accelerations, file, names, q, u)[0]
    # total force = sum of the masses' accelerations; origins of the bodies at rest against each other
    places = {"shank": np.zeros(3)}
    rates = {"shank": theirs[0]}
    own = {"shank": np.array([theirs[1], theirs[2], 0.0])}
    for side, (a, b) in {"r": (3, 4), "l": (5, 6)}.items():
        ankle = _turn(LEAN) @ ANKLE
        places[f"foot_{side}"], rates[f"foot_{side}"] = ankle, theirs[0] + theirs[a]
        toe = ankle + _turn(LEAN + LIFT[side]) @ MTP
        places[f"toes_{side}"], rates[f"toes_{side}"] = toe, theirs[0] + theirs[a] + theirs[b]
        own[f"foot_{side}"] = own["shank"] + np.cross([0.0, 0.0, rates["shank"]], ankle)
        own[f"toes_{side}"] = own[f"foot_{side}"] + np.cross([0.0, 0.0, rates[f"foot_{side}"]], toe - ankle)
    total = 2.0 * sum(own.values())
    np.testing.assert_allclose(result.force[0, :2], total[:2], rtol=1e-7)


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_one_body_of_the_model_is_one_foot(tmp_path: Path) -> None:
    file = model(tmp_path, "hunt")
    result = gc.centre_of_pressure(file, motion=coordinates(tmp_path), body="foot_r", gate=1.0)
    assert "feet" not in result.tables() and list(result.zones) == ["heel_r"]
    depth = RADIUS - centre_by_hand("r", "heel")[:, 1]
    np.testing.assert_allclose(result.loads.depth[:, 0], depth, atol=1e-12)


def test_a_number_of_the_other_law_takes_that_law(tmp_path: Path) -> None:
    """Stiffness and exponent of the model, damping and friction as asked for; a warning says so."""
    file = model(tmp_path, "hunt")
    with pytest.warns(InputWarning, match="dissipation and friction"):
        result = gc.centre_of_pressure(
            file, motion=coordinates(tmp_path), body="foot_r+toes_r", damping=0.0, friction=(0.0, 0.0), gate=1.0
        )
    depth = RADIUS - np.column_stack([centre_by_hand("r", ball)[:, 1] for ball in ("heel", "toe")])
    mine, theirs = SPHERE[0] ** (2 / 3), FLOOR[0] ** (2 / 3)
    k = 4 / 3 * (mine * theirs / (mine + theirs)) ** 1.5 * RADIUS**0.5
    np.testing.assert_allclose(result.force[:, 1], (k * np.maximum(depth, 0.0) ** 1.5).sum(axis=1), rtol=1e-9)


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_what_was_taken_is_recorded(tmp_path: Path) -> None:
    file, out = model(tmp_path, "smooth"), tmp_path / "out"
    gc.centre_of_pressure(file, motion=coordinates(tmp_path), body=FEET).write(out)
    law = json.loads((out / "run.json").read_text())["results"]["cop"]["law"]
    assert law["smooth"] is True and law["dissipation_s_per_m"] == 1.4 and law["transition_m_per_s"] == 0.15
    assert law["modulus_Pa"] == pytest.approx(2e6 / 2**1.5)
    page = (out / "report.html").read_text()
    assert "Normal force of each foot" in page and "Paths on the ground" in page


@pytest.mark.parametrize(("mass", "doubted"), [(2.0, True), (100.0, False)])
@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_feet_that_bear_more_than_the_model_weighs_are_doubted(tmp_path: Path, mass: float, doubted: bool) -> None:
    """Five bodies of one mass [kg]; the spheres bear 5 538 N."""
    file = model(tmp_path, "hunt")
    text = file.read_text().replace("<gravity>0 0 0", "<gravity>0 -9.80665 0")
    file.write_text(text.replace("<mass>2<", f"<mass>{mass}<"))
    result = gc.centre_of_pressure(file, motion=coordinates(tmp_path), body=FEET, gate=1.0)
    result.write(tmp_path / "out")
    kept = json.loads((tmp_path / "out" / "run.json").read_text())["warnings"]
    bearing = sum(hand["normal"].mean() for hand in feet_by_hand("hunt").values())
    assert bool(bearing > 1.5 * 5 * mass * 9.80665) == doubted
    assert any("times the weight of feet.osim" in line for line in kept) == doubted


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"body": "foot_r,foot_r"}, "foot_r is there twice"),
        ({"body": FEET, "toe": "x"}, "is of one foot, `body` names 2"),
        ({"body": FEET, "stances": True}, "is of one foot, `body` names 2"),
        ({"body": "foot_r,shank"}, "no contact sphere on shank"),
        ({"body": FEET, "order": "XYZ"}, "has no effect here"),
    ],
)
def test_refused(tmp_path: Path, asked: dict, said: str) -> None:
    with pytest.raises(InputError, match=said):
        gc.centre_of_pressure(model(tmp_path, "hunt"), motion=coordinates(tmp_path), **asked)


def test_poses_of_one_body_are_none_of_two(tmp_path: Path) -> None:
    (tmp_path / "still.csv").write_text("time [s],tx [m],ty [m],tz [m],qw,qx,qy,qz\n0,0,0.05,0,1,0,0,0\n")
    with pytest.raises(InputError, match="has the poses of one body, `body` names 2"):
        gc.centre_of_pressure(model(tmp_path, "hunt"), motion=tmp_path / "still.csv", body="foot_r+toes_r")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("<dissipation>1.4", "<dissipation>-1", "-1 is negative"),
        ("<stiffness>2000000.0", "<stiffness>0", "0 is not above 0"),
        ("/ground</socket_frame>", "/bodyset/shank</socket_frame>", "do not name one half-space"),
        ("sphere>/contactgeometryset/toe_r", "sphere>/contactgeometryset/heel_r", "has a force already"),
    ],
)
def test_forces_that_cannot_be(tmp_path: Path, old: str, new: str, said: str) -> None:
    file = model(tmp_path, "smooth")
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))
    with pytest.raises(InputError, match=said):
        gc.centre_of_pressure(file, motion=coordinates(tmp_path), body=FEET)
