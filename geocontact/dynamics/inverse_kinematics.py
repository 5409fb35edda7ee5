"""Coordinates of a tree from markers: weighted least squares frame by frame, each from where the last one ended.

Lu & O'Connor (1999), Bone position estimation from skin marker co-ordinates using global optimisation, J Biomech 32.
Newton's steps; the curvature, exact, is kept as long as they shrink fast, and damped after Levenberg and Marquardt
where they do not lead down. As in OpenSim a coordinate that is held counts beside the mean over the markers that are
seen in the frame: Σ w |x - observed|² / Σ w + v (q - wanted)². Coordinates that the model clamps stay within their
limits, locked ones at their default; those that depend on others follow them, and points that a constraint joins stay
together, to 0.1 mm. A marker that is not seen does not count in that frame. A direction of a body counts as a marker
does, from the body's origin: three of length a / √2 along its axes are 4 a² sin²(θ/2) away, which is a² θ² up to a part
θ²/12, where θ is the angle between the orientation recorded and the model's; OpenSim's tools have θ² itself. The search
begins where most markers are seen and goes from there to both ends. Coordinates that no frame tells stay at their
defaults, as few as are needed for all others to be determined. What the markers of a frame do not tell is not stated,
or filled where the gap is short.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.linalg import qr
from scipy.linalg.lapack import dpotrf, dpotrs

from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.data.multibody.model import Marker
from geocontact.dynamics.compiled import Buffered
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import Tree

Vector = Float[np.ndarray, " n"]
Target = tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, " m"], Vector, Vector]
"""Places [m] and weights of the markers, values wanted of the coordinates [rad, m] and their weights."""


TIGHT = 1e3
"""Times more than all markers together that points of a constraint count: a tenth of a millimetre or less apart."""


class MarkerFit:
    """Half the weighted sum of squares Σ w |x(q) - observed|² + Σ v (q - wanted)², and what a Newton step needs.

    The curvature is exact: markers on skin are centimetres off, and steps after Gauss and Newton shrink slowly there.

    Parameters
    ----------
    tree
        Whose coordinates are sought; nothing changes with those that depend on others.
    markers
        Points on its bodies, m of them.

    Points that the model's constraints keep together count `TIGHT` times as much as all markers.
    """

    def __init__(self, tree: Tree, markers: tuple[Marker, ...]) -> None:
        from casadi import SX, Function, densify, dot, hessian, jacobian, mtimes, reshape, substitute, sum1, vertcat

        whole = tree.coupled()

        def point(body: str, place: Float[np.ndarray, " 3"]) -> SX:
            at = tree.point(body, constant(place))
            return substitute(at, tree.q, whole) if tree.model.couplers else at

        def seen_as(marker: Marker) -> SX:
            at = point(marker.body, marker.location)
            return at - point(marker.body, np.zeros(3)) if marker.direction else at

        places = vertcat(*map(seen_as, markers))
        observed, weights = SX.sym("observed", 3 * len(markers)), SX.sym("weights", len(markers))
        wanted, held = SX.sym("wanted", len(tree.names)), SX.sym("held", len(tree.names))
        each = reshape(mtimes(SX.ones(3, 1), weights.T), -1, 1)
        off, astray = places - observed, whole - wanted
        gaps = vertcat(SX(0, 1), *(point(*pair.ends(0)) - point(*pair.ends(1)) for pair in tree.model.pairs))
        tight = TIGHT * sum1(weights) * dot(gaps, gaps)
        cost = 0.5 * (dot(each * off, off) + dot(held * astray, astray) + tight)
        curvature, gradient = hessian(cost, tree.q)
        arguments = [tree.q, observed, weights, wanted, held]
        self._curvature = Buffered(Function("curvature", arguments, [densify(curvature)]))
        self._slope = Buffered(Function("slope", arguments, [densify(gradient), cost]))
        self._slopes = Buffered(Function("slopes", [tree.q], [densify(jacobian(places, tree.q).T)]))
        ties = Function("ties", [tree.q], [densify(jacobian(gaps, tree.q).T)])
        self._ties = Buffered(ties) if tree.model.pairs else None
        self._places = Buffered(Function("places", [tree.q], [densify(places)]))

    def slope(self, q: Vector, against: Target) -> tuple[Vector, float]:
        """Gradient and cost of a pose."""
        gradient, cost = self._slope(q, *against)
        return gradient.copy(), float(cost[0])

    def curvature(self, q: Vector, against: Target) -> Float[np.ndarray, "n n"]:
        """Second derivatives of the cost."""
        return self._curvature(q, *against)[0].reshape(len(q), len(q)).copy()

    def slopes(self, q: Vector) -> Float[np.ndarray, "k n"]:
        """Derivatives of the markers' places by the coordinates, three rows for each marker."""
        return self._slopes(q)[0].reshape(-1, len(q)).copy()

    def ties(self, q: Vector) -> Float[np.ndarray, "k n"]:
        """Derivatives of the distances that constraints keep at zero, three rows for each pair of points."""
        return np.zeros((0, len(q))) if self._ties is None else self._ties(q)[0].reshape(-1, len(q)).copy()

    def places(self, q: Float[np.ndarray, " n"]) -> Float[np.ndarray, "m 3"]:
        """Where the markers are in a pose, in the ground's frame [m]; of directions from the body's origin."""
        return np.array(self._places(q)[0]).reshape(-1, 3)


Square = Float[np.ndarray, "n n"]

NOTHING = 1e-9  # curvature along a direction that markers do not tell, where that of each coordinate is 1
PART = 1e-3  # of a unit direction that belongs to a coordinate
HARDLY = 5e-3  # m that all markers together move by in a turn of 1 rad: a millimetre of noise is more than 11 degrees


def undetermined(normal: Square, free: Bool[np.ndarray, " n"]) -> Bool[np.ndarray, " n"]:
    """Coordinates with a part in a direction along which nothing counts.

    Parameters
    ----------
    normal
        Curvature of the sum of squares after Gauss and Newton.
    free
        Coordinates that the search moves.
    """
    found = np.zeros(len(free), dtype=bool)
    inner = normal[np.ix_(free, free)]
    unit = np.sqrt(np.where(np.diag(inner) > 0.0, np.diag(inner), 1.0))
    size, directions = np.linalg.eigh(inner / np.outer(unit, unit))
    idle = directions[:, size <= NOTHING]
    found[np.flatnonzero(free)] = np.abs(idle).max(axis=1, initial=0.0) > PART
    return found


def to_hold(slopes: Float[np.ndarray, "k n"], free: Bool[np.ndarray, " n"]) -> Bool[np.ndarray, " n"]:
    """Coordinates to hold: as few as there are directions along which markers hardly move.

    Of each direction that which turns or shifts most along it (Golub & Van Loan, Matrix Computations, sec. 5.5: columns
    exchanged by their length): of an arm with markers at shoulder, elbow and wrist the pronation, not the elbow, which
    makes up for it by a little.

    Parameters
    ----------
    slopes
        Derivatives of what counts [m] by the coordinates [rad, m].
    """
    found = np.zeros(len(free), dtype=bool)
    inner = slopes[:, free]
    _, size, directions = np.linalg.svd(inner, full_matrices=True)
    idle = directions[np.append(size, np.zeros(inner.shape[1] - len(size))) < HARDLY]
    if len(idle):
        order = qr(idle, mode="r", pivoting=True)[1]
        found[np.flatnonzero(free)[order[: len(idle)]]] = True
    return found


STEP = 1e-8  # rad or m that the longest step is below when a frame is done
MOST = 200  # steps for a frame
FAST = 0.2  # of the step before that a step is, while the curvature is kept
DAMPED, WILDER = 1e-6, 10.0  # of the curvature's largest entry, once a step led up; times more each time
EVEN = 1e-12  # of the cost that it may rise by rounding
FEWEST = 3  # markers of a model that must be seen somewhere
ASIDE = 0.5  # rad or m from the defaults of the pose that tells which coordinates markers determine


@dataclass(frozen=True)
class Poses:
    """Coordinates over time and how well they fit.

    Parameters
    ----------
    time
        [s].
    names, values
        Coordinates [rad, m]; NaN where the markers of the frame do not tell them and the gap was too long to fill. What
        no frame tells is at the model's default.
    markers, distances
        Names and distance of each from where it was seen [m]; NaN where it was not seen or does not count.
    steps
        Taken in each frame.
    settled
        Whether the last step was short enough.
    determined
        Whether markers, weights and limits of the frame determine the coordinate; what is not determined is filled or
        NaN.
    """

    time: Float[np.ndarray, " t"]
    names: tuple[str, ...]
    values: Float[np.ndarray, "t n"]
    markers: tuple[str, ...]
    distances: Float[np.ndarray, "t m"]
    steps: Int[np.ndarray, " t"]
    settled: Bool[np.ndarray, " t"]
    determined: Bool[np.ndarray, "t n"]


def inverse_kinematics(
    tree: Tree,
    seen: MarkerTrajectories,
    tasks: MarkerTasks,
    progress: Callable[[int], None] = lambda _: None,
    *,
    fill: float = 0.0,
) -> Poses:
    """Coordinates in each frame.

    Parameters
    ----------
    fill
        Longest gap [s] over which a coordinate that is not determined is filled by a cubic spline through the frames
        that do; from the last frame before the gap to the first after it. Gaps at the ends are not filled.

    Those markers count that model, recording and tasks have; ValueError where no frame shows three of them.
    """
    markers = tuple(m for m in tree.model.markers if tasks.markers.get(m.name, 0.0) > 0.0 and m.name in seen.names)
    places = seen.of(tuple(m.name for m in markers))
    there = np.isfinite(places).all(axis=2)
    count = int(there.sum(axis=1).max(initial=0))
    if len(markers) < FEWEST:
        raise ValueError(f"{len(markers)} markers of the model were recorded and have a weight; three are needed")
    if count < FEWEST:
        raise ValueError(f"no frame shows more than {count} markers of the model; three are needed")
    search = _Search(tree, markers, tasks)
    search.hold(there.any(axis=0))
    wanted = tasks.wanted({c.name: c.default for c in tree.model.coordinates}, seen.time)
    values, distances = np.zeros((len(seen), len(tree.names))), np.full((len(seen), len(markers)), np.nan)
    steps, settled = np.zeros(len(seen), dtype=np.int64), np.zeros(len(seen), dtype=bool)
    determined = np.zeros(values.shape, dtype=bool)
    first = int(np.argmax(there.sum(axis=1)))
    done = 0
    for frames in (range(first, len(seen)), range(first - 1, -1, -1)):
        q = search.start if frames.step > 0 else values[first]
        for frame in frames:
            q, steps[frame], settled[frame] = search.pose(q, places[frame], wanted[frame])
            values[frame], determined[frame] = q, search.determined(there[frame])
            distances[frame] = np.linalg.norm(search.fit.places(q) - places[frame], axis=1)
            done += 1
            progress(done)
    values = np.where(determined.any(axis=0), _filled(seen.time, values, determined, fill), search.start)
    values = tree.model.coupled(values)
    return Poses(seen.time, tree.names, values, tuple(m.name for m in markers), distances, steps, settled, determined)


def _filled(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t n"], determined: Bool[np.ndarray, "t n"], longest: float
) -> Float[np.ndarray, "t n"]:
    """What is not determined, over short gaps by a cubic spline through what is, else NaN."""
    from scipy.interpolate import CubicSpline

    found = np.where(determined, values, np.nan)
    for k in np.flatnonzero(~determined.all(axis=0)):
        known = np.flatnonzero(determined[:, k])
        lost = np.flatnonzero(~determined[:, k])
        if len(known) < 2:
            continue
        after = np.searchsorted(known, lost)
        inside = (after > 0) & (after < len(known))
        lost, after = lost[inside], after[inside]
        short = time[known[after]] - time[known[after - 1]] <= longest + 1e-9
        found[lost[short], k] = CubicSpline(time[known], values[known, k])(time[lost[short]])
    return found


class _Search:
    """What is the same in all frames."""

    def __init__(self, tree: Tree, markers: tuple[Marker, ...], tasks: MarkerTasks) -> None:
        self.fit = MarkerFit(tree, markers)
        self.kept: _Kept | None = None
        self.weights = np.array([tasks.markers[m.name] for m in markers])
        coordinates = tree.model.coordinates
        self.start = np.array([c.default for c in coordinates])
        self.low = np.array([c.limits[0] if c.clamped else -np.inf for c in coordinates])
        self.high = np.array([c.limits[1] if c.clamped else np.inf for c in coordinates])
        self.followers = {
            tree.names.index(c.dependent): [tree.names.index(n) for n in c.of] for c in tree.model.couplers
        }
        self.locked = np.array([c.locked or k in self.followers for k, c in enumerate(coordinates)])
        self.held = tasks.held(tree.names)
        self.idle = np.zeros(len(coordinates), dtype=bool)
        self.known: dict[bytes, Bool[np.ndarray, " n"]] = {}
        count = np.arange(len(coordinates))
        aside = ASIDE * (1.0 + 0.4 * np.sin(1.0 + 2.4 * count)) * np.where(np.cos(0.3 + 1.7 * count) > 0.0, 1.0, -1.0)
        beyond = (self.start + aside < self.low) | (self.start + aside > self.high)
        self.aside = np.clip(self.start + np.where(beyond, -aside, aside), self.low, self.high)

    def hold(self, there: Bool[np.ndarray, " m"]) -> None:
        """Lock coordinates that these markers, all that are ever seen, hardly tell."""
        rows = self.fit.slopes(self.aside)[np.repeat(there, 3)]
        held = np.diag((self.held > 0.0).astype(float))
        self.idle = to_hold(np.vstack([rows, np.sqrt(TIGHT) * self.fit.ties(self.aside), held]), ~self.locked)
        self.locked = self.locked | self.idle

    def pose(self, q: Vector, observed: Float[np.ndarray, "m 3"], wanted: Vector) -> tuple[Vector, int, bool]:
        """Coordinates of a frame from a start, steps taken, and whether the last was short enough."""
        there = np.all(np.isfinite(observed), axis=1)
        weights = np.where(there, self.weights, 0.0)
        against = (np.where(there[:, None], observed, 0.0), weights, wanted, weights.sum() * self.held)
        gradient, cost = self.fit.slope(q, against)
        damping, before = 0.0, np.inf
        for step in range(1, MOST + 1):
            free = ~self.locked & ~((q <= self.low) & (gradient > 0.0)) & ~((q >= self.high) & (gradient < 0.0))
            if self.kept is None or not self.kept.holds(free, there):
                self.kept = _Kept(self.fit.curvature(q, against), free, there, damping)
            tried = np.clip(q - self.kept.step(gradient), self.low, self.high)
            longest = float(np.max(np.abs(tried - q), initial=0.0))
            if longest < STEP:
                return tried, step, True
            slope, found = self.fit.slope(tried, against)
            if found <= cost + EVEN * abs(cost):
                q, gradient, cost = tried, slope, found
                fast, damping = longest < FAST * before, damping / WILDER
            else:
                fast, damping = False, max(WILDER * damping, DAMPED)
            before = longest
            self.kept = self.kept if fast else None
        return q, MOST, False

    def determined(self, there: Bool[np.ndarray, " m"]) -> Bool[np.ndarray, " n"]:
        """Which coordinates the markers that are there, held values and locks determine."""
        known = self.known.get(there.tobytes())
        if known is not None:
            return known
        found = np.asarray(~self.idle & (self.locked | ~undetermined(self._normal(there), ~self.locked)))
        for k, of in self.followers.items():
            found[k] = found[of].all()
        self.known[there.tobytes()] = found
        return found

    def _normal(self, there: Bool[np.ndarray, " m"]) -> Float[np.ndarray, "n n"]:
        """Curvature after Gauss and Newton, of the markers that are there and of held values.

        In a pose away from the defaults, and from straight elbows. In the pose of a frame it says too little: where a
        marker is as near as it comes, its distance does not change with a coordinate that it tells all the same.
        """
        slopes = self.fit.slopes(self.aside).reshape(len(there), 3, len(self.aside))
        weights = np.where(there, self.weights, 0.0)
        ties = self.fit.ties(self.aside)
        own = np.einsum("m,mik,mil->kl", weights, slopes, slopes)
        return np.asarray(own + weights.sum() * (ties.T @ ties + np.diag(self.held)), float)


class _Kept:
    """A curvature, factorised over the coordinates that are free; raised until it leads down everywhere."""

    def __init__(
        self,
        curvature: Float[np.ndarray, "n n"],
        free: Bool[np.ndarray, " n"],
        there: Bool[np.ndarray, " m"],
        damping: float,
    ) -> None:
        self.free, self.there = free, there
        inner = curvature[np.ix_(free, free)]
        scale = float(np.max(np.abs(np.diag(inner)), initial=1.0))
        while True:
            self.factor, bad = dpotrf(inner + damping * scale * np.eye(len(inner)), lower=True)
            if not bad:
                return
            damping = max(WILDER * damping, DAMPED)

    def holds(self, free: Bool[np.ndarray, " n"], there: Bool[np.ndarray, " m"]) -> bool:
        """Whether the same coordinates are free and the same markers there."""
        return bool(np.array_equal(free, self.free) and np.array_equal(there, self.there))

    def step(self, gradient: Vector) -> Vector:
        """What to go back by [rad, m]."""
        found = np.zeros(len(gradient))
        if self.free.any():
            found[self.free] = dpotrs(self.factor, gradient[self.free], lower=True)[0]
        return found
