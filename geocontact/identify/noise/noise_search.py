"""Levels of noise that make residuals most likely, searched with average information.

Far from the end, curvature is the average of observed and expected information (Gilmour, Thompson & Cullis 1995,
Biometrics 51:1440), which needs no product of matrices and takes no step too far where noise is much too low. From
where a step gains less than a nat, secants amend it (BFGS, damped as by Powell 1978, Lecture Notes in Mathematics
630:144), since it leaves out how variances bend with their logarithms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.linalg import lapack

from geocontact.identify.noise.covariance import Layout, NoiseBlock, factor_of
from geocontact.identify.noise.noise_levels import NoiseLevels, NoisePriors
from geocontact.identify.optimise.bounded_gauss_newton import (
    BROKEN,
    CLOSE,
    DAMPED,
    KEPT,
    LIMIT,
    ROUNDING,
    TENFOLD,
    QuadraticModel,
)

FARTHEST = 6.0  # standard deviations of the prior that a level is searched in
LONGEST = 2.0  # that a correlation time is, and how noise grows: longer, and noise becomes what the model misses
CURVED = 0.2  # share of the expected curvature along a step that a secant keeps at least


@dataclass(frozen=True)
class ResidualBlock:
    """One block of a trial: its residual, and the covariance that variation from trial to trial makes.

    Both of rows divided by the block's `spread`.
    """

    block: NoiseBlock
    residual: Float[np.ndarray, " n"]
    moved: Float[np.ndarray, "n n"]


@dataclass(frozen=True)
class SearchPoint:
    """Minus the logarithm of what is maximised at a point of the search.

    `factors`, `solved` are of each piece: the covariance's lower factor, and its inverse times the residual.
    """

    x: Float[np.ndarray, " h"]
    levels: NoiseLevels
    cost: float
    factors: tuple[Float[np.ndarray, "_ _"], ...]
    solved: tuple[Float[np.ndarray, " _"], ...]


@dataclass(frozen=True)
class CostSurface:
    """What is searched: the pieces of all trials, and the prior of the levels."""

    pieces: tuple[ResidualBlock, ...]
    beliefs: NoisePriors

    @classmethod
    def of(
        cls,
        layouts: Sequence[Layout],
        residuals: Sequence[Float[np.ndarray, "_ c"]],
        jitter: Sequence[Float[np.ndarray, "_ c q"]],
        beliefs: NoisePriors,
    ) -> CostSurface:
        """From what `most_likely` is given."""
        pieces = []
        for layout, residual, moved in zip(layouts, residuals, jitter, strict=True):
            flat = moved.reshape(residual.size, moved.shape[-1])
            for block in layout.blocks:
                own = flat[block.rows] / block.spread[:, None]
                pieces.append(ResidualBlock(block, residual.ravel()[block.rows] / block.spread, own @ own.T))
        return cls(tuple(pieces), beliefs)

    def at(self, x: Float[np.ndarray, " h"]) -> SearchPoint:
        """Cost at a point."""
        levels = self.beliefs.levels(x)
        total, factors, solved = 0.5 * float(x @ x), [], []
        for piece in self.pieces:
            root, log_scale = factor_of(piece.block.covariance(levels) + piece.moved)
            eased, _ = lapack.dpotrs(root, piece.residual, lower=1)
            total += 0.5 * float(piece.residual @ eased) + log_scale
            factors.append(root)
            solved.append(eased)
        return SearchPoint(x, levels, total, tuple(factors), tuple(solved))

    def gradient(self, place: SearchPoint) -> Float[np.ndarray, " h"]:
        """Slope of the cost at a place: most of the work, which a place that is left at once does without."""
        pull = np.zeros(len(place.x))
        for piece, factor, solved in zip(self.pieces, place.factors, place.solved, strict=True):
            inverse, _ = lapack.dpotri(factor, lower=1)  # its lower half, by columns: the upper by rows
            pull += piece.block.pulls(place.levels, inverse.T - np.outer(solved, solved))
        return np.asarray(place.x + 0.5 * self.beliefs.slope(place.x, pull))

    def information(self, place: SearchPoint) -> Float[np.ndarray, "h h"]:
        """Average information of the residuals at a place, and that of the beliefs.

        With the covariance V, its derivatives V_k and the residual r it is ½ rᵀ V⁻¹ V_k V⁻¹ V_l V⁻¹ r.
        """
        size = len(place.x)
        known = np.zeros((size, size))
        for piece, factor, solved in zip(self.pieces, place.factors, place.solved, strict=True):
            part, _ = lapack.dtrtrs(factor, piece.block.derivatives_times(place.levels, solved).T, lower=1)
            known += part.T @ part
        rows = self.beliefs.slope(place.x, known)  # of a symmetric matrix: its columns likewise
        return np.eye(size) + 0.5 * self.beliefs.slope(place.x, rows.T)


def most_likely(
    layouts: Sequence[Layout],
    residuals: Sequence[Float[np.ndarray, "_ c"]],
    jitter: Sequence[Float[np.ndarray, "_ c q"]],
    beliefs: NoisePriors,
    start: NoiseLevels,
    rounds: int = LIMIT,
    others: Sequence[NoiseLevels] = (),
) -> tuple[NoiseLevels, float, float]:
    """Levels that make the residuals most likely, given their prior.

    With them half their squared surprise, and the logarithm of what was maximised. What is found is a local best.

    Parameters
    ----------
    layouts, residuals
        One per trial.
    jitter
        Derivatives with respect to what varies from trial to trial, times its standard deviation.
    beliefs
        Prior of the levels, and their limits.
    start, others
        The search sets out from the likeliest of these.
    rounds
        Evaluations of the likelihood at the most, `others` aside.
    """
    surface, farthest = CostSurface.of(layouts, residuals, jitter, beliefs), searched(beliefs)
    known = (surface.at(np.clip(beliefs.point(each), -farthest, farthest)) for each in (start, *others))
    here = min(known, key=lambda place: place.cost)
    gradient = surface.gradient(here)
    curvature, damping, near = surface.information(here), DAMPED, False
    for _ in range(rounds - 1):
        low, high = -farthest - here.x, farthest - here.x
        bend = QuadraticModel.within(gradient, curvature, low, high)
        if bend.promise(bend.step(0.0, low, high)) < CLOSE:
            break
        step = bend.step(damping, low, high)
        x = np.clip(here.x + step, -farthest, farthest)
        if np.array_equal(x, here.x):
            break
        there = surface.at(x)
        fall = here.cost - there.cost
        kept = fall / bend.promise(step)
        damping = damped(damping, kept)
        slope = surface.gradient(there) if near or fall > 0.0 else gradient
        if near:
            curvature = secant(curvature, there.x - here.x, slope - gradient)
        if fall > 0.0:
            here, gradient = there, slope
            if fall < CLOSE and kept > BROKEN:
                break
            if not near or fall >= 1.0:
                curvature, near = surface.information(here), fall < 1.0
        elif damping > 1.0 / ROUNDING:
            break
    return here.levels, 0.5 * float(here.x @ here.x), -here.cost


def searched(beliefs: NoisePriors) -> Float[np.ndarray, " h"]:
    """How many standard deviations of the prior each number is searched in, either way."""
    middle = beliefs.middle
    kinds = middle.white.size + middle.coloured.size, middle.memory.size + middle.growing.size
    return np.repeat([FARTHEST, LONGEST, FARTHEST], [*kinds, beliefs.middle.inputs.size])


def damped(damping: float, kept: float) -> float:
    """Damping of the next step, by the share of its promise that the last one kept."""
    if kept > KEPT:
        return max(damping / TENFOLD, ROUNDING)
    return damping if kept > BROKEN else max(TENFOLD * damping, DAMPED)


def secant(
    curvature: Float[np.ndarray, "h h"], step: Float[np.ndarray, " h"], change: Float[np.ndarray, " h"]
) -> Float[np.ndarray, "h h"]:
    """Curvature amended by how the slope changed along a step; it stays positive definite."""
    bent = curvature @ step
    expected, seen = float(step @ bent), float(step @ change)
    share = 1.0 if seen >= CURVED * expected else (1.0 - CURVED) * expected / (expected - seen)
    mixed = share * change + (1.0 - share) * bent
    return np.asarray(curvature - np.outer(bent, bent) / expected + np.outer(mixed, mixed) / float(step @ mixed))
