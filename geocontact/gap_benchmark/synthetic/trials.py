"""Trials as they are recorded: sampled, noisy, with rows missing, and with what the data may have wrong."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial as CaseTrial
from geocontact.gap_benchmark.synthetic.course import InputCourse, Path, through
from geocontact.gap_benchmark.synthetic.hooks import BASE, Hooks, Outputs, written_down
from geocontact.gap_benchmark.synthetic.laboratory import IN_PLACE, Placement
from geocontact.gap_benchmark.synthetic.noise import smooth_noise
from geocontact.gap_benchmark.synthetic.recording import AT_ONCE, Sampler
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.systems.interface import NotConvergedError

FINEST = 80
AGREE, AT_MOST = 0.03, 0.25
"""Root mean square and largest change on halving the step, in standard deviations of the sensor noise."""


@dataclass(frozen=True)
class SyntheticDataError:
    """A mistake in the data: factor on a column of inputs or outputs, or two outputs exchanged."""

    effect: str
    channel: str
    factor: float = 1.0
    swap: tuple[int, int] | None = None

    def inputs(self, scene: SyntheticScene, rows: Outputs) -> Outputs:
        """What is recorded of the inputs."""
        return self.times(scene.inputs, rows, self.factor)

    def corrected(self, scene: SyntheticScene, rows: Outputs) -> Outputs:
        """The inputs that were recorded, put right."""
        return self.times(scene.inputs, rows, 1.0 / self.factor)

    def outputs(self, scene: SyntheticScene, rows: Outputs) -> Outputs:
        """What is recorded of the outputs."""
        if self.swap is None:
            return self.times(scene.outputs, rows, self.factor)
        out = rows.copy()
        out[list(self.swap)] = rows[list(self.swap[::-1])]
        return out

    def times(self, names: tuple[str, ...], rows: Outputs, factor: float) -> Outputs:
        """Multiply this mistake's channel, if it is among `names`."""
        out = rows.copy()
        if self.channel in names:
            out[names.index(self.channel)] *= factor
        return out


NO_DATA_ERROR = SyntheticDataError("", "")


@dataclass(frozen=True)
class SyntheticTrial:
    """One trial as recorded and what it really was.

    `rows` are the samples that were kept, `late` says by which share of a step each sample at full rate was late.
    """

    path: Path
    rows: Int[np.ndarray, " s"]
    late: Float[np.ndarray, " n"]
    time: Float[np.ndarray, " s"]
    inputs: Float[np.ndarray, "i s"]
    outputs: Float[np.ndarray, "c s"]
    duration: float
    phase: float
    data_error: SyntheticDataError = field(default=NO_DATA_ERROR)
    setting: Mapping[str, float] = field(default_factory=dict)


def truth(
    scene: SyntheticScene,
    path: Path,
    count: int,
    theta: Float[np.ndarray, " p"],
    hooks: Hooks,
    fine: int,
    late: float | Float[np.ndarray, " n"] = 0.0,
) -> Outputs:
    """What would be written down at `count` samples without noise; no centre of pressure off the ground."""
    outputs = scene.body.recorded(sensed(scene, path, count, theta, hooks, fine, late))
    return scene.body.recorded(written_down(hooks, path((np.arange(count) + late) * scene.step), outputs))


def sensed(
    scene: SyntheticScene,
    path: Path,
    count: int,
    theta: Float[np.ndarray, " p"],
    hooks: Hooks,
    fine: int,
    late: float | Float[np.ndarray, " n"] = 0.0,
    placed: Placement = IN_PLACE,
    sampler: Sampler = AT_ONCE,
) -> Outputs:
    """What the sensors give at `count` samples without noise, from steps `fine` times as short.

    Samples are `late` by shares of the time between two, whole numbers of steps.
    """
    grid = np.arange((count - 1) * fine + 1) * (scene.step / fine)
    outputs = scene.body.respond(placed.moved(path(grid)), placed.shifted(scene.numbers(theta)), hooks)
    at = np.round((np.arange(count) + late) * fine).astype(int)
    return placed.measured(sampler.outputs(outputs, fine, at, scene.body.quotients) if sampler else outputs[:, at])


def followed(
    scene: SyntheticScene, path: Path, time: Float[np.ndarray, " s"], count: int, fine: int
) -> Float[np.ndarray, "i s"]:
    """Inputs as the scene's sampler has them at times, whole numbers of steps `fine` times as short as a sample."""
    if not (sampler := scene.laboratory.sampler):
        return path(time).position
    h = scene.step / fine
    return sampler.inputs(path(np.arange((count - 1) * fine + 1) * h).position, fine, np.round(time / h).astype(int))


def samples(scene: SyntheticScene, path: Path) -> int:
    """How many samples a trial has at full rate."""
    return int(path(np.zeros(1)).duration / scene.step + 1e-9) + 1


def fine_enough(scene: SyntheticScene, path: Path, hooks: Hooks) -> int:
    """Steps per sample at which the truth no longer depends on them; raises when even the finest do not do."""
    count = samples(scene, path)
    fine = scene.body.fine
    coarse = scene.body.recorded(sensed(scene, path, count, scene.theta, hooks, fine))
    while fine < FINEST:
        finer = scene.body.recorded(sensed(scene, path, count, scene.theta, hooks, 2 * fine))
        off = np.abs(coarse - finer) / np.array([one.sd for one in scene.noise])[:, None]
        off = off[np.isfinite(off)]
        if np.sqrt(np.mean(off**2)) <= AGREE and off.max() <= AT_MOST:
            return fine
        fine, coarse = 2 * fine, finer
    raise NotConvergedError(f"the truth changes by {off.max():.2g} noise levels at {fine} steps per sample")


def record(
    scene: SyntheticScene,
    path: Path,
    rng: Rng,
    hooks: Hooks = BASE,
    data_error: SyntheticDataError = NO_DATA_ERROR,
    fine: int | None = None,
    gaps: Callable[[Rng, int], Int[np.ndarray, " s"]] | None = None,
    turn: int = 0,
) -> SyntheticTrial:
    """Trial number `turn`: its own base parameters and placement, noise on outputs and inputs, rows that got lost."""
    count, fine = samples(scene, path), fine or scene.body.fine
    recorder, clock = scene.laboratory.recorder, scene.laboratory.clock
    theta = vary(scene, rng)
    laboratory = scene.laboratory
    placed = laboratory.placement.drawn(rng) + laboratory.standing + laboratory.warm_up.at(turn)
    late = clock.late(rng, count, fine) / fine
    time = (np.arange(count) + late) * scene.step
    course = path(time)
    outputs = scene.body.recorded(sensed(scene, path, count, theta, hooks, fine, late, placed, laboratory.sampler))
    outputs = recorder.noisy(outputs, np.array([one.draw(rng, count, scene.step) for one in scene.noise]))
    outputs = recorder.rounded(written_down(hooks, course, outputs), recorder.output_steps)
    outputs = scene.body.recorded(outputs)
    passed = zip(scene.input_noise, scene.filters, strict=True)
    noise = [smooth_noise(rng, sd, count, scene.step, one) for sd, one in passed]
    apart = scene.step * clock.apart(rng)
    seen = followed(scene, lambda at: path(at + apart), time, count, fine)
    inputs = recorder.rounded(seen + np.array(noise), recorder.input_steps)
    rows = np.arange(count) if gaps is None else gaps(rng, count)
    return SyntheticTrial(
        path,
        rows,
        late,
        time[rows],
        data_error.inputs(scene, inputs)[:, rows],
        data_error.outputs(scene, clock.heard(rng, outputs[:, rows])),
        course.duration,
        course.phase,
        data_error,
        course.setting,
    )


def vary(scene: SyntheticScene, rng: Rng) -> Float[np.ndarray, " p"]:
    """Base parameters of one trial, within what can be: at least a tenth of the nominal ones, of their sign."""
    theta = rng.multivariate_normal(scene.theta, scene.spread, method="cholesky")
    least = 0.1 * scene.theta
    return np.where(least > 0.0, np.maximum(theta, least), np.minimum(theta, least))


def as_measured(recording: SyntheticTrial) -> InputCourse:
    """The recorded inputs at the recorded samples."""
    path = through(recording.time, recording.inputs, recording.duration, recording.phase, recording.setting)
    return path(recording.time)


def predicted(scene: SyntheticScene, recording: SyntheticTrial, hooks: Hooks, fine: int) -> Outputs:
    """What the true simulator at its nominal parameters makes of the recorded inputs."""
    corrected = recording.data_error.corrected(scene, recording.inputs)
    path = through(recording.time, corrected, recording.duration, recording.phase, recording.setting)
    count = int(recording.rows[-1]) + 1
    outputs = truth(scene, path, count, scene.theta, hooks, fine, recording.late[:count])[:, recording.rows]
    return recording.data_error.outputs(scene, outputs)


def case_of(
    rng: Rng, scene: SyntheticScene, recordings: Sequence[SyntheticTrial], learn: int, name: str
) -> tuple[GapCase, tuple[str, ...]]:
    """The recordings as a case that does not tell what was injected."""
    trials = []
    for i, one in enumerate(recordings):
        outputs = one.outputs.copy()
        for row in scene.body.patchy:
            if rng.random() < 0.1:
                outputs[row, rng.random(outputs.shape[1]) < 0.02] = np.nan
        values = np.column_stack([*one.inputs, *outputs])
        signals = Signals(one.time, values, (*scene.inputs, *scene.outputs), scene.units)
        trials.append(CaseTrial(f"t{i + 1:02d}", signals, one.setting))
    known = {c: noise.sd for c, noise in zip(scene.outputs, scene.noise, strict=True)}
    lot = rng.random()
    if lot < 0.25:
        known = {}
    elif lot < 0.4:
        known = {c: sd for c, sd in known.items() if rng.random() < 0.5}
    case = GapCase(
        name,
        scene.system,
        tuple(trials[:learn]),
        tuple(trials[learn:]),
        scene.parameters,
        scene.constants,
        known,
        scene.tables,
    )
    return case, tuple(one.name for one in trials)
