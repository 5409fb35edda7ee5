"""What of a residual repeats from trial to trial, and is therefore no noise.

A residual of each trial is summed in bins: of the phase, and of each input's position on the way up and on the way
down. With m_ib its mean in bin b of trial i and n_b the samples there, what repeats is

    R = sum over b of n_b mean over i ≠ j of m_ib m_jb,

an estimate of the sum of squares that all trials share. Products of different trials hold no noise of one of them,
however slow that is. How large R gets by chance is counted with the signs of blocks inside trials turned at random, as
in the gap map (`gap.localise.gap_map`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.chain.differentiated_inputs import recorded
from geocontact.chain.system import System
from geocontact.data.trial import Trial
from geocontact.gap.case.change_amplitude import BLOCKS
from geocontact.gap.levels import DRAWS, FEW, PHASES, SURE


@dataclass(frozen=True)
class Repeats:
    """Share of a residual's sum of squares that trials have in common.

    Parameters
    ----------
    share
        The largest along any axis; not below 0.
    sure
        What of it is more than chance makes.
    axis
        "phase" or an input.
    """

    share: float
    sure: float
    axis: str


def axes_of(trials: Sequence[Trial], system: System) -> dict[str, list[Int[np.ndarray, " _"]]]:
    """Bin of each sample of each trial, by axis."""
    phases = [(t.time - t.time[0]) / (t.time[-1] - t.time[0]) for t in trials]
    found = {"phase": [np.minimum((p * PHASES).astype(int), PHASES - 1) for p in phases]}
    movements = [recorded(t.signals, system.inputs, system.motion.reach) for t in trials]
    for row, name in enumerate(system.inputs):
        edges = np.unique(np.quantile(np.concatenate([m.position[row] for m in movements]), np.linspace(0, 1, FEW + 1)))
        if len(edges) - 1 < 2:
            continue
        inner = edges[1:-1]
        found[name] = [2 * np.searchsorted(inner, m.position[row]) + (m.rate[row] > 0.0) for m in movements]
    return found


def repeats(
    residuals: Sequence[Float[np.ndarray, " _"]],
    present: Sequence[Bool[np.ndarray, " _"]],
    axes: dict[str, list[Int[np.ndarray, " _"]]],
) -> Repeats:
    """What repeats of one channel's residual; nothing where fewer than two trials have it.

    Parameters
    ----------
    residuals, present
        Of each trial, and which samples were measured.
    axes
        From `axes_of`.
    """
    whole = sum(float((r[there] ** 2).sum()) for r, there in zip(residuals, present, strict=True))
    best = Repeats(0.0, 0.0, "")
    if whole <= 0.0 or sum(bool(there.any()) for there in present) < 2:
        return best
    for axis, which in axes.items():
        sums, counts = _in_bins(residuals, present, which)
        share = float(_common(sums.sum(axis=1)[None], counts)[0]) / whole
        signs = np.random.default_rng(0).choice([-1.0, 1.0], (DRAWS, *sums.shape[:2]))
        chance = _common(np.einsum("nik,ikb->nib", signs, sums), counts) / whole
        sure = share - float(np.quantile(chance, -np.expm1(-SURE)))
        if sure > best.sure or (best.axis == "" and share > best.share):
            best = Repeats(max(share, 0.0), max(sure, 0.0), axis)
    return best


def _in_bins(
    residuals: Sequence[Float[np.ndarray, " _"]],
    present: Sequence[Bool[np.ndarray, " _"]],
    which: Sequence[Int[np.ndarray, " _"]],
) -> tuple[Float[np.ndarray, "i k b"], Float[np.ndarray, "i b"]]:
    """Sums of each trial's blocks in each bin, and how many samples of each trial are in a bin."""
    bins = 1 + max(int(w.max()) for w in which)
    sums, counts = np.zeros((len(residuals), BLOCKS, bins)), np.zeros((len(residuals), bins))
    for i, (residual, there, own) in enumerate(zip(residuals, present, which, strict=True)):
        rows = np.flatnonzero(there)
        np.add.at(sums[i], (rows * BLOCKS // len(residual), own[rows]), residual[rows])
        np.add.at(counts[i], own[rows], 1.0)
    return sums, counts


def _common(sums: Float[np.ndarray, "n i b"], counts: Float[np.ndarray, "i b"]) -> Float[np.ndarray, " n"]:
    """Sum of squares that trials share, of each set of sums."""
    return np.asarray(shared(sums, counts).sum(axis=-1))


def shared(sums: Float[np.ndarray, "n i b"], counts: Float[np.ndarray, "i b"]) -> Float[np.ndarray, "n b"]:
    """Sum of squares that trials share in each bin, of each set of sums."""
    means = sums / np.maximum(counts, 1.0)
    trials = (counts > 0.0).sum(axis=0)
    pairs = np.maximum(trials * (trials - 1.0), 1.0)
    products = (means.sum(axis=1) ** 2 - (means**2).sum(axis=1)) / pairs
    return np.asarray(products * np.where(trials > 1, counts.sum(axis=0), 0.0))
