"""Both legs: what they weigh, what their markers tell, the image of the other side, and the file that OpenSim opens."""

from __future__ import annotations

from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import casadi
import numpy as np
import pytest

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.standing import standing_amputee, standing_joints
from geocontact.below_knee_prosthesis.from_markers import MIRROR
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.data.body_segments import SEGMENTS
from geocontact.data.errors import InputError
from geocontact.dynamics.inverse_dynamics import generalised_forces
from geocontact.dynamics.tree import tree_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.osim_writer import ContactBall, write_osim
from meshes.amputee import StandingTrials, standing_trials, true_amputee
from meshes.gait_persons import PARTICIPANTS
from tests import opensim_oracle
from tests.elsewhere import another_process

BELOW, FULCRUM = 0.03, fulcrum_of("medium", "pinned")


@pytest.fixture(scope="module")
def truth() -> Amputee:
    return true_amputee(PARTICIPANTS[0], vsf_foot(), FULCRUM)


@pytest.fixture(scope="module")
def trials() -> StandingTrials:
    return standing_trials(PARTICIPANTS[0], vsf_foot(), FULCRUM)


@pytest.mark.parametrize("person", PARTICIPANTS, ids=lambda p: p.name)
def test_masses_add_up_to_the_person(person) -> None:  # type: ignore[no-untyped-def]
    model = amputee_tree(true_amputee(person, vsf_foot(), FULCRUM), person.side)
    assert model.mass == pytest.approx(person.mass, rel=1e-12)
    assert all(np.linalg.eigvalsh(body.inertia).min() > 0.0 for body in model.bodies)
    kinds = [c.name for c in model.coordinates if not c.name.startswith("keel_")]
    assert len(kinds) == 28
    assert len(model.coordinates) == 36


def test_foot_and_density_are_de_leva_s(truth: Amputee) -> None:
    """Foot and toes together have his mass and mass centre, whatever the frustum that shares them out."""
    leg, of = truth.intact, SEGMENTS["male"]
    rear, toes = leg.foot_bodies()
    assert rear[0] + toes[0] == pytest.approx(of["foot"].mass * 77.3, rel=1e-12)
    centre = (rear[0] * rear[1][0] + toes[0] * (toes[1][0] + leg.toe_joint[0])) / (rear[0] + toes[0])
    assert (centre - leg.heel[0]) / leg.length == pytest.approx(of["foot"].centre, rel=1e-9)
    assert leg.shank_body()[0] == pytest.approx(of["shank"].mass * 77.3, rel=1e-12)
    whole = replace(
        truth, prosthetic=replace(truth.prosthetic, person=replace(truth.prosthetic.person, residual=0.999))
    )
    assert whole.prosthetic.residual_body()[0] == pytest.approx(of["shank"].mass * 77.3, rel=2e-3)


def test_a_left_prosthesis_is_the_mirror_image(truth: Amputee) -> None:
    right, left = amputee_tree(truth, "right"), amputee_tree(truth, "left")
    rng = np.random.default_rng(3)
    values = {c.name: 0.3 * rng.standard_normal() for c in right.coordinates}
    turned = {"_r": "_l", "_l": "_r"}
    other = np.array([[values[c.name[:-2] + turned.get(c.name[-2:], c.name[-2:])] for c in left.coordinates]])
    for name in ("pelvis_rotation", "pelvis_list", "pelvis_tz"):
        other[0, [c.name for c in left.coordinates].index(name)] *= -1.0
    one = right.marker_places(np.array([list(values.values())]))[0]
    np.testing.assert_allclose(left.marker_places(other)[0], one * MIRROR, atol=1e-12)
    assert [m.name for m in left.markers][4] == "LTH1"


def test_markers_give_back_the_person(trials: StandingTrials) -> None:
    """Skin is 7 mm off on the thighs, a hand 6 mm on the intact knee, a regression 6 mm at the hips."""
    truth, found = trials.truth, {}
    joints = standing_joints(trials.standing, trials.functional)
    assert not joints.untold
    for name, known in (("functional", (joints,)), ("markers", ())):
        person = truth.prosthetic.person
        one = standing_amputee(trials.standing, person, truth.foot, FULCRUM, BELOW, *known)
        model = amputee_tree(one)
        assert model.mass == pytest.approx(77.3, rel=1e-12)
        found[name] = one
    functional, markers = found["functional"], found["markers"]
    assert np.linalg.norm(functional.prosthetic.hip - truth.prosthetic.hip) < 0.005
    assert np.linalg.norm(functional.intact.hip - truth.intact.hip) < 0.005
    assert functional.intact.thigh == pytest.approx(truth.intact.thigh, abs=0.005)
    assert functional.prosthetic.thigh == pytest.approx(truth.prosthetic.thigh, abs=0.005)
    assert np.linalg.norm(markers.prosthetic.hip - truth.prosthetic.hip) < 0.008
    assert functional.intact.length == pytest.approx(truth.intact.length, abs=0.002)


def test_exact_markers_give_the_centres_exactly(truth: Amputee) -> None:
    """A functional trial without errors, whatever the regression and the hand that put the markers on."""
    trial = standing_trials(PARTICIPANTS[0], vsf_foot(), FULCRUM, errors=0.0)
    joints = standing_joints(trial.standing, trial.functional)
    found = standing_amputee(trial.standing, truth.prosthetic.person, truth.foot, FULCRUM, BELOW, joints)
    np.testing.assert_allclose(found.prosthetic.hip, truth.prosthetic.hip, atol=1e-9)
    np.testing.assert_allclose(found.intact.hip, truth.intact.hip, atol=1e-9)
    assert max(point.rms for point in joints.points.values()) < 1e-9
    assert max(line.rms for line in joints.lines.values()) < 1e-9
    assert (found.intact.thigh - truth.intact.thigh) < 1e-4  # the hand's middle of the epicondyles, on the axis


def test_exchanged_legs_and_lines_are_refused(trials: StandingTrials) -> None:
    truth, seen = trials.truth, trials.standing
    spoilt = {
        "on the intact side": {"LKNE": "LKNM", "LKNM": "LKNE"},
        "LHEE and LHLX are exchanged": {"LHEE": "LHLX", "LHLX": "LHEE"},
        "do not follow each other": {"LMT1": "LHLX", "LHLX": "LMT1"},
        "RHEE and RTOE are exchanged": {"RHEE": "RTOE", "RTOE": "RHEE"},
    }
    for words, names in spoilt.items():
        other = replace(seen, names=tuple(names.get(name, name) for name in seen.names))
        with pytest.raises(InputError, match=words):
            standing_amputee(other, truth.prosthetic.person, truth.foot, FULCRUM, BELOW)
    places = seen.positions.copy()
    at = [seen.names.index(name) for name in ("LSH1", "LSH2", "LSH3", "LANK")]
    share = np.linspace(0.0, 1.0, 4)[:, None]
    places[:, at] = places[:, at[:1]] + share * (places[:, at[3:]] - places[:, at[:1]])
    with pytest.raises(InputError, match="LSH1, LSH2, LSH3, LANK lie on a line"):
        standing_amputee(replace(seen, positions=places), truth.prosthetic.person, truth.foot, FULCRUM, BELOW)


@pytest.mark.parametrize("side", ["right", "left"])
def test_the_written_file_is_the_model(truth: Amputee, side, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    model = amputee_tree(truth, side)
    file = tmp_path / "amputee.osim"
    write_osim(file, model, springs={"keel_1_r": (100.0, 0.2)})
    found = read_multibody(file)
    values = 0.3 * np.random.default_rng(5).standard_normal((4, 36))
    ours, theirs = model.poses(values), found.poses(values)
    for name, pose in ours.items():
        np.testing.assert_allclose(theirs[name].as_matrix(), pose.as_matrix(), atol=1e-14)
    for one, other in zip(model.bodies, found.bodies, strict=True):
        np.testing.assert_allclose(other.inertia, one.inertia, atol=1e-17)
    assert [c.locked for c in found.coordinates] == [c.locked for c in model.coordinates]
    np.testing.assert_allclose(found.marker_places(values), model.marker_places(values), atol=1e-14)


@pytest.mark.oracle
@pytest.mark.parametrize("side", ["right", "left"])
def test_opensim_opens_it_and_moves_alike(truth: Amputee, side, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    """Poses of all bodies, and moments without springs, at random states; knees held as in the file."""
    if find_spec("opensim") is None:
        pytest.skip("opensim is the oracle and not installed")
    model = amputee_tree(truth, side)
    end = f"_{side[0]}"
    sole, _ = truth.intact.spheres()
    balls = [ContactBall("heel", f"calcn{end}", sole.centre[0], float(sole.radius[0]))]
    springs = {f"{name}{end}": pair for name, pair in truth.springs().items()}
    file = tmp_path / "amputee.osim"
    write_osim(file, model, springs=springs, balls=balls, note="synthetic")
    names = [c.name for c in model.coordinates]
    rng = np.random.default_rng(7)
    states = [0.3 * rng.standard_normal((4, 36)), *rng.standard_normal((2, 4, 36))]
    held = [k for k, c in enumerate(model.coordinates) if c.locked]
    for each in states:
        each[:, held] = 0.0
    pairs = [(body.name, "ground") for body in model.bodies]
    with another_process() as call:
        theirs = call(opensim_oracle.poses, file, names, states[0], pairs)
        forces = call(opensim_oracle.inverse_dynamics, file, names, *states)
    ours = model.poses(states[0])
    for k, (name, _) in enumerate(pairs):
        np.testing.assert_allclose(theirs[:, k], ours[name].as_matrix(), atol=1e-12)
    tree = tree_of(model)
    run = casadi.Function("id", [tree.q, tree.u, tree.a], [generalised_forces(tree)]).map(4)
    wanted = np.array(run(*(each.T for each in states))).T
    free = [k for k in range(36) if k not in held]
    np.testing.assert_allclose(forces[:, free], wanted[:, free], atol=1e-9 * np.abs(wanted).max())


def test_weight_and_moment_of_a_still_person(truth: Amputee) -> None:
    """What acts along the pelvis' height carries the weight, and nothing along the floor, in any posture."""
    tree = tree_of(amputee_tree(truth))
    run = casadi.Function("id", [tree.q, tree.u, tree.a], [generalised_forces(tree)])
    q = 0.2 * np.random.default_rng(11).standard_normal(36)
    found = np.array(run(q, np.zeros(36), np.zeros(36))).ravel()
    at = [tree.names.index(f"pelvis_t{axis}") for axis in "xyz"]
    np.testing.assert_allclose(found[at], [0.0, 77.3 * GRAVITY, 0.0], atol=1e-9)
