"""Synthetic measurements of a shoulder exoskeleton, by code of its own and a cuff of many cells.

The package's model has one sphere in the cuff; here the arm is a cylinder that presses cell by cell (8 along, 22
around) against a padded tube, so that it also tilts and turns in it. The equations come from Jacobians in numbers
(`benchmarks.shoulder.cells`), the steps from SciPy's BDF. What is withheld from the model is planted one by one: see
`Withheld`. Nothing here was measured.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from benchmarks.shoulder.cells import Bodies, equations, frames_of, pressed_cells, stops_of
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.device import JOINTS, Device, Wearer

ALONG, AROUND = 8, 22
"""Cells of the cuff; one is as large as a cell of the mat, 14 mm by 14 mm on a radius of 50 mm."""
LOGGER = (0.5, 0.04, 50.0)
"""Step of the logger's angle [deg], its lag [s] and rate [Hz]; invented."""
MAT = (0.25, 0.3)
"""Noise of the mat's force (standard deviation) and its step [N]; invented."""
SETTLING = 0.3
"""N m s/rad; damping of the joints while the arm comes to rest before a trial."""
SLOW = 0.02
"""rad/s below which the seal's friction is viscous."""


@dataclass(frozen=True)
class Withheld:
    """What the truth has and the model has not; nothing by default. All sizes are invented.

    Parameters
    ----------
    push
        Share of the tool's push force that presses the arm into the armrest while the tool runs [-].
    gap
        Play of the arm in the cuff: poor contact [m].
    strap
        Depth by which the strap pulls the arm into the pad all around, which the mat shows at zero elevation [m].
    seal
        Dry friction of the cylinder's seals about the active axis, which shows when the arm turns round [N m].
    """

    push: float = 0.0
    gap: float = 0.0
    strap: float = 0.0
    seal: float = 0.0


NOTHING = Withheld()


@dataclass(frozen=True, eq=False)
class Measured:
    """What logger and mat show, and what is exactly so.

    Parameters
    ----------
    time
        [s], at the motion's frames.
    angles
        True ones of `JOINTS` (t, 3) [rad].
    logger
        Elevation of the exoskeleton's arm as logged [rad].
    cells
        Pressure of the armrest's cells (t, ALONG, columns) [Pa], the mat under the arm.
    force
        What these press the arm up with [N]: exact.
    mat
        The same as measured, with noise and steps [N].
    normal, shear
        Exact sum of all cells' normal forces [N], and of their shear on the arm along the cuff and around it (t, 2)
        [N], as a two-axis mat all around the arm shows them; None where nobody made them.
    """

    time: np.ndarray
    angles: np.ndarray
    logger: np.ndarray
    cells: np.ndarray
    force: np.ndarray
    mat: np.ndarray
    normal: np.ndarray | None = None
    shear: np.ndarray | None = None


class Truth:
    """The arm of a device on a wearer; right side."""

    def __init__(self, device: Device, wearer: Wearer, level: float, withheld: Withheld = NOTHING) -> None:
        d = self.device = device
        self.withheld = withheld
        self.axes = np.array([d.axis(joint) for joint in JOINTS])
        self.base = np.array([-d["bar_share"] * wearer.shoulder_width, 0.0, 0.0])
        self.links = np.array([d.link(1), d.link(2)])
        self.cuff = np.array([d["cuff_x"], 0.0, -d["armrest_share"] * wearer.upper_arm])
        self.push = level * 0.25 * np.pi * d["bore"] ** 2 * d["supply"]
        self.range = np.array([[d[f"{joint}_{end}"] for joint in JOINTS] for end in ("lower", "upper")])
        self.stops = np.array([d[f"stop_{name}"] for name in ("stiffness", "width", "damping")])
        self.damping = np.array([d[f"{joint}_damping"] for joint in JOINTS])
        arm, cylinder = d["arm_mass"], d["cylinder_mass"]
        centre = -(arm * d["arm_centre"] + cylinder * d["cylinder_centre"]) / (arm + cylinder)
        self.masses = np.array([d["link_1_mass"], d["link_2_mass"], arm + cylinder])
        self.centres = np.array([self.links[0] / 2, self.links[1] / 2, [0.0, 0.0, centre]])
        spread = arm * (d["arm_gyration"] ** 2 + (d["arm_centre"] + centre) ** 2)
        spread += cylinder * (d["cylinder_centre"] + centre) ** 2
        inertias = [
            *(m / 12.0 * (v @ v * np.eye(3) - np.outer(v, v)) for m, v in zip(self.masses, self.links, strict=False)),
            np.diag([spread, spread, arm * d["arm_twist_gyration"] ** 2]),
        ]
        self.inertias = np.array(inertias)
        self.mu = np.array([d["mu_s"], d["mu_k"]])
        self.s = (np.arange(ALONG) + 0.5) / ALONG * d["cuff_length"] - 0.5 * d["cuff_length"]
        angle = 2.0 * np.pi * (np.arange(AROUND) + 0.5) / AROUND
        self.around = np.column_stack([np.cos(angle), np.sin(angle)])  # medial, raising
        self.k, self.b = (4.0 * d[name] / (ALONG * AROUND) for name in ("k", "b"))

    def frames(self, q: np.ndarray) -> Bodies:
        """Rotations (3, 3, 3), joints' places (3, 3) and axes (3, 3) in the device's frame."""
        return frames_of(q, self.axes, self.base, self.links)

    def rates(self, state: np.ndarray, w: dict[str, np.ndarray]) -> np.ndarray:
        """Derivative of (q, u, force of the cylinder)."""
        q, u, force = state[:3], state[3:6], state[6]
        frames = self.frames(q)
        mass, bias = equations(frames, u, w["gravity"], self.centres, self.masses, self.inertias)
        joint = -self.damping * u + stops_of(q, u, self.range, self.stops) + self.contact(frames, u, w)[0]
        joint[2] += force * self._lever(q[2]) - self.withheld.seal * np.tanh(u[2] / SLOW)
        lag = (self.push * w["factor"] - force) / self.device["lag"]
        return np.concatenate([u, np.linalg.solve(mass, joint - bias), [lag]])

    def contact(
        self, frames: Bodies, u: np.ndarray, w: dict[str, np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Torque of the arm on each joint [N m], normal force at each cell (a, b) [N], shear along and around [N]."""
        d, more = self.device, self.withheld
        law = (0.5 * d["cuff_length"], d["cuff_radius"], more.strap - more.gap, d["delta_full"], self.k, self.b)
        arm = (w["place"], w["rate"], w["along"], w["along_rate"])
        cuff = (self.cuff, self.s, self.around)
        return pressed_cells(frames, u, arm, cuff, np.array([*law, *self.mu, d["v_th"]]), float(w["pressed"]))

    def _lever(self, angle: float) -> float:
        a, b, turned = self.device["lever_a"], self.device["lever_b"], self.device["lever_phase"] + angle
        return float(a * b * np.sin(turned) / np.sqrt(a * a + b * b - 2.0 * a * b * np.cos(turned)))


def measure(
    truth: Truth,
    motion: ArmMotion,
    seed: int,
    pushing: np.ndarray | None = None,
    factor: np.ndarray | None = None,
) -> Measured:
    """What logger and mat of a right arm record along a motion; `pushing` is the force on the tool [N]."""
    time, rng = motion.time, np.random.default_rng(seed)
    along = motion.interface - motion.shoulder
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    place, line = CubicSpline(time, motion.interface), CubicSpline(time, along)
    gravity = CubicSpline(time, motion.gravity_at_frames())
    pressed = np.zeros(len(time)) if pushing is None else truth.withheld.push * pushing / truth.device["k"]
    factors = np.ones(len(time)) if factor is None else factor
    speed, turn = place.derivative(), line.derivative()

    @lru_cache(maxsize=1)  # the columns of a Jacobian are all of one time
    def inputs(t: float) -> dict[str, np.ndarray]:
        d = line(t)
        return {
            "place": place(t),
            "rate": speed(t),
            "along": d / np.linalg.norm(d),
            "along_rate": turn(t),
            "gravity": gravity(t),
            "pressed": np.interp(t, time, pressed),
            "factor": np.interp(t, time, factors),
        }

    start = _at_rest(truth, inputs(time[0]))
    found = solve_ivp(
        lambda t, x: truth.rates(x, inputs(t)), time[[0, -1]], start, "BDF", time, rtol=1e-5, atol=1e-6, max_step=0.01
    )
    if not found.success:
        raise ArithmeticError(f"the truth cannot be stepped: {found.message}")
    angles = found.y[:3].T
    under = truth.around[:, 1] < 0.0
    cells = np.empty((len(time), ALONG, int(under.sum())))
    force, normal, shear = np.empty(len(time)), np.empty(len(time)), np.empty((len(time), 2))
    for k, t in enumerate(time):
        _, pressing, shear[k] = truth.contact(truth.frames(angles[k]), found.y[3:6, k].copy(), inputs(t))
        normal[k] = pressing.sum()
        cells[k] = pressing[:, under] / _cell_area(truth)
        force[k] = float((pressing[:, under] * -truth.around[under, 1]).sum())
    mat = np.round((force + rng.normal(0.0, MAT[0], len(time))) / MAT[1]) * MAT[1]
    logger = _logged(time, angles[:, 2])
    return Measured(time, angles, logger, cells, force, np.maximum(mat, 0.0), normal, shear)


def _at_rest(truth: Truth, w: dict[str, np.ndarray]) -> np.ndarray:
    """Let it come to rest around an arm that is held, from the arm link along the human arm; nothing rubs meanwhile."""
    still = w | {"rate": np.zeros(3), "along_rate": np.zeros(3)}
    to = w["place"] - truth.base - truth.links.sum(axis=0)
    start = np.concatenate([[0.0, 0.0, np.arctan2(-to[1], -to[2])], np.zeros(3), [truth.push * w["factor"]]])
    own = truth.damping, truth.mu
    truth.damping, truth.mu = np.full(3, SETTLING), np.zeros(2)
    settled = solve_ivp(lambda _, x: truth.rates(x, still), (0.0, 12.0), start, "BDF", rtol=1e-6, atol=1e-7)
    truth.damping, truth.mu = own
    state = settled.y[:, -1]
    state[3:6] = 0.0
    return np.asarray(state)


def _logged(time: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """First-order lag, samples at the logger's rate that are held, steps."""
    step, lag, rate = np.radians(LOGGER[0]), LOGGER[1], LOGGER[2]
    late = np.empty(len(time))
    late[0] = angle[0]
    for k in range(1, len(time)):
        share = 1.0 - np.exp(-(time[k] - time[k - 1]) / lag)
        late[k] = late[k - 1] + share * (angle[k] - late[k - 1])
    taken = np.floor((time - time[0]) * rate + 1e-9) / rate + time[0]
    return np.round(np.interp(taken, time, late) / step) * step


def _cell_area(truth: Truth) -> float:
    return float(truth.device["cuff_length"] / ALONG * 2.0 * np.pi * truth.device["cuff_radius"] / AROUND)
