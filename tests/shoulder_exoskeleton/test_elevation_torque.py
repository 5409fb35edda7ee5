"""Torque of the shoulder beside a static arm by hand and a tree of rigid bodies, and what the hands do to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.body_segments import SEGMENTS, body_segments
from geocontact.data.errors import InputError
from geocontact.data.multibody.joint import free, gimbal, weld
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import GROUND, Body, Marker, Multibody
from geocontact.dynamics.inverse_dynamics import generalised_forces
from geocontact.dynamics.tree import tree_of
from geocontact.shoulder_exoskeleton.arms_from_markers import MarkerSettings, arm_motions
from geocontact.shoulder_exoskeleton.human_arm import (
    ArmTrack,
    HandLoad,
    ToolWork,
    arm_track,
    elevation_torque,
    hand_load,
)
from geocontact.shoulder_exoskeleton.synthetic import OverheadTrial, condition, participant, synthetic_trial, task

G = np.array([0.0, -9.80665, 0.0])
DOWN = np.array([0.0, -1.0, 0.0])
LENGTHS = (0.3, 0.27, 0.09)
FRAMES = 41


def still_arm(elevation: float, flexion: float) -> ArmTrack:
    """An arm held to the front, x, in a laboratory with y up."""
    angles = (elevation, elevation + flexion, elevation + flexion)
    places = [np.array([0.2, 1.4, 0.1])]
    for length, angle in zip(LENGTHS, angles, strict=True):
        places.append(places[-1] + length * np.array([np.sin(angle), -np.cos(angle), 0.0]))
    held = [np.tile(place, (FRAMES, 1)) for place in places]
    return ArmTrack("right", np.arange(FRAMES) / 100.0, *held, down=np.tile(DOWN, (FRAMES, 1)))


def empty(frames: int = FRAMES) -> HandLoad:
    return HandLoad(0.0, np.zeros((frames, 3)))


def torque(track: ArmTrack, load: HandLoad, cutoff: float | None = None) -> np.ndarray:
    return elevation_torque(track, load, mass=80.0, segments=body_segments("male"), gravity=G, cutoff=cutoff).total


@pytest.mark.parametrize("elevation", [0.2, 0.8, np.pi / 2, 2.2])
@pytest.mark.parametrize("flexion", [0.0, 0.9])
def test_a_static_arm_by_hand(elevation: float, flexion: float) -> None:
    """Weights times levers, a tool of 1.5 kg and a push of 40 N upwards at the grip."""
    upper, fore, hand = (SEGMENTS["male"][name] for name in ("upper_arm", "forearm", "hand"))
    a, b, c = LENGTHS
    first, second = np.sin(elevation), np.sin(elevation + flexion)
    levers = (upper.centre * a * first, a * first + fore.centre * b * second)
    grip = a * first + (b + c) * second
    hand_lever = a * first + (b + hand.centre * c) * second
    masses = 80.0 * np.array([upper.mass, fore.mass, hand.mass])
    by_hand = 9.80665 * (masses @ [*levers, hand_lever] + 1.5 * grip) + 40.0 * grip
    load = HandLoad(1.5, np.tile([0.0, 40.0, 0.0], (FRAMES, 1)))
    np.testing.assert_allclose(torque(still_arm(elevation, flexion), load), by_hand, rtol=1e-11)
    np.testing.assert_allclose(torque(still_arm(elevation, flexion), load, cutoff=6.0), by_hand, rtol=1e-11)


def model() -> Multibody:
    """Shoulder that moves, arm with elbow: slender bodies hang down their own -y."""
    bodies = [Body("shoulder", 0.0, np.zeros(3), np.zeros((3, 3)))]
    for name, length in zip(("upper_arm", "forearm", "hand"), LENGTHS, strict=True):
        segment = SEGMENTS["male"][name]
        mass = 80.0 * segment.mass
        sagittal, transverse, _ = segment.moments(mass, length)
        across = 0.5 * (sagittal + transverse)  # no spin about the long axis: 0 there
        bodies.append(Body(name, mass, np.array([0.0, -segment.centre * length, 0.0]), np.diag([across, 0.0, across])))
    bodies.append(Body("tool", 1.2, np.zeros(3), np.zeros((3, 3))))
    ends = [RigidTransform.from_translation([0.0, -length, 0.0]) for length in LENGTHS]
    joints = (
        free("base", GROUND, "shoulder"),
        gimbal("gh", "shoulder", "upper_arm"),
        gimbal("elbow", "upper_arm", "forearm", ends[0]),
        weld("wrist", "forearm", "hand", ends[1]),
        weld("grip", "hand", "tool", ends[2]),
    )
    markers = tuple(Marker(name, name, np.zeros(3)) for name in ("upper_arm", "forearm", "hand", "tool"))
    return Multibody("arm", tuple(bodies), joints, markers, G)


def test_a_moving_arm_is_that_of_the_tree() -> None:
    """Shoulder, arm and elbow in motion: moment about the axis of elevation from the tree's generalised forces."""
    import casadi

    tree = tree_of(model())
    time = np.arange(201) / 100.0
    count = len(tree.names)
    rng = np.random.default_rng(5)
    rate, phase, size = rng.uniform(2.0, 6.0, count), rng.uniform(0.0, 6.0, count), rng.uniform(0.05, 0.25, count)
    size[tree.names.index("base_rx") : tree.names.index("base_rx") + 3] = 0.0
    middle = np.zeros(count)
    middle[tree.names.index("gh_rx")], middle[tree.names.index("gh_rz")] = -1.2, 0.8
    turn = rate * time[:, None] + phase
    q, u, a = middle + size * np.sin(turn), size * rate * np.cos(turn), -size * rate**2 * np.sin(turn)
    push = np.tile([5.0, 30.0, -8.0], (len(time), 1))
    places = model().marker_places(q)
    track = ArmTrack("right", time, *np.moveaxis(places, 1, 0), down=np.tile(DOWN, (len(time), 1)))
    force = casadi.SX([-5.0, -30.0, 8.0])
    loads = {"hand": (force, casadi.cross(tree.bodies["tool"].place, force))}
    needed = generalised_forces(tree, loads)
    about = casadi.Function("f", [tree.q, tree.u, tree.a], [needed[6:9], tree.axes[1].spin])
    own = np.empty(len(time))
    for k in range(len(time)):
        forces, axes = (np.array(each) for each in about(q[k], u[k], a[k]))
        own[k] = track.raising()[k] @ np.linalg.solve(axes.T, forces[:, 0])
    found = torque(track, HandLoad(1.2, push))
    inner = slice(10, -10)  # the spline's ends
    np.testing.assert_allclose(found[inner], own[inner], atol=2e-4)
    assert np.ptp(own) > 3.0


@pytest.fixture(scope="module")
def trial() -> OverheadTrial:
    return synthetic_trial(participant("P3"), task("T2"), condition("S0"))


def of_trial(trial: OverheadTrial, side: str, work: ToolWork, turn: Rotation | None = None) -> np.ndarray:
    turn = turn or Rotation.identity()
    markers, gravity = trial.markers.turned(turn), turn.apply(G)
    frame = arm_motions(markers, MarkerSettings(gravity=tuple(gravity), upright=(0.0, 0.25))).frame
    track = arm_track(markers, frame, "left" if side == "left" else "right")
    load = hand_load(work, track.side, trial.participant.dominant, trial.phase == 2)
    return elevation_torque(track, load, mass=61.0, segments=body_segments("female"), gravity=gravity).total


def test_the_laboratory_does_not_matter(trial: OverheadTrial) -> None:
    turn = Rotation.from_rotvec([0.3, -1.0, 2.0])
    moved = ToolWork(1.3, 50.0, tuple(turn.apply([0.0, 1.0, 0.0])))
    there = of_trial(trial, "left", moved, turn)
    np.testing.assert_allclose(there, of_trial(trial, "left", ToolWork(1.3, 50.0)), atol=1e-9)


def test_the_push_is_split_between_both_hands(trial: OverheadTrial) -> None:
    """What one hand takes off the other has; only the dominant one holds the tool, and only while it runs they push."""
    none, alone, both = (
        ToolWork(1.3, push, dominant_share=share) for push, share in ((0.0, 1.0), (50.0, 1.0), (50.0, 0.6))
    )
    screwing = trial.phase == 2
    left = [of_trial(trial, "left", each) for each in (none, alone, both)]
    right = [of_trial(trial, "right", each) for each in (none, alone, both)]
    np.testing.assert_allclose(left[2] - left[0], 0.6 * (left[1] - left[0]), atol=1e-9)
    np.testing.assert_allclose(right[1], right[0], atol=1e-9)
    assert (right[2] - right[0])[screwing].min() > 3.0
    np.testing.assert_allclose((left[1] - left[0])[~screwing], 0.0, atol=1e-9)
    assert left[0].mean() - of_trial(trial, "left", ToolWork(0.0, 0.0)).mean() > 3.0


def test_a_hanging_arm_has_no_axis_and_no_torque() -> None:
    np.testing.assert_allclose(torque(still_arm(0.0, 0.0), empty()), 0.0, atol=1e-6)


def test_what_is_missing_is_named(trial: OverheadTrial) -> None:
    frame = arm_motions(trial.markers).frame
    names = tuple("?" if name == "LWRI" else name for name in trial.markers.names)
    with pytest.raises(InputError, match="no marker LWRI, which the weight of the left arm needs; name them"):
        arm_track(replace(trial.markers, names=names), frame, "left")
    places = trial.markers.positions.copy()
    places[40, trial.markers.names.index("RELB")] = np.nan
    gap = MarkerTrajectories(trial.markers.time, places, trial.markers.names)
    with pytest.raises(InputError, match="RELB is not seen in all frames; fill the gaps first"):
        arm_track(gap, frame, "right")
    with pytest.raises(ValueError, match="cannot exert 120% of the push"):
        ToolWork(1.0, 10.0, dominant_share=1.2)
    with pytest.raises(ValueError, match="must not be negative"):
        ToolWork(-1.0, 10.0)


def test_own_values_of_the_arm_need_their_own_torque() -> None:
    """A straight arm that swings in a plane: weights at levers, and (k² + r²) m of each segment times its turning."""
    own = {
        "upper_arm": {"mass": 3.0, "length": 0.3, "centre": 0.11, "gyration": 0.12},
        "forearm": {"mass": 1.7, "length": 0.27, "centre": 0.1, "gyration": 0.06},
        "hand": {"mass": 0.9, "length": 0.09, "centre": 0.05, "gyration": 0.03},
    }
    body = body_segments("male", mass=80.0, own=own)
    time = np.arange(301) / 100.0
    angle, turning = 1.2 + 0.4 * np.sin(3.0 * time), -0.4 * 9.0 * np.sin(3.0 * time)
    unit = np.column_stack([np.sin(angle), -np.cos(angle), np.zeros_like(angle)])
    reach = np.cumsum([0.0, *LENGTHS])
    places = [np.array([0.2, 1.4, 0.1]) + far * unit for far in reach]
    track = ArmTrack("right", time, *places, down=np.tile(DOWN, (len(time), 1)))
    needed = elevation_torque(track, empty(len(time)), mass=80.0, segments=body, gravity=G, cutoff=None)
    levers = [near + values["centre"] for near, values in zip(reach[:-1], own.values(), strict=True)]
    masses, radii = ([values[key] for values in own.values()] for key in ("mass", "gyration"))
    weight = 9.80665 * np.dot(masses, levers) * np.sin(angle)
    motion = np.dot(masses, np.square(radii) + np.square(levers)) * turning
    inner = slice(10, -10)  # splines are poor at their ends
    np.testing.assert_allclose(needed.weight[inner], weight[inner], rtol=1e-10)
    np.testing.assert_allclose(needed.motion[inner], motion[inner], atol=2e-6 * np.abs(motion).max())
    assert (
        np.abs(
            needed.weight
            / elevation_torque(
                track, empty(len(time)), mass=80.0, segments=body_segments("male"), gravity=G, cutoff=None
            ).weight
            - 1.0
        ).min()
        > 0.05
    )
