"""Loads of the person without and with the device: what is written, beside `id` with the written external loads."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import solve_ivp

import geocontact as gc
from geocontact.analyses.shoulder.simulate import person_answers
from geocontact.analyses.shoulder.simulate.person_answers import _leaning, loads_in_laboratory
from geocontact.analyses.shoulder.simulate.result import ShoulderSimulateResult
from geocontact.data.body_segments import body_segments
from geocontact.data.wrench import Wrench
from geocontact.shoulder_exoskeleton.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.human_arm import ArmTrack, HandLoad
from geocontact.shoulder_exoskeleton.joint_loads import (
    Load,
    PersonNumbers,
    Trunk,
    arm_needs,
    back_needs,
    extending_torque,
)
from geocontact.shoulder_exoskeleton.torque_kept import LeavesAtOnceError, torque_kept
from tests.analyses.shoulder.test_simulate import still_arms

TRIAL = "meshes/overhead_P1T1S100"


@cache
def found() -> ShoulderSimulateResult:
    """A second and a half, both arms."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        return gc.shoulder.simulate(
            f"{TRIAL}/markers.trc", tool=f"{TRIAL}/tool.csv", level=1.0, upright="0:0.5", mass="82kg", tool_mass="1.3kg"
        )


def of(name: str, where: str) -> dict[str, np.ndarray]:
    person = found().person
    assert person is not None
    return next(dict(each.by) for each in person.quantities if each.name == name and each.where == where)


def test_the_back_s_change_is_that_of_id_with_the_written_loads(tmp_path: Path) -> None:
    """Trunk and arms without mass are held at the ground's origin by the opposite of all loads: moved to the hips."""
    result = found()
    folder = result.write(tmp_path / "out")
    model, motion = still_arms(tmp_path, result.arms[0].simulation.motion.time)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        id_found = gc.inverse_dynamics(motion, model=model, loads=folder / "interface_forces.xml", cutoff=0.0)
    values = dict(zip(id_found.forces.names, np.asarray(id_found.forces.values).T, strict=True))
    force, moment = (
        np.sum(
            [np.column_stack([values[f"{b}_{k}{a}_{w}"] for a in "xyz"]) for b in ("humerus_r", "humerus_l", "torso")],
            axis=0,
        )
        for k, w in (("t", "force"), ("r", "moment"))
    )
    frame = result.frame
    middle = np.mean([each.simulation.motion.shoulder for each in result.arms], axis=(0, 1)) * [0.0, 1.0, 1.0]
    hips = frame.origin + np.einsum("tji,j->ti", frame.rotation, middle - [0.0, 0.0, result.wearer.torso])
    held = Wrench(force, moment, np.zeros_like(hips), "ground").moved_to(hips).moment
    back = of("extending torque", "lower back")
    change = back["motion kept"] - back["without"]
    np.testing.assert_allclose(change, -np.einsum("ti,ti->t", frame.rotation[:, 0], held), atol=0.02)
    assert np.abs(change).max() > 1.0


def test_the_shoulder_s_change_is_the_moment_of_the_cuff() -> None:
    """By hand in the device's frame; nothing changes at the elbow, and the kept torque is that without the device."""
    result = found()
    for arm in result.arms:
        s = arm.simulation
        torque, elbow = (
            of(name, f"{arm.side} arm") for name in ("raising torque of the shoulder", "bending torque of the elbow")
        )
        reach = s.motion.interface - s.motion.shoulder
        axis = np.cross([0.0, 0.0, -1.0], reach)
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
        lifted = np.einsum("ti,ti->t", axis, np.cross(reach, s.outputs["force"]))
        np.testing.assert_allclose(torque["without"] - torque["motion kept"], lifted, atol=0.3)
        np.testing.assert_array_equal(elbow["without"], elbow["motion kept"])
        kept = torque["torque kept"]
        np.testing.assert_allclose(kept, torque["without"][: len(kept)])


def test_the_table_has_both_bounds_and_says_how_long() -> None:
    result = found()
    table = result.tables()["person"].set_index(["part", "where", "quantity", "size"])
    whole = table.loc[("whole recording", "right arm", "raising torque of the shoulder", "mean")]
    torque = of("raising torque of the shoulder", "right arm")
    assert whole["without"] == pytest.approx(torque["without"].mean())
    assert np.isnan(whole["torque kept"])
    until = table.loc[("until an arm leaves its range", "right arm", "elevation", "largest")]
    assert until["torque kept"] > until["motion kept"] == until["without"]
    assert until["to [s]"] < 2.5
    assert any(line.startswith("right arm, torque kept: leaves its range at 1.") for line in result.sentences)
    assert "What the person carries" in str(result.pages({})["report.html"])
    assert {"shoulder", "person"} == set(result.curves())
    person = result.person
    assert person is not None
    assert max(kept.unexplained for kept in person.kept.values()) < 0.1


def test_one_arm_has_no_back_and_ankles_must_hold() -> None:
    given = {"level": 1.0, "upright": "0:0.5", "mass": 82.0}
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        one = gc.shoulder.simulate(f"{TRIAL}/markers.trc", side="right", time="0:1", **given)
    assert any("lower back and sway need both arms" in str(each.message) for each in seen)
    assert set(one.tables()["person"]["where"]) == {"right arm"}
    warnings.simplefilter("ignore", gc.InputWarning)
    with pytest.raises(gc.InputError, match=r"0\.91 m g h holds nobody up"):
        gc.shoulder.simulate(f"{TRIAL}/markers.trc", time="0:1", ankle_stiffness=0.91, **given)


def short(monkeypatch: pytest.MonkeyPatch, keeps: Callable[..., object]) -> tuple[ShoulderSimulateResult, str]:
    """Half a second with another way of keeping the torque, and all warnings."""
    monkeypatch.setattr(person_answers, "torque_kept", keeps)
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        result = gc.shoulder.simulate(f"{TRIAL}/markers.trc", time="0:0.5", level=1.0, upright="0:0.5", mass=82.0)
    return result, " ".join(str(each.message) for each in seen)


def test_an_arm_that_keeps_no_torque_is_said_and_ends_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """The left arm leaves its range at once: motion kept is there for all, torque kept for the right arm alone."""

    def keeps(track: ArmTrack, *given: object, **named: object) -> object:
        if track.side == "left":
            raise LeavesAtOnceError("an arm that keeps its torque leaves its range after 3 frames")
        return torque_kept(track, *given, **named)

    result, words = short(monkeypatch, keeps)
    assert "left arm: an arm that keeps its torque leaves its range after 3 frames" in words
    person = result.person
    assert person is not None
    assert set(person.kept) == {"right"} and person.until == 0
    assert [each.where for each in person.quantities if "torque kept" in each.by] == ["right arm"] * 3
    assert "torque kept" in result.tables()["person"]
    assert set(result.curves()) == {"shoulder", "person"}


def test_what_the_equations_miss_of_the_torque_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    def keeps(*given: object, **named: object) -> object:
        found = torque_kept(*given, **named)
        return replace(found, unexplained=0.11 * float(np.abs(found.kept).max()))

    assert "right arm, torque kept: equations in three dimensions miss" in short(monkeypatch, keeps)[1]
    assert "equations in three dimensions" not in short(monkeypatch, torque_kept)[1]


def test_markers_of_the_hand_are_needed(tmp_path: Path) -> None:
    """Without the wrist's marker the weight of the forearm is not known."""
    with pytest.raises(gc.InputError, match="no marker RWRI, which the weight of the right arm needs"):
        gc.shoulder.simulate(f"{TRIAL}/markers.trc", side="right", markers_map="RWRI=ELSEWHERE", mass=82.0, level=1.0)
    assert not list(tmp_path.iterdir())
    with pytest.raises(gc.InputError, match="`push`"):
        gc.shoulder.simulate(f"{TRIAL}/markers.trc", mass=82.0, push=35.0)


def test_the_written_table_is_read_back(tmp_path: Path) -> None:
    folder = found().write(tmp_path / "out")
    table = pd.read_csv(folder / "person.csv")
    assert list(table.columns[-3:]) == ["without", "motion kept", "torque kept"]


def test_the_back_under_a_kept_torque_is_that_of_the_moved_arms() -> None:
    """Counted anew from the joints of the moved arms and the device's loads there, not as a change."""
    result = found()
    person = result.person
    assert person is not None
    n, frame = person.until, result.frame
    cut = DeviceFrame(frame.origin[:n], frame.rotation[:n])
    middle = np.mean([each.simulation.motion.shoulder for each in result.arms], axis=(0, 1)) * [0.0, 1.0, 1.0]
    top = cut.origin + np.einsum("tji,j->ti", cut.rotation, middle)
    trunk = Trunk(person.time[:n], top - result.wearer.torso * cut.rotation[:, 2], top, cut.rotation[:, 0])
    given = PersonNumbers(mass=82.0, segments=body_segments("male"), gravity=np.array([0.0, -9.81, 0.0]))
    needs, loads = [], []
    for side, kept in person.kept.items():
        track = kept.track
        own = {name: getattr(track, name)[:n] for name in ("time", "shoulder", "elbow", "wrist", "hand", "down")}
        hand = HandLoad(1.3 if side == "right" else 0.0, np.zeros((n, 3)))
        needs.append(arm_needs(ArmTrack(side, **own), hand, **given))
        whole = DeviceFrame(frame.origin[: len(kept.departure)], frame.rotation[: len(kept.departure)])
        both = loads_in_laboratory(kept.simulation, whole)
        loads.append({name: Load(each.force[:n], each.place[:n], each.moment[:n]) for name, each in both.items()})
    wanted = extending_torque(trunk, back_needs(trunk, needs, **given), loads)
    back = of("extending torque", "lower back")["torque kept"]
    np.testing.assert_allclose(back[5:-5], wanted[5:-5], atol=0.5)
    assert np.abs(back).max() > np.abs(of("extending torque", "lower back")["motion kept"][:n]).max() + 10.0


def test_a_push_from_behind_leans_forwards_and_a_weight_behind_the_ankles_backwards() -> None:
    """y up, z to the right: F h of a push at a height, -W d of a weight behind, and a couple about the left."""
    still = np.zeros((5, 3))
    left = np.tile([0.0, 0.0, -1.0], (5, 1))

    def at(*values: float) -> np.ndarray:
        return np.tile(values, (5, 1))

    trunk = Trunk(np.arange(5.0), at(0.0, 0.9, 0.0), at(0.0, 1.4, 0.0), left)
    ankle = np.array([[0.05, 0.07, 0.0]])
    push = Load(at(10.0, 0.0, 0.0), at(0.0, 1.27, 0.3), still)
    weight = Load(at(0.0, -40.0, 0.0), at(-0.1, 1.2, 0.0), still)
    couple = Load(still, still, 3.0 * left)
    assert _leaning(trunk, ankle, [{"push": push}]) == pytest.approx(10.0 * 1.2)
    assert _leaning(trunk, ankle, [{"weight": weight}]) == pytest.approx(-40.0 * 0.15)
    assert _leaning(trunk, ankle, [{"couple": couple}, {"push": push, "weight": weight}]) == pytest.approx(9.0)


def test_the_lean_is_that_of_a_pendulum_under_the_device_s_loads() -> None:
    """Motion kept: moments summed by hand, another integrator; the device hangs behind. Both ways start alike."""
    result = found()
    frame, lean = result.frame, of("lean forwards about the ankles by the device", "whole body")
    time, height = result.arms[0].simulation.motion.time, 1.741
    middle = np.mean([each.simulation.motion.shoulder for each in result.arms], axis=(0, 1)) * [0.0, 1.0, 1.0]
    first = frame.origin[0] + frame.rotation[0].T @ middle
    ankle = first - [0.0, (0.818 - 0.039) * height, 0.0]
    moment = np.zeros(len(time))
    for arm in result.arms:
        for load in loads_in_laboratory(arm.simulation, frame).values():
            about = np.cross(load.place - ankle, load.force) + load.moment
            moment += np.sum(frame.rotation[:, 0] * about, axis=1)
    length = 0.961 * height
    inertia, toppling = 82.0 * length**2 / 3.0, 82.0 * 9.80665 * 0.5 * length
    rest = 0.5 * toppling
    damping = 2.0 * 0.7 * np.sqrt(inertia * rest)

    def rates(t: float, x: np.ndarray) -> list[float]:
        return [x[1], (np.interp(t, time, moment) - rest * x[0] - damping * x[1]) / inertia]

    start = [moment[0] / rest, 0.0]
    swung = solve_ivp(rates, time[[0, -1]], start, "LSODA", time, rtol=1e-8, atol=1e-10, max_step=0.01).y[0]
    np.testing.assert_allclose(lean["motion kept"], swung, atol=1e-5)
    assert np.degrees(lean["motion kept"][0]) == pytest.approx(-0.22, abs=0.01)
    assert lean["torque kept"][0] == lean["motion kept"][0] == pytest.approx(moment[0] / rest, rel=1e-3)


def test_the_back_of_a_still_trunk_that_leans_by_20_degrees_carries_weights_times_levers() -> None:
    """De Leva's man of 80 kg without arms: 0.4346 of the mass 0.4486 of the way down, head 0.0694, 0.4 above."""
    along = np.array([np.sin(np.radians(20.0)), np.cos(np.radians(20.0)), 0.0])
    hips = np.zeros((9, 3))
    trunk = Trunk(np.arange(9.0), hips, hips + 0.5 * along, np.tile([0.0, 0.0, -1.0], (9, 1)))
    needs = back_needs(trunk, [], mass=80.0, segments=body_segments("male"), gravity=np.array([0.0, -9.81, 0.0]))
    lever = 0.4346 * 0.5 * (1.0 - 0.4486) + 0.0694 * 0.5 * (1.0 + 0.4)
    assert extending_torque(trunk, needs) == pytest.approx(80.0 * 9.81 * lever * np.sin(np.radians(20.0)))
