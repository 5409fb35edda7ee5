"""Passive forces of a model in inverse dynamics: those of OpenSim, and their power is that of their springs."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from casadi import Function

from geocontact.data.errors import InputError
from geocontact.data.multibody.model import FrameBushing, PassiveForces
from geocontact.dynamics.inverse_dynamics import generalised_forces, passive_loads
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.io.opensim.osim_forces import read_passive_forces
from geocontact.io.opensim.osim_multibody import read_multibody
from meshes.leg_files import leg_model
from tests import opensim_oracle
from tests.elsewhere import Elsewhere

FORCES = """<ForceSet><objects>
<CoordinateLimitForce name="knee_stop"><coordinate>knee</coordinate><upper_stiffness>20</upper_stiffness>
<upper_limit>10</upper_limit><lower_stiffness>5</lower_stiffness><lower_limit>-40</lower_limit><damping>0.3</damping>
<transition>8</transition></CoordinateLimitForce>
<CoordinateLimitForce name="floor"><coordinate>ty</coordinate><upper_stiffness>900</upper_stiffness>
<upper_limit>0.1</upper_limit><lower_stiffness>500</lower_stiffness><lower_limit>-0.1</lower_limit><damping>7</damping>
<transition>0.05</transition></CoordinateLimitForce>
<SpringGeneralizedForce name="ankle_spring"><coordinate>ankle</coordinate><stiffness>30</stiffness>
<rest_length>0.2</rest_length><viscosity>0.7</viscosity></SpringGeneralizedForce>
<SpringGeneralizedForce name="off"><appliesForce>false</appliesForce><coordinate>ankle</coordinate>
<stiffness>1e3</stiffness></SpringGeneralizedForce>
<BushingForce name="brace"><socket_frame1>brace_in</socket_frame1><socket_frame2>brace_out</socket_frame2><frames>
<PhysicalOffsetFrame name="brace_in"><socket_parent>/bodyset/pelvis</socket_parent>
<translation>0.02 -0.3 0.1</translation><orientation>0.2 -0.1 0.3</orientation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="brace_out"><socket_parent>/bodyset/tibia_r</socket_parent>
<translation>0 -0.1 0.05</translation><orientation>0.1 0 -0.2</orientation></PhysicalOffsetFrame></frames>
<rotational_stiffness>10 20 30</rotational_stiffness><translational_stiffness>100 200 300</translational_stiffness>
<rotational_damping>1 2 3</rotational_damping><translational_damping>10 20 30</translational_damping></BushingForce>
</objects><groups><ObjectGroup name="stops"><members>knee_stop floor</members></ObjectGroup></groups></ForceSet>"""


def planar_leg(folder: Path, forces: str = FORCES) -> Path:
    """The shipped leg on a planar joint and a gimbal, so that its speeds are rates of coordinates in OpenSim too."""
    text = leg_model().replace("FreeJoint", "PlanarJoint").replace("BallJoint", "GimbalJoint")
    text = re.sub(r'<Coordinate name="(list|turn|tz)"/>', "", text).replace("<JointSet>", f"{forces}<JointSet>")
    (folder / "leg.osim").write_text(text, encoding="utf-8")
    return folder / "leg.osim"


def states(tree: Tree) -> list[np.ndarray]:
    """Beyond limits on either side, fast: (s, n) each."""
    return list(np.random.default_rng(5).normal(0.0, 0.6, (3, 12, len(tree.names))))


def loads_of(tree: Tree, forces: PassiveForces) -> Function:
    """What they do along the coordinates, and what motion then needs beside them."""
    along, on = passive_loads(tree, forces.acting)
    needed = generalised_forces(tree, on) - along
    return Function("loads", [tree.q, tree.u, tree.a], [generalised_forces(tree) - needed, needed])


def test_inverse_dynamics_with_passive_forces_is_that_of_opensim(tmp_path: Path, opensim: Elsewhere) -> None:
    file = planar_leg(tmp_path)
    tree = tree_of(read_multibody(file))
    q, u, a = states(tree)
    _, needed = loads_of(tree, read_passive_forces(file, tree.model)).map(len(q))(q.T, u.T, a.T)
    theirs = opensim(opensim_oracle.inverse_dynamics, file, tree.names, q, u, a, True)
    np.testing.assert_allclose(np.array(needed).T, theirs, atol=1e-9 * np.abs(theirs).max())


def test_power_of_springs_is_what_their_energy_loses(tmp_path: Path) -> None:
    """Without dashpots; the energy of a bushing is that of its six springs, by its own formula."""
    file = planar_leg(tmp_path, re.sub(r"<(\w*damping|viscosity)>[^<]*</\1>", "<damping>0</damping>", FORCES))
    model = read_multibody(file)
    found = read_passive_forces(file, model, ["stops", "ankle_spring"])
    assert found.excluded == ("knee_stop", "floor", "ankle_spring")
    (brace,) = found.acting
    assert isinstance(brace, FrameBushing)
    tree = tree_of(model)
    q, u, a = (each[:1] for each in states(tree))

    def energy(values: np.ndarray) -> float:
        poses = model.poses(values)
        first, second = (poses[body] * frame for body, frame in zip(brace.bodies, brace.frames, strict=True))
        apart = first.inv() * second
        bent = np.concatenate([apart.rotation.as_euler("XYZ")[0], apart.translation[0]])
        return float(0.5 * brace.stiffness @ bent**2)

    step = 1e-6
    lost = -(energy(q + step * u) - energy(q - step * u)) / (2.0 * step)
    along, _ = loads_of(tree, found)(q[0], u[0], a[0])
    assert float(u[0] @ np.array(along)[:, 0]) == pytest.approx(lost, rel=1e-7)


def test_a_force_that_is_not_there_cannot_be_excluded(tmp_path: Path) -> None:
    file = planar_leg(tmp_path)
    model = read_multibody(file)
    with pytest.raises(InputError, match=r"neither a force nor a group.*knee_stop.*stops"):
        read_passive_forces(file, model, ["knees"])
    assert read_passive_forces(file, model, ["ALL"]).acting == ()
    assert len(read_passive_forces(file, model, ["Muscles"]).acting) == 4
