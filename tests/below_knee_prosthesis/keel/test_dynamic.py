"""The keel with inertia, by the equations of a tree, beside the one without."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.dynamic import dynamic_keel
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.resultant import pose_rate

FULCRUM, LASTING = 0.117, 0.12


def forefoot_pressed(samples: int) -> tuple[np.ndarray, RigidTransform]:
    """A smooth roll over the forefoot that presses it with about 700 N and slides a little."""
    time = np.linspace(0.0, LASTING, samples)
    share = time / LASTING
    turn = Rotation.from_euler("z", np.radians(-15.0 - 5.0 * share)[:, None])
    height = 0.089 + 0.018 * share - 0.03 * np.sin(np.pi * share) ** 2
    return time, RigidTransform.from_components(np.stack([0.01 * share, height, 0.0 * share], axis=1), turn)


def test_inertia_hardly_matters_and_the_rest_is_the_step() -> None:
    foot = vsf_foot(joints=3)
    even = replace(foot, law=replace(foot.law, static=foot.law.kinetic))
    level, still = HalfSpace(), even.at(FULCRUM)
    time, poses = forefoot_pressed(25)

    def without(samples: int) -> KeelMotion:
        fine, along = forefoot_pressed(samples)
        return still.solve(along, level, rate=pose_rate(fine, along), time=fine)

    model = dynamic_keel(foot.keel, foot.sole, even.law, level, machine_code=False)
    moved = model.simulate(FULCRUM, time, poses, without(25).angles[0], tolerance=1e-5)
    fine, along = forefoot_pressed(241)
    truth = still.at(moved.q, moved.u, poses, level, pose_rate(fine, along)[::10]).force
    assert truth[:, 1].max() > 600.0
    error = [np.abs(without(n).force[:: (n - 1) // 24] - truth)[2:-2].max() for n in (25, 241)]
    assert error[1] < 0.004 * truth[:, 1].max(), error
    assert error[1] < 0.1 * error[0], error


def test_a_free_keel_swings_at_the_beams_frequency() -> None:
    """First bending frequency of the overhang on its root, by the characteristic equation, at 64 joints."""
    from scipy.optimize import brentq

    from geocontact.below_knee_prosthesis.keel.keel import root_compliance
    from geocontact.below_knee_prosthesis.keel.on_tree import joint_numbers

    keel = vsf_foot(joints=64).keel
    fulcrum = keel.posterior
    a, r = keel.length - fulcrum, root_compliance(fulcrum, keel.bending, keel.support) * keel.bending

    def characteristic(z: float) -> float:
        bending = 1.0 + np.cos(z) * np.cosh(z)
        turning = np.sin(z) * np.cosh(z) - np.cos(z) * np.sinh(z)
        return float(bending - r / a * z * turning)

    z = brentq(characteristic, 0.5, 1.9)
    exact = (z / a) ** 2 * np.sqrt(keel.bending / (keel.density * keel.width * keel.thickness))
    arms = np.clip(keel.places[:, None] + 0.5 * keel.pitch - keel.places, 0.0, None)  # of each segment's middle
    behind = np.tril(np.ones((keel.joints, keel.joints)))
    inertia = keel.segment_mass * (arms.T @ arms + (keel.pitch**2 + keel.thickness**2) / 12.0 * behind.T @ behind)
    stiffness, _ = joint_numbers(keel, fulcrum)
    found = np.sqrt(np.linalg.eigvals(np.linalg.solve(inertia, np.diag(stiffness))).real.min())
    assert found == pytest.approx(exact, rel=2e-3)
