"""What a laboratory records of the nine trials: 56 markers on soft tissue, plates, encoders, motors, and two mats.

All trials are one session on one clock, and the study's trials are spans of it. Between them postures go over into each
other; nothing of that is used. Markers move over the bone with the flexion of the joint next to them, each cluster as
one and each marker by itself, which no inverse kinematics undoes; the foremost ones are on the toes. Mats of the
geometry of `meshes/mat_thigh_16x8` lie in front of the thigh and behind it, and the strap's force is the difference of
what the two press. Motors give what the exoskeleton needs and overcome friction. All sizes are invented.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.shoulder.mat import with_noise
from benchmarks.standing.nine_truth import chain_with_toes, friction
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Marker, Multibody
from geocontact.dynamics.tree import tree_of
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.osim_writer import write_osim
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS, coupled_chain
from meshes.mat_files import landmarks
from meshes.mat_placement import SHANK_MAT, THIGH_MAT, TORSO_MAT, Mat
from meshes.mat_recordings import SOFT, Recording
from meshes.moving_pressure import Footprint, resultant
from meshes.segments import SHANK, THIGH, TORSO

RATE, MAT_RATE = 100.0, 50.0
BESIDE, BETWEEN = 0.4, 0.6
"""Of a trial that is continued on either side, and from there to the next one [s]."""
PRELOAD = 15.0
"""Of either mat where the strap's force is 0 [N]."""
BACK_MAT = Mat("mat_thigh_behind_16x8", THIGH, 16, 8, theta=np.pi, y=20.0, turn=0.0)
CALF_MAT = Mat("mat_calf_16x8", SHANK, 16, 8, theta=np.pi, y=0.0, turn=0.0)
LOIN_MAT = Mat("mat_loin_32x8", TORSO, 32, 8, theta=np.pi, y=-40.0, turn=np.radians(86.0))
MARKERS = {"foot": 8, "toes": 2, "shank": 12, "thigh": 16, "trunk": 18}
"""How many there are on the segments of both sides."""
ARTEFACT = {"foot": 1.0, "toes": 1.0, "shank": 5.0, "thigh": 10.0, "trunk": 6.0}
"""Displacement over the bone at a flexion of 90 degrees [mm]."""
LENGTHS = {"foot": 0.12, "toes": 0.05, "shank": 0.40, "thigh": 0.38, "trunk": 0.45}
FLEXED = {"foot": "ankle", "toes": "ankle", "shank": "knee", "thigh": "knee", "trunk": "hip"}
SEEN = 0.3
"""Noise of a marker [mm]."""
NOISES = {"force": 2.0, "centre": 1e-3, "encoder": np.radians(0.1), "chair": 0.5, "motor": 0.3}


@dataclass(frozen=True)
class MatsOfASite:
    """In front and behind, and the pads that press on them.

    Parameters
    ----------
    channel
        Of the truth.
    middle
        Of the pads above the middle of the scan [mm].
    along, across
        Half-lengths of the pads [mm].
    """

    channel: str
    front: Mat
    behind: Mat
    middle: float
    along: float
    across: float

    def __iter__(self) -> Iterator[tuple[str, Mat, float]]:
        return iter((("front", self.front, 0.0), ("behind", self.behind, np.pi)))


MATS = MatsOfASite("strap", THIGH_MAT, BACK_MAT, 8.0, 55.0, 42.0)
FURTHER_MATS = {
    "shank": MatsOfASite("shank strap", SHANK_MAT, CALF_MAT, 0.0, 55.0, 34.0),
    "pelvis": MatsOfASite("pelvis strap", TORSO_MAT, LOIN_MAT, -38.0, 40.0, 60.0),
}
"""By site; the folders of their mats are called shank_front and so on."""


@dataclass(frozen=True, eq=False)
class Session:
    """Everything on one clock, without noise.

    Parameters
    ----------
    spans
        Begin and end of each trial [s].
    channels
        By name, as the truth has them.
    """

    time: np.ndarray
    spans: Mapping[str, tuple[float, float]]
    channels: Mapping[str, np.ndarray]


def session_of(truth: Mapping[str, np.ndarray]) -> Session:
    """One trial after the other, each continued by its own reflection so that filters see no jump."""
    names = [key.split()[0] for key in truth if key.endswith(" time")]
    beside, between = round(BESIDE * RATE), round(BETWEEN * RATE)
    parts: dict[str, list[np.ndarray]] = {}
    spans, at = {}, 0
    for name in names:
        count = len(truth[f"{name} time"])
        spans[name] = ((at + beside) / RATE, (at + beside + count - 1) / RATE)
        at += count + 2 * beside + between
        further = [mats.channel for mats in FURTHER_MATS.values() if f"{name} {mats.channel}" in truth]
        sat_on = ["chair"] if f"{name} chair" in truth else []
        for what in ("q", "force", "centre", "torque", "strap", *further, *sat_on):
            own = truth[f"{name} {what}"].reshape(count, -1)
            before, after = 2 * own[0] - own[beside:0:-1], 2 * own[-1] - own[-2 : -2 - beside : -1]
            parts.setdefault(what, []).append(np.vstack([before, own, after]))
    rise = np.linspace(0.0, 1.0, between + 2)[1:-1, None]
    blend = 10 * rise**3 - 15 * rise**4 + 6 * rise**5
    joined = {}
    for what, pieces in parts.items():
        rows = []
        for k, piece in enumerate(pieces):
            to = pieces[k + 1][0] if k + 1 < len(pieces) else piece[-1]
            rows += [piece, piece[-1] + (to - piece[-1]) * blend]
        joined[what] = np.vstack(rows)
    return Session(np.arange(at) / RATE, spans, joined)


def marked(subject: Subject, seed: int) -> Multibody:
    """The finer chain with its markers where they are while nothing is flexed."""
    rng, chain, markers = np.random.default_rng(seed), chain_with_toes(subject), []
    for body, count in MARKERS.items():
        along = (np.arange(count) + 0.5) / count * LENGTHS[body]
        for k, place in enumerate(along):
            aside = 0.05 * rng.uniform(-1.0, 1.0)
            side = 0.1 * (1.0 if k % 2 else -1.0)
            lengthwise = body in ("foot", "toes")
            where = [place - 0.04 * (body == "foot"), aside - 0.03, side] if lengthwise else [aside, place, side]
            markers.append(Marker(f"{body}{k + 1}", body, np.array(where)))
    return replace(chain, markers=tuple(markers))


def trajectories(model: Multibody, session: Session, seed: int) -> MarkerTrajectories:
    """Markers on soft tissue, with noise [m]."""
    from casadi import SX, Function, vertcat

    rng, tree = np.random.default_rng(seed), tree_of(model)
    moved = SX.sym("moved", 3, len(model.markers))
    points = [tree.point(m.body, SX(m.location) + moved[:, k]) for k, m in enumerate(model.markers)]
    place = Function("place", [tree.q, moved], [vertcat(*points)]).map(len(session.time))
    q, names = session.channels["q"], tree.names
    ways = {body: _direction(rng) for body in MARKERS}
    shift = np.zeros((len(q), len(model.markers), 3))
    for k, m in enumerate(model.markers):
        flexed = np.abs(q[:, names.index(FLEXED[m.body])]) / (0.5 * np.pi)
        way = (ways[m.body] + _direction(rng)) / np.sqrt(2.0)
        shift[:, k, :2] = 1e-3 * ARTEFACT[m.body] * flexed[:, None] * way
    seen = place(q.T, np.hstack(list(shift.swapaxes(1, 2)))).full().T.reshape(len(q), -1, 3)
    seen = seen + 1e-3 * SEEN * rng.normal(size=seen.shape)
    return MarkerTrajectories(session.time, seen, tuple(m.name for m in model.markers))


def _direction(rng: np.random.Generator) -> np.ndarray:
    turn = rng.uniform(0.0, 2.0 * np.pi)
    return np.array([np.cos(turn), np.sin(turn)])


def write_session(folder: Path, session: Session, subject: Subject, seed: int) -> None:
    """model.osim, markers.trc, plates.mot, encoders.sto, motors.sto, and a folder for each mat."""
    rng, finer = np.random.default_rng(seed), marked(subject, seed)
    on_foot = tuple(replace(m, body="foot", location=m.location + _ball(finer)) if m.body == "toes" else m
                    for m in finer.markers)  # fmt: skip
    write_osim(folder / "model.osim", replace(coupled_chain(subject), name="coupled", markers=on_foot))
    write_trc(folder / "markers.trc", trajectories(finer, session, seed))
    c, time, none = session.channels, session.time, np.zeros(len(session.time))
    force = c["force"] + NOISES["force"] * rng.normal(size=c["force"].shape)
    centre = c["centre"][:, 0] + NOISES["centre"] * rng.normal(size=len(time))
    columns = [force[:, 0], force[:, 1], none, centre, none, none, none, none, none]
    kinds = [*(f"force_v{x}" for x in "xyz"), *(f"force_p{x}" for x in "xyz"), *(f"torque_{x}" for x in "xyz")]
    names = [f"feet_{kind}" for kind in kinds]
    if "chair" in c:
        fore, up, about = (c["chair"] + NOISES["chair"] * rng.normal(size=c["chair"].shape)).T
        columns += [fore, up, *([none] * 6), about]
        names += [f"chair_{kind}" for kind in kinds]
    write_storage(folder / "plates.mot", time, names, np.column_stack(columns),
                  title="synthetic plates", degrees=False)  # fmt: skip
    angles = c["q"][:, 6:9]
    rates = np.gradient(angles, 1.0 / RATE, axis=0)
    seen = angles + NOISES["encoder"] * rng.normal(size=angles.shape)
    write_storage(folder / "encoders.sto", time, EXO_JOINTS, np.degrees(seen), title="encoders", degrees=True)
    motors = c["torque"][:, 3:] + friction(rates) + NOISES["motor"] * rng.normal(size=rates.shape)
    write_storage(folder / "motors.sto", time, EXO_JOINTS, motors, title="motors", degrees=False)
    for site, mats in {"": MATS, **FURTHER_MATS}.items():
        if mats.channel not in c:
            continue
        for name, mat, theta in mats:
            own = folder / (f"{site}_{name}" if site else name)
            own.mkdir()
            write_mat_of(own, session, mat, theta, seed + len(site), mats)


def _ball(chain: Multibody) -> np.ndarray:
    joint = next(each for each in chain.joints if each.name == "toe_joint")
    return np.asarray(joint.parent_offset.translation)


def pressed(strap: np.ndarray, theta: float) -> np.ndarray:
    """Force by which one mat is pressed [N]: both never negative, their difference the strap's."""
    ahead = 1.0 if theta else -1.0  # what presses from behind pushes forwards
    return np.asarray(0.5 * (np.hypot(strap, 2.0 * PRELOAD) + ahead * strap))


def write_mat_of(folder: Path, session: Session, mat: Mat, theta: float, seed: int, mats: MatsOfASite = MATS) -> None:
    """mat.csv, layout.toml and landmarks.csv: a soft pad whose pressure is scaled to the force forwards."""
    one = Footprint(np.ones(1), np.array([[theta, mats.middle]]), mats.along, mats.across, SOFT)
    points, weights = mat.cell_points()
    cells = (one.pressure(mat.segment, points[None]) @ weights)[0]
    unit = abs(float(resultant(mat.segment, one, np.zeros(3)).force[0, 0]))
    time = np.arange(0.0, session.time[-1], 1.0 / MAT_RATE)
    force = pressed(np.interp(time, session.time, session.channels[mats.channel][:, 0]), theta)
    pressure = with_noise(1e3 * force[:, None, None] / unit * cells, seed + round(theta))
    names = [f"r{i}c{j} [kPa]" for i in range(mat.rows) for j in range(mat.columns)]
    table = pd.DataFrame(1e-3 * pressure.reshape(len(pressure), -1), columns=names)
    table.insert(0, "time [s]", time)
    table.round(4).to_csv(folder / "mat.csv", index=False)
    layout = f'rows = {mat.rows}\ncolumns = {mat.columns}\npitch_mm = {mat.pitch!r}\nunit = "kPa"\norder = "row"\n'
    (folder / "layout.toml").write_text(layout, encoding="utf-8")
    only = Recording(mat, time, (one,), 60.0, ())
    (folder / "landmarks.csv").write_text(landmarks(only), encoding="utf-8")
