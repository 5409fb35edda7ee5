"""Synthetic measurements of a variable-stiffness foot, by code of its own: a continuous keel on dense foam.

The package's keel has 8 hinges and 24 spheres; here the overhang is an elastica in many pieces, and the sole is foam in
rows 2 mm apart, all in the sagittal plane, without inertia and without friction along the floor. Each instant is solved
by Newton's steps on the curvatures. What is withheld from the models is planted one by one: see `Withheld`. Nothing
here was measured.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.sole import ZONES, numbers
from geocontact.contact.bushing import CREEP, TRANSLATION
from geocontact.identify.signals.filters import zero_lag

PIECES, PITCH = 24, 2e-3
"""Of the overhang, and distance of the foam's rows [m]."""
PRESLIDING = 0.05
"""1/m; curvature over which the keel's friction turns."""
TOLERANCE, TURNS = 1e-7, 60
"""1/m, of the curvatures; Newton's steps at most."""
SMALL = 1e-6
"""1/m; step of the differences."""
GATE = 20.0
"""N; below it a plate gives no centre of pressure."""
PLACE, TURN = 0.15e-3, np.radians(0.08)
"""m and rad; noise of the foot's place and pitch as a cluster of five markers tells them, cameras 0.3 mm; invented."""
EVERY, CUTOFF = 5, 15.0
"""Which instant is recorded, and the low-pass of the markers [Hz]."""
FORCE, COUPLE, OFFSET = 2.0, 0.5, 1.0
"""N, N m, N; noise of a plate's sample, of its couple, and its constant error; invented."""


@dataclass(frozen=True)
class Withheld:
    """What the truth has and the models have not; nothing by default. All sizes are invented but the socket's.

    Parameters
    ----------
    hysteresis
        Friction in the keel, a share of its elastic moment [-].
    pistoning
        Whether the markers are on the residual limb, above a socket that gives as the study prints.
    fulcrum
        How much nearer to the toes it is than told [m].
    """

    hysteresis: float = 0.0
    pistoning: bool = False
    fulcrum: float = 0.0


NOTHING = Withheld()


@dataclass(frozen=True, eq=False)
class FootPath:
    """Where the keel's frame is in the plane, at even times: x, y [m], pitch [rad] (t, 3)."""

    time: np.ndarray
    pose: np.ndarray


@dataclass(frozen=True, eq=False)
class Measured:
    """What is seen and what is exactly so.

    Parameters
    ----------
    path
        Of the foot by markers; where these are on the limb, that of a foot on a socket that does not give.
    load, centre
        True upward force [N] and centre of pressure along the ground [m], NaN off the floor.
    plate
        Forward and upward force [N] and centre of pressure along the ground [m] as measured (t, 3).
    """

    path: FootPath
    load: np.ndarray
    centre: np.ndarray
    plate: np.ndarray


class Truth:
    """A keel that bends everywhere, on foam: numbers of a foot of many hinges and spheres, at a fulcrum [m]."""

    def __init__(
        self, foot: VariableStiffnessFoot, fulcrum: float, withheld: Withheld = NOTHING, pieces: int = PIECES
    ) -> None:
        keel: Keel = foot.keel
        self.withheld, self.bending = withheld, keel.bending
        start = fulcrum + withheld.fulcrum
        self.root = start / 3.0 / keel.bending  # pinned end
        self.piece = (keel.length - start) / pieces
        self.at = start + self.piece * (np.arange(pieces) + 0.5)
        value = {name: number.value for name, number in numbers().items()}
        self.radius, self.down = value["radius"], value["below"] - value["radius"]
        self.full = foot.law.full_depth
        ends = np.concatenate([[start], start + self.piece * np.arange(1, pieces + 1)])
        self.ends = ends
        rows, stiffness, damping = [], [], []
        for zone, (a, b, _) in ZONES.items():
            count = round((b - a) / PITCH)
            own = foot.sole.spheres.zones[zone]
            rows.append(a + (b - a) * (np.arange(count) + 0.5) / count)
            stiffness.append(np.full(count, foot.law.stiffness[own].sum() / count))
            damping.append(np.full(count, foot.law.damping[own].sum() / count))
        self.rows, self.k, self.b = (np.concatenate(each) for each in (rows, stiffness, damping))

    def centres(self, curvature: np.ndarray, root: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places of the foam's rows (n, rows, 2) and of the pieces' middles (n, pieces + 1, 2), fulcrum first, in K."""
        turn = root[:, None] + np.cumsum(self.piece * curvature, axis=1)
        middle = turn - 0.5 * self.piece * curvature
        steps = self.piece * np.stack([np.cos(middle), np.sin(middle)], axis=-1)
        start = np.array([self.ends[0], 0.0])
        nodes = start + np.concatenate([0.0 * steps[:, :1], np.cumsum(steps, axis=1)], axis=1)
        k = np.clip(np.searchsorted(self.ends, self.rows, side="right") - 1, -1, len(self.at) - 1)
        held = k < 0
        own = np.where(held, 0.0, middle[:, k])
        along = self.rows - self.ends[np.maximum(k, 0)]
        tangent, normal = (
            np.stack(each, axis=-1) for each in ((np.cos(own), np.sin(own)), (-np.sin(own), np.cos(own)))
        )
        base = np.where(held[:, None], np.stack([self.rows, 0.0 * self.rows], axis=-1), nodes[:, np.maximum(k, 0)])
        place = base + np.where(held, 0.0, along)[:, None] * tangent - self.down * normal
        return place, np.concatenate([nodes[:, :1], 0.5 * (nodes[:, 1:] + nodes[:, :-1])], axis=1)

    def pressed(
        self, x: np.ndarray, pose: np.ndarray, before: np.ndarray, step: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Forces of the rows [N], their x from K's origin in the ground, moments about root and middles, depths."""
        place, nodes = self.centres(x[:, 1:], x[:, 0])
        s, c = np.sin(pose[2]), np.cos(pose[2])
        depth = self.radius - (pose[1] + s * place[..., 0] + c * place[..., 1])
        rate = (depth - before) / step
        u = np.clip(depth / self.full, 0.0, 1.0)
        force = np.where(depth > 0.0, self.k * depth + self.b * np.maximum(rate, 0.0) * u * u * (3.0 - 2.0 * u), 0.0)
        across = c * place[..., 0] - s * place[..., 1]
        joint = c * nodes[..., 0] - s * nodes[..., 1]
        behind = self.rows[None, :] < np.concatenate([self.ends[:1], self.at])[:, None]
        arms = np.where(behind, 0.0, across[:, None, :] - joint[:, :, None])
        return force, across, np.einsum("nij,nj->ni", arms, force), depth

    def solve(self, path: FootPath) -> tuple[np.ndarray, np.ndarray]:
        """Upward force [N] and centre of pressure from the origin along the ground [m], NaN off it, along a path."""
        n = len(self.at) + 1
        x, friction, last = np.zeros(n), np.zeros(n - 1), np.zeros(n - 1)
        step = float(path.time[1] - path.time[0])
        before = np.full(len(self.rows), -1.0)
        load, centre = np.zeros(len(path.time)), np.full(len(path.time), np.nan)
        steps = np.vstack([np.zeros(n), SMALL * np.eye(n)])
        for i, pose in enumerate(path.pose):
            for turn in range(TURNS):
                tried = x + steps
                off = tried - self._bent(tried, self.pressed(tried, pose, before, step)[2], last, friction)
                slope = (off[1:] - off[0]).T / SMALL
                move = np.linalg.solve(slope, -off[0])
                x = x + move * (1.0 if turn < TURNS // 2 else 0.5)
                if np.abs(move).max() < TOLERANCE:
                    break
            else:
                raise ArithmeticError(f"the foot has no equilibrium at {path.time[i]:.3f} s")
            force, across, _, before = (each[0] for each in self.pressed(x[None], pose, before, step))
            friction, last = self._friction(x[1:], last, friction), x[1:].copy()
            load[i] = force.sum()
            if load[i] > 0.0:
                centre[i] = float(force @ across) / load[i]
        return load, centre

    def _friction(self, curvature: np.ndarray, last: np.ndarray, friction: np.ndarray) -> np.ndarray:
        """Share of the full friction, -1 to 1, which turns over `PRESLIDING` of curvature."""
        moved = curvature - last
        return np.sign(moved) + (friction - np.sign(moved)) * np.exp(-np.abs(moved) / PRESLIDING)

    def _bent(self, x: np.ndarray, moment: np.ndarray, last: np.ndarray, friction: np.ndarray) -> np.ndarray:
        """Turn of the root and curvatures that these moments make."""
        share = self._friction(x[:, 1:], last, friction)
        rubbing = self.withheld.hysteresis * share * self.bending * np.abs(x[:, 1:])
        return np.hstack([self.root * moment[:, :1], (moment[:, 1:] - rubbing) / self.bending])


def measure(truth: Truth, path: FootPath, seed: int) -> Measured:
    """What markers and plate show along a path of the foot, at every `EVERY`th of its times."""
    rng, kept = np.random.default_rng(seed), slice(None, None, EVERY)
    load, across = truth.solve(path)
    limb = path.pose.copy()
    if truth.withheld.pistoning:
        given = given_way(load * np.cos(limb[:, 2]), float(path.time[1] - path.time[0]))
        limb[:, :2] -= given[:, None] * np.column_stack([-np.sin(limb[:, 2]), np.cos(limb[:, 2])])
    time, shown, load, place = path.time[kept], limb[kept], load[kept], path.pose[kept, 0] + across[kept]
    noise = zero_lag(rng.standard_normal(shown.shape) * (PLACE, PLACE, TURN), float(time[1] - time[0]), CUTOFF)
    up, forward = (rng.normal(0.0, FORCE, len(time)) + rng.normal(0.0, OFFSET) for _ in range(2))
    up += load
    seen = np.where(up >= GATE, place + rng.normal(0.0, COUPLE, len(time)) / np.maximum(up, GATE), np.nan)
    return Measured(FootPath(time, shown + noise), load, place, np.column_stack([forward, up, seen]))


def given_way(load: np.ndarray, step: float, stiffness: float = TRANSLATION, damping: float = CREEP) -> np.ndarray:
    """How far a socket gives under a load along the limb [m]: k q + c q' = load, exact for a load linear in a step."""
    given, rate = np.zeros(len(load)), np.exp(-stiffness / damping * step)
    mean = 0.5 * (load[1:] + load[:-1]) / stiffness
    for i in range(1, len(load)):
        given[i] = mean[i - 1] + (given[i - 1] - mean[i - 1]) * rate
    return given
