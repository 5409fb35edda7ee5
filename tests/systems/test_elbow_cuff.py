"""Moment on the cuff, torque that reaches the joint, a fixation that yields: against free bodies, energy and limits."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from geocontact.axis_misalignment.bins import binned
from geocontact.axis_misalignment.explicit import Offsets, constraint_force, displacement
from geocontact.axis_misalignment.law import CuffLoads, ElbowLaw, cuff_loads, yielded
from geocontact.axis_misalignment.least_squares import estimated, problem_of
from geocontact.axis_misalignment.synthetic import PAPER, Design, ideal
from geocontact.axis_misalignment.uncertainty import separability
from tests.systems.elbow_trials import parameters, trials

BETA = np.radians(np.linspace(5.0, 110.0, 8))
STILL = np.zeros(8)
OFFSETS = Offsets(l=PAPER["l"], z=PAPER["z"], x=PAPER["x"], y=PAPER["y"])
K = PAPER["k"]


def across(a: np.ndarray, b: np.ndarray) -> float:
    """Moment of a force b at a, positive towards flexion, which turns the limb's axis towards the first axis."""
    return float(a[1] * b[0] - a[0] * b[1])


def by_free_bodies(beta: float, o: Offsets, force: float, turning: float, torque: float) -> dict[str, float]:
    """Link and forearm cut free of each other, of the upper arm and of the joint: six balances for six unknowns.

    The link's end presses on the forearm's line by N at right angles to it; a bar at right angles to the link presses
    on the cuff, z behind that line, along the link, so that its part along the forearm is F; and the cuff turns.
    """
    axis = np.array([-o.x, o.y])
    link = np.array([np.sin(beta), np.cos(beta)])
    end = axis + o.l * link
    limb = end / np.hypot(*end)
    gamma = float(np.arctan2(across(limb, link), limb @ link))
    behind = np.array([-limb[1], limb[0]])
    bar = np.array([-link[1], link[0]])
    cuff = end + o.z / (bar @ behind) * bar
    on_link = force / (link @ limb) * link
    couple = turning * gamma  # on the forearm
    # unknown: N, the reactions at both axes and the torque of the joint on the forearm
    a, b = np.zeros((6, 6)), np.zeros(6)
    a[0:2, 0], a[0:2, 1:3], b[0:2] = behind, np.eye(2), -on_link
    a[2, 0], b[2] = across(end - axis, behind), -torque + couple - across(cuff - axis, on_link)
    a[3:5, 0], a[3:5, 3:5], b[3:5] = -behind, np.eye(2), on_link
    a[5, 0], a[5, 5], b[5] = across(end, -behind), 1.0, across(cuff, on_link) - couple
    n, *_, held = np.linalg.solve(a, b)
    moment = couple + across(cuff - end, -on_link)
    return {"gamma": gamma, "moment": moment, "joint_torque": -held,
            "across": float(-(n * behind + on_link) @ -behind)}  # fmt: skip


def loads_of(beta: float, o: Offsets, force: float, turning: float, torque: float) -> CuffLoads:
    at = yielded(np.array([beta]), np.zeros(1), o, 1.0)
    return cuff_loads(
        np.array([beta]), (o.l, o.z), type(at)(np.array([force]), at.x, at.y), turning=turning, torque=torque
    )


@given(
    st.floats(0.0, 2.2), st.floats(-0.1, 0.1), st.floats(-0.1, 0.1), st.floats(-0.13, 0.13),
    st.floats(-20.0, 20.0), st.floats(0.0, 10.0), st.floats(-8.0, 8.0),
)  # fmt: skip
def test_loads_balance_link_and_forearm(
    beta: float, x: float, y: float, z: float, force: float, turning: float, torque: float
) -> None:
    o = Offsets(0.2, z, x, y)
    assume(o.l + y * np.cos(beta) - x * np.sin(beta) > 0.03)
    want = by_free_bodies(beta, o, force, turning, torque)
    got = loads_of(beta, o, force, turning, torque)
    for name, value in want.items():
        assert getattr(got, name)[0] == pytest.approx(value, rel=1e-9, abs=1e-9), name


def test_the_actuators_work_is_the_joints_and_the_springs() -> None:
    """Along the angle, by the explicit model's own displacement: τ dβ = torque of the joint dα + d(k d²/2 + κ γ²/2)."""
    beta = np.linspace(0.1, 1.9, 4001)
    torque, turning = 2.0 + np.sin(3.0 * beta), 1.5
    d = displacement(beta, OFFSETS)
    loads = cuff_loads(
        beta, (OFFSETS.l, OFFSETS.z), yielded(beta, 0.0 * beta, OFFSETS, K), turning=turning, torque=torque
    )
    stored = 0.5 * K * d.total**2 + 0.5 * turning * d.gamma**2
    given_, passed = np.trapezoid(torque, beta), np.trapezoid(loads.joint_torque, d.alpha)
    assert given_ - passed == pytest.approx(stored[-1] - stored[0], rel=1e-6)
    assert abs(stored[-1] - stored[0]) > 0.2
    np.testing.assert_allclose(loads.joint_torque * loads.ratio + loads.constraint_torque, torque, rtol=1e-12)


def test_without_offsets_the_joint_has_the_actuators_torque() -> None:
    o = Offsets(0.2, 0.08, 0.0, 0.0)
    loads = cuff_loads(BETA, (o.l, o.z), yielded(BETA, STILL, o, K), turning=5.0, torque=3.0)
    np.testing.assert_allclose(loads.joint_torque, 3.0, rtol=1e-12)
    np.testing.assert_allclose([loads.moment, loads.gamma, loads.constraint_torque], 0.0, atol=1e-12)
    np.testing.assert_allclose(loads.across, 3.0 / 0.2)


def test_a_stiff_fixation_is_the_explicit_model_and_a_soft_one_bears_nothing() -> None:
    rate = np.full(8, 0.4)
    rigid = constraint_force(BETA, rate, OFFSETS, K, 3.0)
    np.testing.assert_array_equal(yielded(BETA, rate, OFFSETS, K, damping=3.0).force, rigid)
    np.testing.assert_allclose(yielded(BETA, rate, OFFSETS, K, damping=3.0, compliance=1e-12).force, rigid, rtol=1e-8)
    forces = [np.abs(yielded(BETA, STILL, OFFSETS, K, compliance=c).force) for c in (0.0, 1e-4, 1e-3, 1e-2, 1.0, 1e3)]
    assert all((softer < stiffer).all() for stiffer, softer in pairwise(forces))
    assert forces[-1].max() < 1e-4


@pytest.mark.parametrize("stroke", [(0.0, 0.0), (-0.005, 0.002)])
def test_the_axis_rests_where_fixation_and_cuff_balance(stroke: tuple[float, float]) -> None:
    """The shift is c times the force on the link, and the cuff's force k times what is beyond the stroke there."""
    c, torque, turning = 1e-3, 2.0, 1.0
    rest = yielded(BETA, STILL, OFFSETS, K, turning=turning, compliance=c, torque=torque, stroke=stroke)
    for k, beta in enumerate(BETA):
        there = Offsets(OFFSETS.l, OFFSETS.z, float(rest.x[k]), float(rest.y[k]))
        want = by_free_bodies(beta, there, float(rest.force[k]), turning, torque)
        limb = np.array([np.sin(beta - want["gamma"]), np.cos(beta - want["gamma"])])
        flexing = np.array([limb[1], -limb[0]])
        shift = c * (rest.force[k] * limb - want["across"] * flexing)
        np.testing.assert_allclose([OFFSETS.x - rest.x[k], rest.y[k] - OFFSETS.y], shift, atol=1e-12)
    d = rest.deflection(BETA, OFFSETS)
    np.testing.assert_allclose(rest.force, K * (d - np.clip(d, *stroke)), atol=1e-9)
    assert np.hypot(rest.x - OFFSETS.x, rest.y - OFFSETS.y).max() > 0.01


def test_on_the_limbs_line_cuff_and_fixation_are_in_series_to_first_order() -> None:
    o = Offsets(0.169, 0.0, 0.048, 0.059)
    rigid = constraint_force(BETA, STILL, o, 1.0)
    off = [np.abs(yielded(BETA, STILL, o, K, compliance=c).force - rigid / (1.0 / K + c)).max() for c in (2e-5, 1e-5)]
    assert off[0] < 1e-3 and off[0] / off[1] == pytest.approx(4.0, rel=0.1)


def test_beside_the_limbs_line_the_fixation_counts_by_more_than_its_compliance() -> None:
    """F = d/(1/k + c g) to first order in c, and the paper's g is above 1 at every angle."""
    d = displacement(BETA, OFFSETS)
    reach, cosine = (
        np.hypot(OFFSETS.l * np.sin(BETA) - OFFSETS.x, OFFSETS.y + OFFSETS.l * np.cos(BETA)),
        np.cos(d.gamma),
    )
    z = OFFSETS.z / (reach * cosine**2)
    g = 1.0 + z * (OFFSETS.z / (OFFSETS.l * cosine**3) - np.tan(d.gamma))
    assert (g > 1.2).all()
    off = [np.abs(yielded(BETA, STILL, OFFSETS, K, compliance=c).force - d.total / (1.0 / K + c * g)).max()
           for c in (2e-5, 1e-5)]  # fmt: skip
    assert off[0] < 1e-3 and off[0] / off[1] == pytest.approx(4.0, rel=0.1)


def test_a_damper_behind_a_fixation_is_right_to_first_order() -> None:
    """Beside k d + b ḋ = F with d less by c F, integrated; the error falls with the square of b."""
    o, c = Offsets(0.169, 0.0, 0.01, 0.012), 2e-3
    time = np.linspace(0.0, 6.0, 601)
    beta = 0.8 + 0.5 * np.sin(2.0 * time)
    rate = np.cos(2.0 * time)

    def apart(b: float) -> float:
        def left(t: float, d: np.ndarray) -> list[float]:
            at, speed = np.array([0.8 + 0.5 * np.sin(2.0 * t)]), np.array([np.cos(2.0 * t)])
            ends = constraint_force(at, speed, o, 1.0)[0]
            return [((ends - d[0]) / c - K * d[0]) / b]

        first = yielded(beta[:1], rate[:1], o, K, damping=b, compliance=c)
        start = constraint_force(beta[:1], rate[:1], o, 1.0)[0] - c * first.force[0]
        found = solve_ivp(left, (0.0, 6.0), [start], t_eval=time, rtol=1e-9, atol=1e-12, method="LSODA").y[0]
        force = (constraint_force(beta, rate, o, 1.0) - found) / c
        settled = time > 3.0
        return float(np.abs(yielded(beta, rate, o, K, damping=b, compliance=c).force - force)[settled].max())

    assert apart(20.0) / apart(10.0) == pytest.approx(4.0, rel=0.25)


def test_a_fixation_too_soft_for_the_torque_is_refused() -> None:
    with pytest.raises(ValueError, match=r"does not come to rest with a fixation of 1000 mm/N"):
        yielded(BETA, STILL, OFFSETS, K, compliance=1.0, torque=3.0)
    with pytest.raises(ValueError, match="damping b, a stroke and a fixation"):
        yielded(BETA, STILL, OFFSETS, K, damping=1.0, compliance=1e-3, stroke=(0.0, 0.01))


def test_lengths_stiffness_and_compliance_have_one_factor_in_common() -> None:
    law = ElbowLaw(BETA, np.full(8, 0.3), STILL)
    theta = np.array([222.0, 0.048, 0.059, 0.169, 0.127, 3.0, 0.0, 1e-3])
    scaled = theta * np.array([1.0 / 1.7, 1.7, 1.7, 1.7, 1.7, 1.0 / 1.7, 1.0, 1.7])
    np.testing.assert_allclose(law.force(scaled), law.force(theta), rtol=1e-9)


def test_what_a_fixation_does_of_its_own_is_told() -> None:
    """Nothing on the limb's line; beside it a few per cent, by the force across that z brings about."""
    clean = Design(seconds=20.0, rate=50.0, noise=1e-6, memory=0.1, bits=0)
    for z, least, most in ((0.0, 0.0, 1e-6), (PAPER["z"], 0.005, 0.1)):
        data = binned(trials({**PAPER, "z": z}, clean, count=2), np.radians(2.0))
        apart = separability(estimated(problem_of(data, parameters({"l": PAPER["l"], "z": z}), {}), 2))
        assert least <= apart.from_all <= apart.from_cuff < most
        assert apart.separable == (z != 0.0)


def test_the_compliance_is_found_where_the_cuffs_stiffness_is_known() -> None:
    clean = Design(seconds=20.0, rate=50.0, noise=1e-6, memory=0.1, bits=0)
    truth = {**PAPER, "c": 1e-3}
    data = binned(trials(truth, clean, count=2), np.radians(0.5))
    known = {name: PAPER[name] for name in "klz"}
    found = estimated(problem_of(data, parameters(known, "xyc"), {}), 2).named
    assert found["c"] == pytest.approx(1e-3, rel=0.03) and found["x"] == pytest.approx(PAPER["x"], rel=0.01)


def test_a_free_joint_slides_by_what_the_fixation_leaves() -> None:
    time = np.linspace(0.0, 2.0, 101)
    beta = 0.3 + 0.6 * time
    force, joint = ideal(time, beta, {**PAPER, "c": 1e-3}, (-0.005, 0.01))
    plain, slid = ideal(time, beta, PAPER, (-0.005, 0.01))
    between = (joint > -0.005) & (joint < 0.01)
    assert 10 < between.sum() < 90 and not force[between].any()
    np.testing.assert_allclose(joint[between], slid[between], atol=1e-12)
    assert (np.abs(force) <= np.abs(plain)).all() and force[-1] > 0.5
