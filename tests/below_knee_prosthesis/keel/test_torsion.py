"""A keel that twists, by hand: a bar of one section under a couple, the torque of the ground in a simulated stance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.both_sides.walk import coordinate_names, passive
from geocontact.below_knee_prosthesis.foot_numbers import foot_numbers
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.quasi_static import QuasiStaticKeel, loads_at
from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.simulate import simulate_stance
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.centre_of_pressure import centre_of_pressure
from geocontact.loads.ground import Stairs
from geocontact.loads.sphere_set import SoleLaw, SphereSet
from meshes.amputee import true_amputee
from meshes.gait_course import course
from meshes.gait_persons import PARTICIPANTS, true_leg

LENGTH, FULCRUM, GJ, SPRING, ASIDE = 0.229, 0.1, 30.0, 40e3, 0.025
"""m, m, N m², N/m of each of two springs under the tip, m to each side."""


def twisting() -> VariableStiffnessFoot:
    foot = vsf_foot()
    return replace(foot, keel=replace(foot.keel, twists=True))


def on_two_springs(*, twists: bool = True) -> QuasiStaticKeel:
    """A keel that does not bend, on two springs under its tip."""
    keel = replace(vsf_foot().keel, bending=1e8, torsional=GJ, twists=twists)
    tips = SphereSet(np.array([[LENGTH, 0.0, side * ASIDE] for side in (-1.0, 1.0)]), np.full(2, 1e-9), ("tip", "tip"))
    law = SoleLaw(np.full(2, SPRING), np.zeros(2), 1.0, 1e-3, np.zeros(2), np.zeros(2), 0.01)
    return QuasiStaticKeel(keel, FULCRUM, KeelSole(tips, (keel.joints,) * 2), law)


@pytest.mark.parametrize("rolled", [-1.5, 1.0])
def test_a_bar_under_a_couple_twists_by_its_length_over_gj(rolled: float) -> None:
    """Rolled by phi, springs turn it back by T = 2 k b² (phi + theta), the bar by T = -GJ theta/(L - l)."""
    phi, deep = np.radians(rolled), 0.004
    pose = RigidTransform.from_components(np.array([[0.0, -deep, 0.0]]), Rotation.from_euler("x", [[phi]]))
    still = {"gravity": (0.0, 0.0, 0.0)}
    found = on_two_springs().solve(pose, HalfSpace(), **still)  # type: ignore[arg-type]
    springs, bar = 2.0 * SPRING * ASIDE**2, GJ / (LENGTH - FULCRUM)
    theta = -phi * springs / (springs + bar)
    assert found.angles[0, 0] == pytest.approx(theta, rel=2e-3)  # sines of two degrees
    torque = -bar * theta
    across = centre_of_pressure(found.loads, gate=1.0).centre[0, 2]
    assert across == pytest.approx(torque / (2.0 * SPRING * deep), rel=2e-3)
    stiff = on_two_springs(twists=False).solve(pose, HalfSpace(), **still)  # type: ignore[arg-type]
    rigid = centre_of_pressure(stiff.loads, gate=1.0).centre[0, 2]
    assert rigid == pytest.approx(ASIDE**2 * phi / deep, rel=2e-3)
    assert across / rigid == pytest.approx(bar / (springs + bar), rel=4e-3)


@pytest.mark.slow
def test_the_ground_twists_the_keel_of_a_simulated_stance() -> None:
    """On ground that falls to the right: torque of the spheres in front of the first joint about the keel's axis, by
    hand from forces and places, is what GJ/(L - l) and its damper take.
    """
    foot, tilt = twisting(), np.radians(3.0)
    ground = HalfSpace((0.0, 0.0, 0.0), (0.0, float(np.cos(tilt)), float(np.sin(tilt))))
    leg = true_leg(PARTICIPANTS[0], 0.03)
    one = course(leg, vsf_foot(), FULCRUM, 0.72)
    given = one.motion, foot, FULCRUM, one.push, (0.46, 0.53)
    s = simulate_stance(*given, ground=ground, tolerance=1e-4, machine_code=False)
    assert s.twist is not None
    front = np.array(foot.sole.segment) > 0
    arms = np.nan_to_num(s.loads.point[:, front] - s.poses.translation[:, None])
    axis = s.poses.rotation.apply([1.0, 0.0, 0.0])
    torque = np.einsum("tni,ti->t", np.cross(arms, s.loads.force[:, front]), axis)
    stiffness = foot.keel.torsional / (foot.keel.length - FULCRUM)
    wanted = stiffness * (s.twist + foot.keel.retardation * s.found.u[:, 8])
    later = s.time > 0.48  # it starts straight under load
    assert np.abs(torque[later]).max() > 2.0
    np.testing.assert_allclose(wanted[later], torque[later], atol=0.02 * np.abs(torque).max())
    plain = simulate_stance(*(given[0], vsf_foot(), *given[2:]), ground=ground, tolerance=1e-4, machine_code=False)
    assert plain.twist is None
    assert plain.found.q.shape[1] == s.found.q.shape[1] - 1
    moved = s.centre("ground")[later, 2] - plain.centre("ground")[later, 2]
    assert np.abs(moved).max() > 1e-3
    energy = 0.5 * stiffness * s.twist**2 + 0.5 * s.keel_angles**2 @ foot.keel.stiffness(FULCRUM)
    np.testing.assert_allclose(s.stored, energy, rtol=1e-12)


def test_stairs_load_a_twisted_keel_as_a_floor_does() -> None:
    """One chain of rigid feet beside the kernel's, with rates of every joint."""
    foot, rng = twisting(), np.random.default_rng(3)
    angles, speeds = rng.normal(0.0, 0.015, (2, 4, foot.keel.hinges))
    speeds *= 10.0
    places = np.column_stack([np.zeros(4), np.full(4, 0.026), np.zeros(4)])
    poses = RigidTransform.from_components(places, Rotation.from_euler("xz", rng.normal(0.0, 0.03, (4, 2))))
    rate = np.zeros((4, 4, 4))
    rate[:, :3, 3] = rng.normal(0.0, 0.2, (4, 3))
    keel = foot.at(FULCRUM)
    level = loads_at(keel, angles, speeds, poses, rate, HalfSpace())
    far = loads_at(keel, angles, speeds, poses, rate, Stairs((5.0,), (0.0, 0.3)))
    assert level.pressing.max() > 50.0
    np.testing.assert_allclose(far.force, level.force, rtol=1e-9, atol=1e-9)


def test_numbers_of_a_keel_that_twists_are_stated() -> None:
    plain, found = foot_numbers(vsf_foot(), FULCRUM), foot_numbers(twisting(), FULCRUM)
    assert set(found) - set(plain) == {"keel torsional", "keel torsion"}
    bar = found["keel torsional"].value / (LENGTH - FULCRUM)
    assert found["keel torsion"].value == pytest.approx(bar, rel=1e-12)


def test_torsion_of_both_legs_has_its_spring() -> None:
    """Every coordinate of socket and keel in the model of `prosthesis walk`."""
    person = true_amputee(PARTICIPANTS[0], twisting(), FULCRUM)
    names = passive(coordinate_names(person))
    assert "keel_torsion_r" in names
    assert set(names) == {f"{name}_r" for name in person.springs()}
    assert person.springs()["keel_torsion"][0] == pytest.approx(person.foot.keel.torsional / (LENGTH - FULCRUM))
