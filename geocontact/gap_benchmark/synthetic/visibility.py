"""How visible an effect is once base parameters were refitted, under the true covariance of everything else."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.linalg import cho_factor, cho_solve, solve_triangular
from scipy.optimize import least_squares

from geocontact.gap_benchmark.synthetic.course import InputCourse, Path
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs, Values
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, smooth_covariance
from geocontact.gap_benchmark.synthetic.scene import Numbers, SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import SyntheticTrial, as_measured, predicted, samples

Model = Callable[[Values], Values]


def jacobian(model: Model, theta: Float[np.ndarray, " p"]) -> Float[np.ndarray, "c s p"]:
    """By central differences."""
    columns = []
    for i, value in enumerate(theta):
        step = np.zeros_like(theta)
        step[i] = 1e-4 * max(abs(value), 1e-3)
        columns.append((model(theta + step) - model(theta - step)) / (2.0 * step[i]))
    return np.stack(columns, axis=-1)


def refit(
    scene: SyntheticScene,
    models: Sequence[Model],
    measured: Sequence[Values],
    floor: Float[np.ndarray, " c"],
    starts: Sequence[Float[np.ndarray, " p"]],
) -> Float[np.ndarray, " p"]:
    """Best of the fits from `starts`: every channel divided by its floor, within the parameters' bounds."""
    low = np.array([p.lower for p in scene.parameters])
    high = np.array([p.upper for p in scene.parameters])
    there = [np.isfinite(y) for y in measured]

    def residual(theta: Float[np.ndarray, " p"]) -> Float[np.ndarray, " r"]:
        parts = [((m(theta) - y) / floor[:, None])[ok] for m, y, ok in zip(models, measured, there, strict=True)]
        return np.concatenate(parts)

    def slope(theta: Float[np.ndarray, " p"]) -> Float[np.ndarray, "r p"]:
        parts = [(jacobian(m, theta) / floor[:, None, None])[ok] for m, ok in zip(models, there, strict=True)]
        return np.concatenate(parts)

    scale = np.array([max(abs(p.start), 1e-6) for p in scene.parameters])
    inside = 1e-6 * (high - low)
    fits = [
        least_squares(
            residual,
            np.clip(start, low + inside, high - inside),
            jac=slope,
            bounds=(low, high),
            x_scale=scale,
            ftol=1e-7,
            xtol=1e-7,
            gtol=1e-7,
            max_nfev=60,
        )
        for start in starts
    ]
    return np.asarray(min(fits, key=lambda fit: float(fit.cost)).x)


def starts(scene: SyntheticScene, rng: np.random.Generator) -> list[Float[np.ndarray, " p"]]:
    """Where the parameters begin, the nominal ones, and some out of the scene's box, where it has one."""
    begin = [np.array([p.start for p in scene.parameters]), scene.theta]
    if scene.begin is not None:
        low, high = (np.array(side) for side in scene.begin)
        begin += [rng.uniform(low, high) for _ in range(3)]
    return begin


BINS = 100
"""Bins of the phase of a trial."""
MOST = 0.7
"""Share of the squared gap that a window holds."""


@dataclass(frozen=True)
class Reach:
    """Per channel: rmse of the refitted base and of the truth on fresh trials, and where the gap sits."""

    before: dict[str, float]
    after: dict[str, float]
    window: dict[str, tuple[float, float]]
    shares: dict[str, float]


def reach(
    scene: SyntheticScene,
    fresh: Sequence[SyntheticTrial],
    theta: Float[np.ndarray, " p"],
    hooks: Hooks,
    fine: int,
    floor: Float[np.ndarray, " c"],
) -> Reach:
    """Base at `theta` against the true simulator at nominal parameters, both on measured inputs."""
    count = len(scene.outputs)
    before, after, number = np.zeros(count), np.zeros(count), np.zeros(count)
    along = np.zeros((count, BINS))
    for one in fresh:
        base = scene.base_model(as_measured(one))(theta)
        true = predicted(scene, one, hooks, fine)
        there = np.isfinite(one.outputs) & np.isfinite(base) & np.isfinite(true)
        before += np.where(there, one.outputs - base, 0.0).__pow__(2).sum(axis=1)
        after += np.where(there, one.outputs - true, 0.0).__pow__(2).sum(axis=1)
        number += there.sum(axis=1)
        gap: Outputs = np.where(there, true - base, 0.0) ** 2
        phase = np.clip((one.time / one.duration * BINS).astype(int), 0, BINS - 1)
        for c in range(count):
            along[c] += np.bincount(phase, gap[c], BINS)
    number = np.maximum(number, 1.0)
    whole = along.sum(axis=1) / number / floor**2
    names = scene.outputs
    return Reach(
        dict(zip(names, np.sqrt(before / number).tolist(), strict=True)),
        dict(zip(names, np.sqrt(after / number).tolist(), strict=True)),
        {name: shortest(along[c]) for c, name in enumerate(names)},
        dict(zip(names, (whole / max(float(whole.sum()), 1e-300)).tolist(), strict=True)),
    )


def shortest(squares: Float[np.ndarray, " b"]) -> tuple[float, float]:
    """Shortest window that holds `MOST` of the sum, as phases."""
    total = np.concatenate([[0.0], np.cumsum(squares)])
    need = MOST * total[-1]
    ends = np.searchsorted(total, total + need - 1e-12 * max(need, 1e-300))
    widths = np.where(ends < len(total), ends - np.arange(len(total)), len(total))
    begin = int(np.argmin(widths))
    return begin / BINS, min(int(ends[begin]), BINS) / BINS


FAINT = 1e-7
"""White part of the variance of input noise, for the sake of arithmetic."""
HIDDEN = 1e6
"""Standard deviations added where nothing is measured."""
ROUNDED = 12.0
"""Variance of rounding is the square of the step over this."""


@dataclass(frozen=True)
class WhitenedTrial:
    """A calibration trial as it is whitened: base model, its outputs, Cholesky factor of noise and input noise.

    `placed` is what each thing that sits elsewhere in every trial adds to the outputs, by one standard deviation.
    """

    path: Path
    count: int
    model: Model
    outputs: Outputs
    factor: Float[np.ndarray, "n n"]
    diagonal: Float[np.ndarray, "c s"]
    placed: Float[np.ndarray, "c s q"]


@dataclass(frozen=True)
class Sight:
    """Visible nats of a signature, the share of its energy that base parameters took, and nats before they did.

    `whole` and `swallowed` know noise and input noise only, `nats` trial-to-trial variation too.
    """

    nats: float
    swallowed: float
    whole: float
    theta: Float[np.ndarray, " p"]


def whitener(scene: SyntheticScene, path: Path) -> WhitenedTrial:
    """Covariance of what is measured in one trial at given base parameters: sensor noise and propagated input noise."""
    count = samples(scene, path)
    course = path(np.arange(count) * scene.step)
    model = scene.base_model(course)
    outputs = scene.body.recorded(model(scene.theta))
    size = count * len(scene.outputs)
    total = np.zeros((size, size))
    add_sensor_noise(total, scene, outputs)
    for i, sd, filtered in input_noises(scene):
        if scene.body.passed_on is not None:
            passed = passed_on(scene, course, i, sd, filtered, scene.body.passed_on)
            total += passed @ passed.T
            continue
        place, cross, rate = smooth_covariance(sd, count, scene.step, filtered)
        a, b = slopes(scene, path, count, i)
        if not a.any() and not b.any():
            continue
        # output error = a q + b q' at every sample; channels share the same q
        for c in range(len(scene.outputs)):
            for d in range(len(scene.outputs)):
                block = (
                    a[c][:, None] * place * a[d]
                    + b[c][:, None] * rate * b[d]
                    + a[c][:, None] * cross * b[d]
                    + b[c][:, None] * cross.T * a[d]
                )
                total[c * count : (c + 1) * count, d * count : (d + 1) * count] += block
    gone = ~np.isfinite(outputs)
    diagonal = np.diag(total).reshape(outputs.shape).copy()
    sd_all = np.repeat([one.sd for one in scene.noise], count)
    total[np.diag_indices(size)] += np.where(gone.ravel(), (HIDDEN * sd_all) ** 2, (1e-3 * sd_all) ** 2)
    return WhitenedTrial(path, count, model, outputs, np.linalg.cholesky(total), diagonal, varied(scene, path, count))


def add_sensor_noise(total: Float[np.ndarray, "n n"], scene: SyntheticScene, outputs: Outputs) -> None:
    """Covariance of what sensors and recorder add to the base model's outputs."""
    channels, count = outputs.shape
    mixing = scene.laboratory.recorder.mixing(outputs)
    for e, noise in enumerate(scene.noise):
        own = noise.covariance(count, scene.step)
        felt = [c for c in range(channels) if mixing[c, e].any()]
        for c in felt:
            for d in felt:
                block = mixing[c, e][:, None] * own * mixing[d, e]
                total[c * count : (c + 1) * count, d * count : (d + 1) * count] += block
    for c, step in scene.laboratory.recorder.output_steps.items():
        part = np.arange(c * count, (c + 1) * count)
        total[part, part] += step * step / ROUNDED


def input_noises(scene: SyntheticScene) -> Iterator[tuple[int, float, NoiseFilter]]:
    """Row, standard deviation and filter of every noise of an input: the sensor's, and that of rounding."""
    for i, (sd, filtered) in enumerate(zip(scene.input_noise, scene.filters, strict=True)):
        yield i, float(sd), filtered
    for i, step in scene.laboratory.recorder.input_steps.items():
        yield i, float(step / np.sqrt(ROUNDED)), NoiseFilter(0.5 / scene.step)


def varied(scene: SyntheticScene, path: Path, count: int) -> Float[np.ndarray, "c s q"]:
    """What all that differs from trial to trial adds, by one standard deviation: placement, warming up, clocks."""
    time = np.arange(count) * scene.step
    laboratory, course = scene.laboratory, path(time)
    columns = placed(scene, course)
    if len(laboratory.warm_up.cold):
        cold = replace(scene, laboratory=replace(laboratory, placement=laboratory.warm_up.cold))
        columns = np.concatenate([columns, placed(cold, course)], axis=2)
    if laboratory.clock.trigger:
        sd = laboratory.clock.trigger * scene.step / np.sqrt(3.0)  # uniform
        sides = [scene.base_model(replace(path(time + by), time=time))(scene.theta) for by in (sd, -sd)]
        columns = np.concatenate([columns, np.nan_to_num(0.5 * (sides[0] - sides[1]))[..., None]], axis=2)
    return columns


def placed(scene: SyntheticScene, course: InputCourse) -> Float[np.ndarray, "c s q"]:
    """What the base model's outputs change by where something sits elsewhere, central differences over either side."""
    sides = [
        [
            one.measured(scene.body.base_model(one.moved(course), one.shifted(scene.constants))(scene.theta))
            for one in (each, each.opposite())
        ]
        for each in scene.laboratory.placement.each()
    ]
    columns = [np.nan_to_num(0.5 * (more - less)) for more, less in sides]
    return np.stack(columns, axis=-1) if columns else np.zeros((len(scene.outputs), len(course.time), 0))


def passed_on(
    scene: SyntheticScene,
    course: InputCourse,
    i: int,
    sd: float,
    filtered: NoiseFilter,
    respond: Callable[[InputCourse, Numbers, int, Values], Values],
) -> Float[np.ndarray, "n q"]:
    """What the base model makes of the noise of input i where it remembers: each column times a number from N(0, 1)."""
    count = len(course.time)
    place, _, _ = smooth_covariance(1.0, count, scene.step, filtered)
    root = np.linalg.cholesky(place + FAINT * np.eye(count))
    passed = respond(course, scene.numbers(scene.theta), i, sd * root)
    return np.asarray(passed.reshape(-1, count))


def slopes(scene: SyntheticScene, path: Path, count: int, i: int) -> tuple[Outputs, Outputs]:
    """Derivatives of the base outputs by input i and by its rate, at every sample."""
    grid = np.arange(count) * scene.step
    course = path(grid)
    found = []
    for name in ("position", "rate"):
        value = getattr(course, name)
        h = 1e-6 if name == "position" else 1e-5
        sides = []
        for sign in (1.0, -1.0):
            moved = value.copy()
            moved[i] += sign * h
            sides.append(scene.base_model(type(course)(**{**vars(course), name: moved}))(scene.theta))
        found.append(np.nan_to_num((sides[0] - sides[1]) / (2.0 * h)))
    return found[0], found[1]


def floor(scene: SyntheticScene, trials: Sequence[WhitenedTrial]) -> Float[np.ndarray, " c"]:
    """Noise, input noise and trial-to-trial variation of each channel together, root mean square over the trials."""
    squares = []
    for one in trials:
        by = jacobian(one.model, scene.theta)
        variance = one.diagonal + np.einsum("csp,pq,csq->cs", by, scene.spread, by) + (one.placed**2).sum(axis=2)
        squares.append(np.where(np.isfinite(one.outputs), variance, np.nan))
    return np.asarray(np.sqrt(np.nanmean(np.concatenate(squares, axis=1), axis=1)))


def sight(
    scene: SyntheticScene,
    trials: Sequence[WhitenedTrial],
    planted: Sequence[Values],
    floors: Float[np.ndarray, " c"],
    start: Float[np.ndarray, " p"] | None = None,
) -> Sight:
    """Visibility of what makes the outputs of `trials` those that are `planted`."""
    measured = [np.where(np.isfinite(one.outputs), y, np.nan) for one, y in zip(trials, planted, strict=True)]
    begin = [scene.theta] if start is None else [start, scene.theta]
    theta = refit(scene, [one.model for one in trials], measured, floors, begin)
    root = np.linalg.cholesky(scene.spread)
    raw = left = within = 0.0
    p = len(theta)
    normal, normal_plain = np.zeros((p, p)), np.zeros((p, p))
    right, right_plain = np.zeros(p), np.zeros(p)
    # a parameter at its bound takes nothing more away
    scale = np.where(movable(scene, theta), np.maximum(np.abs(theta), 1e-3), 0.0)
    for one, y in zip(trials, measured, strict=True):
        gap, first = (np.nan_to_num(y - part) for part in (one.model(theta), one.outputs))
        by = np.where(np.isfinite(y)[:, :, None], jacobian(one.model, theta), 0.0).reshape(-1, p)
        moved = np.where(np.isfinite(y)[:, :, None], one.placed, 0.0).reshape(len(by), -1)
        stacked = solve_triangular(one.factor, np.column_stack([gap.ravel(), first.ravel(), by, moved]), lower=True)
        r, s, j = stacked[:, 0], stacked[:, 1], stacked[:, 2 : 2 + p] * scale
        raw += float(s @ s)
        within += float(r @ r)
        normal_plain += j.T @ j
        right_plain += j.T @ r
        jitter = np.column_stack([stacked[:, 2 : 2 + p] @ root, stacked[:, 2 + p :]])
        inner = cho_factor(np.eye(jitter.shape[1]) + jitter.T @ jitter)

        def free(v: Values, jitter: Values = jitter, inner: tuple[Values, bool] = inner) -> Values:
            return np.asarray(v - jitter @ cho_solve(inner, jitter.T @ v))

        left += float(r @ free(r))
        right += j.T @ free(r)
        normal += j.T @ free(j)
    visible = left - float(right @ np.linalg.lstsq(normal, right, rcond=1e-12)[0])
    plain = within - float(right_plain @ np.linalg.lstsq(normal_plain, right_plain, rcond=1e-12)[0])
    share = 1.0 - plain / raw if raw > 0.0 else 0.0
    return Sight(0.5 * max(visible, 0.0), float(np.clip(share, 0.0, 1.0)), 0.5 * raw, theta)


def movable(scene: SyntheticScene, theta: Float[np.ndarray, " p"]) -> Bool[np.ndarray, " p"]:
    """Which parameters are not at a bound."""
    low = np.array([p.lower for p in scene.parameters])
    high = np.array([p.upper for p in scene.parameters])
    return np.asarray((theta - low > 1e-4 * (high - low)) & (high - theta > 1e-4 * (high - low)))
