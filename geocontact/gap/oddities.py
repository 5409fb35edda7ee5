"""What no candidate makes and no shared surrogate sees: a narrow line, a burst, held samples, a change within a trial.

Noise is coloured at most, its spectrum smooth; whitened by the right model it is white. Each check compares the whitened
residual, or the recording itself, with that, and says in nats (minus the logarithm of a p-value that is corrected for
everything that was looked at) how far off it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.gap.evidence import Judged, log_evidence, prior_spread
from geocontact.gap.problem import Problem

WINDOWS = (8, 16, 32, 64)  # samples
SHORTEST = 64  # samples of a trial whose spectrum is looked at
BESIDE = (-8, -7, -6, -5, -4, -3, 3, 4, 5, 6, 7, 8)  # bins that a line is compared with
STRETCHES = 4  # that a parameter may differ between, within a trial
HELD_USUALLY = 0.02  # share of samples that repeat the last by chance


@dataclass(frozen=True)
class Oddity:
    """In words what is odd, where, and how sure that is [nats]."""

    words: str
    channel: str
    nats: float


def oddities(problem: Problem, judged: Judged) -> list[Oddity]:
    """Every check, the surest first."""
    found = [*lines(problem, judged), *bursts(problem, judged), *held(problem), changes(problem, judged)]
    return sorted(found, key=lambda each: -each.nats)


def innovations(problem: Problem, judged: Judged) -> list[list[Float[np.ndarray, " _"]]]:
    """Whitened residual of every channel of every trial, in the order of time."""
    weighings = problem.weighings(judged.noise, judged.model)
    channels = len(problem.floor)
    out = []
    for weighing, residual in zip(weighings, judged.model.residuals, strict=True):
        white = weighing(residual[..., None])[:, 0]
        flat = np.full(residual.size, np.nan)
        flat[np.concatenate(weighing.whitener.rows)] = white
        out.append([column[np.isfinite(column)] for column in flat.reshape(-1, channels).T])
    return out


def lines(problem: Problem, judged: Judged) -> list[Oddity]:
    """A narrow line in the spectrum: power at one frequency against that of its neighbours, trials taken together."""
    from scipy.stats import f, gamma

    found = []
    rows = innovations(problem, judged)
    for c, name in enumerate(problem.system.outputs):
        series = [trial[c] for trial in rows if len(trial[c]) >= SHORTEST]
        if not series:
            continue
        grid = np.linspace(0.0, 0.5, max(map(len, series)) // 2)
        doubt = np.zeros(len(grid))
        for x in series:
            power = np.abs(np.fft.rfft((x - x.mean()) * np.hanning(len(x)))) ** 2
            ratio = power / _around(power)
            nats = -f.logsf(ratio, 2, len(BESIDE))  # neighbours overlap under the window, so half of them count
            doubt += np.interp(grid, np.arange(len(power)) / len(x), nats)
        inside = slice(len(BESIDE), -len(BESIDE))
        peak = int(np.argmax(doubt[inside])) + len(BESIDE)
        nats = -float(gamma.logsf(doubt[peak], len(series))) - float(np.log(len(grid)))
        hertz = grid[peak] / problem.system.scale.step
        found.append(Oddity(f"a line at {hertz:.3g} Hz", name, max(nats, 0.0)))
    return found


def _around(power: Float[np.ndarray, " f"]) -> Float[np.ndarray, " f"]:
    """Mean power of the bins a little to either side."""
    return np.asarray(np.mean([np.roll(power, shift) for shift in BESIDE], axis=0))


def bursts(problem: Problem, judged: Judged) -> list[Oddity]:
    """A stretch of one trial in which the residual is far larger than there and then in the other trials."""
    from scipy.stats import f

    found = []
    rows = innovations(problem, judged)
    for c, name in enumerate(problem.system.outputs):
        best, looked = 0.0, 0
        for width in WINDOWS:
            energies = [_energy(trial[c], width) for trial in rows if len(trial[c]) >= 4 * width]
            for own, energy in enumerate(energies):
                phase = np.linspace(0.0, 1.0, len(energy))
                others = [
                    np.interp(phase, np.linspace(0.0, 1.0, len(e)), e) for i, e in enumerate(energies) if i != own
                ]
                usual = np.maximum(np.median(others, axis=0), 1.0) if others else np.ones(len(energy))
                best = max(best, float((-f.logsf(energy / usual, width, width)).max()))
                looked += 2 * len(energy) // width
        found.append(Oddity("a burst", name, max(best - float(np.log(max(looked, 1))), 0.0)))
    return found


def _energy(values: Float[np.ndarray, " n"], width: int) -> Float[np.ndarray, " m"]:
    """Mean square in a running window."""
    total = np.concatenate([[0.0], np.cumsum(values**2)])
    return np.asarray((total[width:] - total[:-width]) / width)


def held(problem: Problem) -> list[Oddity]:
    """Samples that repeat the one before, away from the ends of the range, where saturation would hold them."""
    found = []
    trials = problem.calibration.outputs + problem.evaluation.outputs
    for c, name in enumerate(problem.system.outputs):
        repeats, count = 0, 0
        for outputs in trials:
            x = outputs[:, c][np.isfinite(outputs[:, c])]
            low, high = np.percentile(x, [2.0, 98.0]) if len(x) else (0.0, 0.0)
            inside = (x[1:] > low) & (x[1:] < high)
            repeats += int(((np.diff(x) == 0.0) & inside).sum())
            count += int(inside.sum())
        share = repeats / max(count, 1)
        if share > HELD_USUALLY:
            nats = count * (
                share * np.log(share / HELD_USUALLY)
                + (1.0 - share) * np.log(max(1.0 - share, 1e-12) / (1.0 - HELD_USUALLY))
            )
            found.append(Oddity(f"{100.0 * share:.0f} % of the samples repeat the last", name, float(nats)))
    return found


def changes(problem: Problem, judged: Judged) -> Oddity:
    """Base parameters that differ between stretches of a trial by more than trials do from each other."""
    model = judged.model
    weighings = problem.weighings(judged.noise, model)
    count = len(problem.usual)
    parts = []
    for weighing, jacobian in zip(weighings, model.jacobian, strict=True):
        samples = np.linspace(0.0, 1.0, len(jacobian))[:, None, None]
        steps = [
            jacobian[..., :count] * judged.noise.varies * (samples > edge)
            for edge in np.arange(1, STRETCHES) / STRETCHES
        ]
        parts.append(weighing(np.concatenate(steps, axis=-1)))
    gain, at = 0.0, 0
    spread = np.ones(parts[0].shape[1])
    fitted = model.whitened_jacobian
    base_spread = prior_spread(model.system, model.values)
    for part in parts:
        rows = slice(at, at + len(part))
        r, known = model.whitened[rows], fitted[rows] * base_spread
        basis = np.linalg.qr(known)[0] if known.shape[1] else np.zeros((len(r), 0))
        left, design = r - basis @ (basis.T @ r), part - basis @ (basis.T @ part)
        gain += max(log_evidence(left, design, size * spread) + 0.5 * float(left @ left) for size in (1.0, 3.0, 10.0))
        at += len(part)
    return Oddity("parameters change during a trial", "", max(gain - float(np.log(3.0)) * len(parts), 0.0))
