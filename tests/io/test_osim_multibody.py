"""Whole OpenSim models as trees of bodies, both dialects; what is no tree is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError, InputWarning
from geocontact.dynamics.scaling import scaled
from geocontact.io.opensim.osim_multibody import read_multibody
from meshes.leg_files import leg_model
from tests import opensim_oracle
from tests.elsewhere import Elsewhere
from tests.io.test_osim import MODELS, written

MARKERS = """<MarkerSet><objects>
<Marker name="m1"><socket_parent_frame>/bodyset/c</socket_parent_frame><location>0.1 0.2 0.3</location></Marker>
<Marker name="m2"><socket_parent_frame>/bodyset/c/c_fixed</socket_parent_frame><location>0.1 0 0</location></Marker>
<Marker name="m3"><socket_parent_frame>/ground</socket_parent_frame><location>0 0 1</location></Marker>
</objects></MarkerSet>"""
PIN = MODELS["4 PinJoint"].replace("<Ground", f"<gravity>0 0 -9.8</gravity>{MARKERS}<Ground", 1)
OLD_MARKERS = """<MarkerSet><objects><Marker name="m"><body>c</body><location>1 2 3</location></Marker></objects>
</MarkerSet>"""
OLD = MODELS["3 PinJoint false"].replace("<BodySet>", f"{OLD_MARKERS}<BodySet>", 1)
HELD = """<ConstraintSet><objects><WeldConstraint name="k">{}</WeldConstraint></objects>
</ConstraintSet>"""


def test_bodies_joints_and_gravity(tmp_path: Path) -> None:
    model = read_multibody(written(tmp_path, PIN.replace("1 1 1 0 0 0", "1 2 3 0.1 0.2 0.3", 1)))
    assert [b.name for b in model.bodies] == ["p", "c"]
    assert [j.name for j in model.joints] == ["w", "j"]
    assert [c.name for c in model.coordinates] == ["a"]
    np.testing.assert_array_equal(model.gravity, [0.0, 0.0, -9.8])
    np.testing.assert_array_equal(model.bodies[0].inertia, [[1, 0.1, 0.2], [0.1, 2, 0.3], [0.2, 0.3, 3]])
    assert model.bodies[0].mass == 1.0


def test_the_older_dialect(tmp_path: Path) -> None:
    old = read_multibody(written(tmp_path, OLD))
    assert [b.name for b in old.bodies] == ["p", "c"]
    np.testing.assert_array_equal(old.bodies[1].inertia, np.eye(3))
    assert (old.markers[0].name, old.markers[0].body) == ("m", "c")
    np.testing.assert_array_equal(old.markers[0].location, [1, 2, 3])
    np.testing.assert_array_equal(old.gravity, [0.0, -9.80665, 0.0])


def test_markers_are_given_in_their_body(tmp_path: Path) -> None:
    """m2 hangs on a frame that is turned by 0.1 about x and shifted by 0.02 along y."""
    one, two, three = read_multibody(written(tmp_path, PIN)).markers
    assert (one.body, two.body, three.body) == ("c", "c", "ground")
    np.testing.assert_allclose(one.location, [0.1, 0.2, 0.3])
    np.testing.assert_allclose(two.location, [0.1, 0.02, 0.0])


def test_joints_of_one_name_are_told_apart(tmp_path: Path) -> None:
    """As in the published gait9dof18musc, whose `back` is the trunk's joint and the head's; frames are alike, too."""
    text = leg_model()
    leg = read_multibody(written(tmp_path, text))
    same = read_multibody(written(tmp_path, text.replace("ankle_r", "knee_r")))
    assert [j.name for j in same.joints] == ["base", "hip_r", "knee_r", "knee_r_0"]
    for one, other in zip(leg.joints, same.joints, strict=True):
        assert (one.parent, one.child) == (other.parent, other.child)
        np.testing.assert_array_equal(one.parent_offset.as_matrix(), other.parent_offset.as_matrix())


def test_comments_that_xml_does_not_allow_are_skipped(tmp_path: Path) -> None:
    """OpenSim reads them; what is wrong after them is told with its line."""
    odd = PIN.replace("<Ground", "<!-- was -- before\n<!-- Ground. -->\n<Ground", 1)
    assert [b.name for b in read_multibody(written(tmp_path, odd)).bodies] == ["p", "c"]
    lines = odd.partition("</Model>")[0].count("\n") + 2
    with pytest.raises(InputError, match=f"mismatched tag: line {lines}"):
        read_multibody(written(tmp_path, odd.replace("</Model>", "\n</Modell>")))


def test_bodies_and_joints_of_the_model_itself_are_read(tmp_path: Path) -> None:
    """OpenSim 4 lets a model hold them in `<components>`, whose paths have no set; with and without the set."""
    whole = read_multibody(written(tmp_path, PIN))
    start, end = PIN.index('<Body name="c">'), PIN.index("</objects></BodySet>")
    body = PIN[start:end]
    joint = PIN[PIN.index('<PinJoint name="j">') : PIN.index("</PinJoint>") + len("</PinJoint>")]
    loose = PIN.replace(body, "").replace(joint, "").replace("/bodyset/c", "/c")
    own = (body + joint).replace("/bodyset/c", "/c")
    found = read_multibody(written(tmp_path, loose.replace("<Ground", f"<components>{own}</components><Ground")))
    assert [b.name for b in found.bodies] == [b.name for b in whole.bodies]
    q = np.array([[0.3], [1.1]])
    np.testing.assert_array_equal(found.marker_places(q), whole.marker_places(q))


def test_limits_locks_and_clamps(tmp_path: Path) -> None:
    text = PIN.replace(
        "<default_value>0.25</default_value>",
        "<default_value>0.25</default_value><range>-1 2</range><clamped>true</clamped><locked>true</locked>",
    )
    found = read_multibody(written(tmp_path, text)).coordinates[0]
    assert (found.limits, found.clamped, found.locked) == ((-1.0, 2.0), True, True)
    plain = read_multibody(written(tmp_path, PIN)).coordinates[0]
    assert (plain.limits, plain.clamped, plain.locked) == ((-np.inf, np.inf), False, False)


def test_a_coordinate_prescribed_to_a_number_is_locked_there(tmp_path: Path) -> None:
    """One that is prescribed over time is said and moves freely."""
    course = "<prescribed_function><Constant><value>0.3</value></Constant></prescribed_function>"
    held = f"<prescribed>true</prescribed>{course}"
    text = PIN.replace("<default_value>0.25</default_value>", f"<default_value>0.25</default_value>{held}")
    found = read_multibody(written(tmp_path, text)).coordinates[0]
    assert (found.default, found.locked) == (0.3, True)
    with pytest.warns(InputWarning, match="coordinate a is prescribed over time"):
        free = read_multibody(written(tmp_path, text.replace("Constant", "SimmSpline"))).coordinates[0]
    assert (free.default, free.locked) == (0.25, False)


def test_parents_come_before_children(tmp_path: Path) -> None:
    """The joint of the outer body stands first in the file."""
    text = PIN
    weld = text[text.index('<WeldJoint name="w">') : text.index("</WeldJoint>") + len("</WeldJoint>")]
    swapped = text.replace(weld, "").replace("</PinJoint>", f"</PinJoint>{weld}")
    assert [j.name for j in read_multibody(written(tmp_path, swapped)).joints] == ["w", "j"]


def test_constraints_are_said(tmp_path: Path) -> None:
    on = PIN.replace("<BodySet", HELD.format("") + "<BodySet", 1)
    with pytest.warns(InputWarning, match="constraints are ignored.*WeldConstraint k"):
        read_multibody(written(tmp_path, on))
    for flag in ("<isDisabled>true</isDisabled>", "<isEnforced>false</isEnforced>"):
        read_multibody(written(tmp_path, PIN.replace("<BodySet", HELD.format(flag) + "<BodySet", 1)))


BAD = {
    "a body without a joint": (
        PIN.replace('<Body name="p">', '<Body name="q"/><Body name="p">', 1),
        "body q: has no joint",
    ),
    "a joint on itself": (
        PIN.replace("p_offset</socket_parent_frame>", "c_offset</socket_parent_frame>"),
        "joint j: closes a loop",
    ),
    "a negative mass": (PIN.replace("<mass>1</mass>", "<mass>-1</mass>", 1), "-1 kg is negative"),
    "a marker on nothing": (OLD.replace("<body>c</body>", "<body>x</body>"), "marker m: is on 'x'"),
}


@pytest.mark.parametrize(("text", "message"), BAD.values(), ids=BAD.keys())
def test_what_is_no_tree_is_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError) as error:
        read_multibody(written(tmp_path, text))
    assert message in str(error.value)


def turned_round(text: str) -> str:
    """The leg with the knee's parent and child exchanged, as OpenSim 4 writes joints that OpenSim 3 calls reversed."""
    swapped = text.replace("socket_parent_frame>knee_r_in", "socket_parent_frame>KEPT")
    swapped = swapped.replace("socket_child_frame>knee_r_out", "socket_child_frame>knee_r_in")
    return swapped.replace("socket_parent_frame>KEPT", "socket_parent_frame>knee_r_out")


def test_a_joint_whose_child_is_nearer_to_the_ground(tmp_path: Path, opensim: Elsewhere) -> None:
    """It is turned round; poses and scaled models are those of OpenSim."""
    file = tmp_path / "leg.osim"
    file.write_text(turned_round(leg_model()))
    model = read_multibody(file)
    (knee,) = (joint for joint in model.joints if joint.name == "knee_r")
    assert (knee.parent, knee.child, knee.base, knee.reverse) == ("femur_r", "tibia_r", "tibia_r", True)
    q = np.random.default_rng(1).uniform(-0.5, 0.5, (5, len(model.coordinates)))
    names = tuple(c.name for c in model.coordinates)
    theirs = opensim(opensim_oracle.poses, file, names, q, [("tibia_r", "ground"), ("foot_r", "ground")])
    ours = model.poses(q)
    for k, body in enumerate(("tibia_r", "foot_r")):
        np.testing.assert_allclose(ours[body].translation, theirs[:, k, :3, 3], atol=1e-12)
    by = {"femur_r": 1.2 * np.ones(3), "tibia_r": 0.9 * np.ones(3)}
    opensim(opensim_oracle.scaled, file, tmp_path / "theirs.osim", {n: tuple(f) for n, f in by.items()}, 30.0)
    wanted, found = read_multibody(tmp_path / "theirs.osim").poses(q), scaled(model, by, 30.0).poses(q)
    np.testing.assert_allclose(found["foot_r"].translation, wanted["foot_r"].translation, atol=1e-9)
