"""Exact markers of a stance whose socket gives, by matrices alone: neither the package's tree nor its fit is in them.

Pelvis: turns about y, x and z, then hip and knee as chains of 4 x 4 matrices after the definitions of the angles; the
socket's displacement, three Cardan angles x, y, z and three shifts, stands between the limb and the socket's markers.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import make_interp_spline

from geocontact.below_knee_prosthesis.from_markers import BODIES, hip_by_regression
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.below_knee_prosthesis.simulate import Stance, simulate_stance
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Marker
from meshes.gait_course import course
from meshes.gait_persons import PARTICIPANTS, SPINES, marker_places, true_leg

BELOW, EVERY = 0.03, 5
"""m; of the keel's axis above the sole. Which sample of a stance at 500 Hz cameras take."""


def planted_stance(fulcrum: float, lasting: float, foot: VariableStiffnessFoot | None = None) -> Stance:
    """Of a leg with its markers and the hip where the regression puts it, along an invented course."""
    foot = vsf_foot() if foot is None else foot
    leg = replace(true_leg(PARTICIPANTS[0], BELOW), hip=hip_by_regression({k: np.array(v) for k, v in SPINES.items()}))
    places = marker_places(leg, foot.keel.length)
    leg = replace(leg, markers=tuple(Marker(n, b, places[b][n]) for b, names in BODIES.items() for n in names))
    driven = course(leg, vsf_foot(), fulcrum, lasting)
    motion = replace(driven.motion, leg=leg)
    return simulate_stance(motion, foot, fulcrum, driven.push, driven.span, machine_code=False)


def markers_of(stance: Stance) -> MarkerTrajectories:
    """What cameras without any error see of a stance, every fifth sample."""
    leg, frames = stance.motion.leg, slice(None, None, EVERY)
    time = stance.time[frames]
    values = make_interp_spline(stance.motion.time, stance.motion.values, k=5)(time)
    values[:, 3:5] = stance.found.q[frames, :2]
    rows = [body_places(leg, q, socket) for q, socket in zip(values, stance.found.q[frames, 2:8], strict=True)]
    names = tuple(rows[0])
    return MarkerTrajectories(time, np.array([[row[name] for name in names] for row in rows]), names, "exact")


def body_places(leg: Leg, q: np.ndarray, socket: np.ndarray) -> dict[str, np.ndarray]:
    """Of all markers at coordinates of pelvis (rotation, list, tilt, x, y, z), hip (3) and knee, and of the socket."""
    pelvis = shift(q[3:6]) @ turn("y", q[0]) @ turn("x", q[1]) @ turn("z", q[2])
    thigh = pelvis @ shift(leg.hip) @ turn("z", q[6]) @ turn("x", q[7]) @ turn("y", q[8])
    shank = thigh @ shift(np.array([0.0, -leg.thigh, 0.0])) @ turn("z", -q[9])
    keel = np.eye(4)
    keel[:3, :3] = leg.turn.as_matrix()
    bushing = shift(leg.bushing) @ keel
    given = shift(socket[3:]) @ turn("x", socket[0]) @ turn("y", socket[1]) @ turn("z", socket[2])
    of = {"pelvis": pelvis, "thigh": thigh, "shank": shank @ bushing @ given @ np.linalg.inv(bushing)}
    return {m.name: (of[m.body] @ np.append(m.location, 1.0))[:3] for m in leg.markers}


def shift(by: np.ndarray) -> np.ndarray:
    """A matrix that shifts."""
    found = np.eye(4)
    found[:3, 3] = by
    return found


def turn(axis: str, angle: float) -> np.ndarray:
    """A matrix that turns about x, y or z, counterclockwise seen from the axis' tip [rad]."""
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    found = np.eye(4)
    found[i, i] = found[j, j] = np.cos(angle)
    found[j, i] = np.sin(angle)
    found[i, j] = -np.sin(angle)
    return found
