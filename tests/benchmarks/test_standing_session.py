"""The laboratory of the nine trials: mats press what the strap does, markers are 56, a foot with toes stands."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from benchmarks.standing.nine_truth import PLANTED, chain_with_toes, finer_model
from benchmarks.standing.session import (
    FURTHER_MATS,
    MARKERS,
    MATS,
    PRELOAD,
    Session,
    marked,
    pressed,
    session_of,
    write_mat_of,
)
from geocontact.standing_up.chain import Subject
from tests.cli.calls import MESHES

SUBJECT = Subject()


def test_mats_are_pressed_by_the_difference() -> None:
    """Neither pulls, both are pressed without a strap's force, and their difference is the strap's."""
    strap = np.linspace(-60.0, 60.0, 13)
    front, behind = (pressed(strap, theta) for _, _, theta in MATS)
    np.testing.assert_allclose(behind - front, strap, atol=1e-12)
    assert min(front.min(), behind.min()) > 0.0 and front[6] == pytest.approx(PRELOAD)


def test_a_session_holds_its_trials() -> None:
    """Spans have the trials' own samples, and what lies between goes on without a jump."""
    truth = {}
    for name, count in (("T1", 101), ("P1", 121)):
        part = np.linspace(0.0, 1.0, count)
        truth |= {f"{name} time": part, f"{name} strap": np.sin(2.0 * part)}
        truth |= {f"{name} {what}": np.outer(np.cos(part), np.ones(2)) for what in ("q", "force", "centre", "torque")}
    session = session_of(truth)
    for name, (begin, end) in session.spans.items():
        inside = (session.time > begin - 1e-9) & (session.time < end + 1e-9)
        np.testing.assert_array_equal(session.channels["strap"][inside, 0], truth[f"{name} strap"])
    assert np.abs(np.diff(session.channels["strap"][:, 0])).max() < 0.06


def test_markers_and_toes() -> None:
    """56 markers; with the foot in the air the whole weight falls, and the toes are pulled back by their spring."""
    from casadi import Function

    assert sum(MARKERS.values()) == len(marked(SUBJECT, 34).markers) == 56
    model = finer_model(SUBJECT)
    e = model.equations
    assert e.names[-1] == "toe_joint" and len(model.joints) == 6
    balance = Function("balance", [e.q, e.u, e.a, e.w, e.p], [e.balance])
    q, still = np.zeros(10), np.zeros(10)
    q[1], q[9] = 3.0, 0.1
    found = balance(q, still, still, np.zeros(6), PLANTED).full().ravel()
    assert found[1] == pytest.approx(-9.81 * chain_with_toes(SUBJECT).mass, rel=1e-9)
    assert -5.0 < found[9] < -3.0


@pytest.mark.slow
@pytest.mark.parametrize("scan", ["thigh", pytest.param("torso", marks=pytest.mark.long)])
def test_the_mat_pipeline_finds_the_strap(tmp_path: Path, scan: str) -> None:
    """Mats in front and behind, each registered to the segment by its landmarks: within 1 N of the strap's force."""
    time = np.linspace(0.0, 2.0, 201)
    strap = 30.0 * np.sin(np.pi * time)
    mats = MATS if scan == "thigh" else FURTHER_MATS[{"torso": "pelvis"}.get(scan, scan)]
    session = Session(time, {}, {mats.channel: strap[:, None]})
    total, at = np.zeros(0), np.zeros(0)
    for name, mat, theta in mats:
        (tmp_path / name).mkdir()
        write_mat_of(tmp_path / name, session, mat, theta, 1, mats)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", gc.InputWarning)
            found = gc.mat(
                tmp_path / name / "mat.csv",
                surface=MESHES / f"{scan}.stl",
                unit="mm",
                landmarks=tmp_path / name / "landmarks.csv",
                layout=tmp_path / name / "layout.toml",
            ).table("wrench")
        at = found["time [s]"].to_numpy()
        total = found["fx [N]"].to_numpy() + (total if len(total) else 0.0)
    off = total - np.interp(at, time, strap)
    assert np.sqrt(np.mean(off**2)) < 1.0 and np.abs(total).max() > 25.0
