"""Small synthetic elbow cases, made with the package's own model plus noise, jitter and noise of the input."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from unittest.mock import patch

import numpy as np
from scipy.signal import butter, filtfilt

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.diagnosis import Diagnosis
from geocontact.data.gap_case import GapCase
from geocontact.data.gap_cells import Cell
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.case.problem import Noise, Problem
from geocontact.gap.case.refit import Measured, Refit
from geocontact.gap.diagnose import diagnose
from geocontact.gap.localise.gap_map import Window, gap_map, windows
from geocontact.gap.selection import model_comparison as contest
from geocontact.gap.selection.evidence import Judged, judged
from geocontact.gap.selection.model_comparison import Contender, Ends, base_contender, discrepancy_basis, pairs, singles
from geocontact.gap.selection.residual_anomalies import (
    ClippedChannel,
    clipped_channels,
    lines,
    recorder_remarks,
    residual_anomalies,
    ringing,
    share_of_band,
)
from geocontact.gap.selection.surrogate import Surrogate, surrogate
from geocontact.identify.noise.noise_levels import NoiseLevels
from geocontact.systems.catalogue import system_of

TRUE = {"k": 260.0, "x": 0.035, "y": 0.05}
PARAMETERS = (
    Parameter("k", "N/m", 300.0, 50.0, 1000.0),
    Parameter("x", "m", 0.03, 0.0, 0.1),
    Parameter("y", "m", 0.04, 0.0, 0.12),
)
NOISE = 0.12  # N
STEP = 0.04  # s
Change = Callable[[str, np.ndarray, np.ndarray], np.ndarray]


def elbow_case(
    effect: str = "",
    values: Mapping[str, float] | None = None,
    seed: int = 0,
    duration: float = 16.0,
    change: Change | None = None,
    recorded: Change | None = None,
) -> GapCase:
    """Three calibration trials and two held out; `change` alters (trial, time, force) before noise comes in, `recorded`
    what is written down."""
    rng = np.random.default_rng(seed)
    names = ("t01", "t02", "t03", "t04", "t05")
    motions = {name: _motion(rng, duration) for name in names}
    empty = GapCase("case", "elbow", *_split(motions, {}), PARAMETERS, {"l": 0.185, "z": 0.09}, {"force": NOISE})
    system = system_of(empty).scaled(_trials(motions, {}), TRUE)
    model = _with(system, effect)
    forces = {}
    for name in names:
        own = {"k": TRUE["k"] * (1.0 + 0.02 * rng.standard_normal())}
        own |= {axis: TRUE[axis] + 5e-4 * rng.standard_normal() for axis in ("x", "y")}
        clean = model.simulate(_trial(name, motions[name], None), {**own, **(values or {})})[:, 0]
        time = STEP * np.arange(len(clean))
        clean = change(name, time, clean) if change else clean
        forces[name] = clean + NOISE * rng.standard_normal(len(clean))
        if recorded:
            forces[name] = recorded(name, time, forces[name])
    measured = {name: beta + _smooth(rng, len(beta), 0.002) for name, beta in motions.items()}
    calibration, evaluation = _split(measured, forces)
    return GapCase("case", "elbow", calibration, evaluation, PARAMETERS, empty.constants, {"force": NOISE})


def judged_as(model: Refit) -> Judged:
    """A model that nobody judged."""
    one, n = np.ones(1), len(model.whitened)
    noise = Noise(NoiseLevels(one, one[None], one[None], one, one), one, 0.0, ())
    return Judged(model, noise, 0.0, 0.0, n, [], np.zeros((n, 0)))


def diagnosis(*arguments: object, **options: object) -> Diagnosis:
    """Diagnosis of `elbow_case` with these arguments."""
    case = elbow_case(*arguments, **options)  # type: ignore[arg-type]
    return diagnose(case, system_of(case)).diagnosis


def diagnosis_and_gains(*arguments: object, **options: object) -> tuple[Diagnosis, list[tuple[bool, float]]]:
    """The same; and of each trial, whether it was held out and what it gains when it is predicted from the others."""
    case = elbow_case(*arguments, **options)  # type: ignore[arg-type]
    findings = diagnose(case, system_of(case))
    return findings.diagnosis, [(one.held_out, one.nats) for one in findings.trials]


def diagnosis_that_names_nothing(*arguments: object, **options: object) -> Diagnosis:
    """The same where one effect in question is one too many."""
    with patch("geocontact.gap.selection.verdict.MOST", 0):
        return diagnosis(*arguments, **options)


def renamed(case: GapCase, names: Mapping[str, str]) -> GapCase:
    """The same case under another name, its trials renamed and in another order."""
    return replace(
        case,
        name="something else",
        calibration=tuple(replace(t, name=names[t.name]) for t in case.calibration[::-1]),
        evaluation=tuple(replace(t, name=names[t.name]) for t in case.evaluation[::-1]),
    )


def diagnosis_of_renamed(names: Mapping[str, str], *arguments: object, **options: object) -> Diagnosis:
    """Diagnosis of a renamed case."""
    case = renamed(elbow_case(*arguments, **options), names)  # type: ignore[arg-type]
    return diagnose(case, system_of(case)).diagnosis


def diagnosis_of_reversed(names: tuple[str, ...], **options: object) -> Diagnosis:
    """Diagnosis of a case whose angle was recorded with the wrong sign in some trials."""
    case = elbow_case(**options)  # type: ignore[arg-type]
    for trial in case.calibration + case.evaluation:
        if trial.name in names:
            trial.signals.values[:, 0] *= -1.0
    return diagnose(case, system_of(case)).diagnosis


def evidence_of_bends(lean: float) -> tuple[float, float, float]:
    """What bends are worth to damping that leans by `lean` towards large angles [nats]; their squares over the effect's
    own; how many a mistake in the data gets."""

    def leaning(_: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        speed = np.gradient(force, time)
        return force + 0.8 * np.tanh(speed / 1.5) * (1.0 + lean * np.sin(2.0 * np.pi * time / time[-1]))

    case = elbow_case(seed=3, change=leaning)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem)
    offered = {one.label: one for one in candidates(problem.system)}
    one = next(c for c in singles(problem, base, [offered["dry_friction.rate"]]))
    model, noise = one.judged.model, one.judged.noise
    straight = [np.zeros((*r.shape, 0)) for r in model.residuals]
    gain = one.judged.nats - judged(problem, model, noise, straight).nats
    added = [
        (a - b) / problem.floor
        for measured in (problem.calibration, problem.evaluation)
        for a, b in zip(
            measured.residuals(problem.system, model.values),
            measured.residuals(model.system, model.values),
            strict=True,
        )
    ]
    whole = np.concatenate([each.ravel() for each in added])
    base_columns = np.concatenate([(j[..., :3] / problem.floor[:, None]).reshape(-1, 3) for j in model.jacobian])
    net = whole - base_columns @ np.linalg.lstsq(base_columns, whole, rcond=None)[0]
    squares = sum(float(np.sum((b / problem.floor[:, None]) ** 2)) for b in one.judged.discrepancy_basis)
    flips = discrepancy_basis(problem, (offered["sign_flip.beta"],), base.judged.model)
    return float(gain), squares / float(net @ net), sum(b.shape[-1] for b in flips)


def odd(change: Change | None, after: Change | None = None, duration: float = 24.0) -> dict[str, float]:
    """Everything odd in the residual of the base model, by words; `after` alters what was recorded."""
    case = elbow_case(seed=8, duration=duration, change=change)
    for trial in case.calibration + case.evaluation:
        if after:
            trial.signals.values[:, 1] = after(trial.name, trial.time, trial.signals.values[:, 1])
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    found = (*residual_anomalies(problem, base, base), *recorder_remarks(problem, base))
    return {each.words: each.nats for each in found}


def ringing_by_windows(cycles: int) -> float:
    """Nats of the surest ringing in windows of so many periods at the least, where all trials ring."""
    case = elbow_case(seed=8, duration=24.0, change=rung)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    with patch("geocontact.gap.selection.residual_anomalies.CYCLES", cycles):
        return max(each.nats for each in ringing(problem, base, base))


def share_of_line(change: Change) -> float:
    """Part of the squared residual of the base model that the surest line makes up."""
    return shares_of_line(change, 1.0)[0]


def shares_of_line(change: Change, times: float) -> tuple[float, float]:
    """The same, and where the base model leaves so many times what is judged."""
    case = elbow_case(seed=8, duration=24.0, change=change)
    problem = problem_of(case, system_of(case))
    judged = base_contender(problem).judged
    base = replace(judged, model=replace(judged.model, residuals=[times * each for each in judged.model.residuals]))
    one, other = (max(lines(problem, judged, first), key=lambda each: each.nats).share for first in (judged, base))
    return one, other


def share_of_wide_band(change: Change | None) -> float:
    """Part of the squared residual of the base model within an eighth of Nyquist's frequency of 7 Hz."""
    case = elbow_case(seed=8, duration=24.0, change=change)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    step = problem.system.scale.step
    return share_of_band(problem, base, base, 0, 7.0 * step, 1.0 / 16.0)


def paired() -> tuple[list[tuple[str, ...]], list[float], list[float], list[dict[str, float]], list[int]]:
    """Pairs with damping where the force also drifts, a stop in its variants beside; their gain over damping.

    Gains once more, searched from where these ended; squared errors that either leaves, by label, and how many
    simulations it took.
    """

    case = elbow_case("damping", {"damping.b": 12.0, "damping.exponent": 1.0}, seed=5, change=drifting)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem)
    offered = [one for one in candidates(problem.system) if one.name in ("damping", "sensor_drift", "end_stop")]
    ends, gains, costs, counts = Ends(), [], [], []
    for _ in range(2):
        with patch.object(Measured, "residuals", autospec=True, side_effect=Measured.residuals) as simulated:
            first = singles(problem, base, [one for one in offered if one.name == "damping"], ends)
            found = pairs(problem, first, offered, ends)
        gains.append([one.nats - first[0].nats for one in found])
        costs.append({label: one.cost for label, one in ends.fits.items()})
        counts.append(simulated.call_count)
    return [one.names for one in found], *gains, costs, counts


def contest_work(*, cut: bool) -> tuple[list[str], list[str], int, int]:
    """Leading singles and pairs where few go on, and simulations in the search for each.

    Without `cut` all are fitted to the end.
    """
    case = elbow_case("damping", {"damping.b": 12.0, "damping.exponent": 1.0}, seed=5)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem)
    names = ("damping", "sensor_drift", "end_stop", "relaxation")
    offered = [one for one in candidates(problem.system) if one.name in names]
    few = {"LEADING": 1}
    more = {} if cut else {"to_undercut": lambda *_: np.inf}
    with (
        patch.multiple(contest, **few, **more),
        patch.object(Measured, "residuals", autospec=True, side_effect=Measured.residuals) as simulated,
    ):
        first = singles(problem, base, offered)
        single = simulated.call_count
        both = pairs(problem, first, offered)
    return [one.label for one in first], [one.label for one in both], single, simulated.call_count - single


def finished_twice(*, later_is_better: bool) -> dict[str, tuple[list[float], float]]:
    """By label, the evidence that each fit of a single got, made up in the order of the calls, and what was kept."""
    case = elbow_case("damping", {"damping.b": 12.0, "damping.exponent": 1.0}, seed=5)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem)
    offered = [one for one in candidates(problem.system) if one.name in ("damping", "inertia_load", "relaxation")]
    got: dict[str, list[float]] = {}

    def made_up(_: Problem, those: tuple[Candidate, ...], *__: object) -> Contender:
        count = sum(map(len, got.values()))
        nats = float(count if later_is_better else -count)
        got.setdefault(those[0].label, []).append(nats)
        return Contender(those, replace(base.judged, nats=nats))

    with patch.object(contest, "finished", made_up):
        kept = singles(problem, base, offered)
    return {one.label: (got[one.label], one.judged.nats) for one in kept}


def flat(recorded: Change | None) -> tuple[ClippedChannel, ...]:
    """Flat tops of what is recorded of the base model."""
    case = elbow_case(seed=7, recorded=recorded)
    return clipped_channels(problem_of(case, system_of(case)))


def located(change: Change | None, recorded: Change | None = None) -> tuple[tuple[Cell, ...], tuple[Window, ...]]:
    """Gap map and windows of the base model alone."""
    case = elbow_case(seed=6, change=change, recorded=recorded)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    cells = gap_map(problem, base)
    return cells, windows(problem, problem, base, None, None, cells)


@dataclass(frozen=True)
class Unmeasured:
    """Nothing was recorded from this time on [s]."""

    start: float

    def __call__(self, _name: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        return np.where(time < self.start, force, np.nan)


def stood_in(change: Change | None) -> Surrogate:
    """What the stand-in for anything unknown finds on the base model."""
    case = elbow_case(seed=5, change=change)
    problem = problem_of(case, system_of(case))
    return surrogate(problem, base_contender(problem).judged)


@dataclass(frozen=True)
class Bump:
    """A push around a time [s], as wide as `width`, of a size [N]."""

    size: float
    time: float
    width: float

    def __call__(self, _: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        return force + self.size * np.exp(-0.5 * ((time - self.time) / self.width) ** 2)


@dataclass(frozen=True)
class Drift:
    """A force that grows by a rate [N/s]."""

    rate: float

    def __call__(self, _: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        return force + self.rate * time


@dataclass(frozen=True)
class Clip:
    """A recording that ends at a level [N], in steps [N] where they are not 0."""

    level: float
    step: float = 0.0

    def __call__(self, _: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        written = np.round(force / self.step) * self.step if self.step else force
        return np.minimum(written, self.level)


@dataclass(frozen=True)
class Swing:
    """An oscillation [Hz] between two times [s] only, at another phase in each trial."""

    begin: float
    end: float
    size: float
    frequency: float

    def __call__(self, name: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        inside = (time >= self.begin) & (time < self.end)
        return force + self.size * np.sin(2.0 * np.pi * self.frequency * time + float(name[1:])) * inside


@dataclass(frozen=True)
class Tremor:
    """A line at a frequency [Hz] of an amplitude [N]."""

    size: float
    frequency: float

    def __call__(self, _: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        return force + self.size * np.sin(2.0 * np.pi * self.frequency * time)


@dataclass(frozen=True)
class Times:
    """A factor on the force of some trials."""

    factor: float
    trials: tuple[str, ...]

    def __call__(self, name: str, _: np.ndarray, force: np.ndarray) -> np.ndarray:
        return force * (self.factor if name in self.trials else 1.0)


@dataclass(frozen=True)
class Late:
    """A delay [s]."""

    delay: float

    def __call__(self, _: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        return np.interp(time - self.delay, time, force)


def drifting(_: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
    """A sensor that drifts."""
    return force + 0.04 * time


def knock(name: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Something rings in one trial."""
    return force + 1.5 * np.exp(-(time - 9.0) / 0.3) * np.sin(40.0 * time) * (time > 9.0) * (name == "t02")


def held(_: str, __: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Three samples repeat the one before them, now and then."""
    out = force.copy()
    for start in range(20, len(out) - 5, 40):
        out[start + 1 : start + 4] = out[start]
    return out


def in_steps(_: str, __: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Rounded to 0.2 N."""
    return np.asarray(np.round(force / 0.2) * 0.2)


def lost(_: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Not measured for two seconds."""
    return np.where((time > 3.0) & (time < 5.0), np.nan, force)


def _with(system: System, effect: str) -> System:
    return next(one for one in candidates(system) if one.label == effect).apply(system) if effect else system


def _motion(rng: np.random.Generator, duration: float) -> np.ndarray:
    time = np.arange(0.0, duration, STEP)
    waves = sum(
        rng.uniform(0.5, 1.0) * np.sin(2.0 * np.pi * f * time + rng.uniform(0.0, 6.28)) for f in (0.1, 0.23, 0.41)
    )
    return 1.2 + 0.6 * waves / np.abs(waves).max()


def _smooth(rng: np.random.Generator, count: int, sd: float) -> np.ndarray:
    noise = filtfilt(*butter(2, 6.0, fs=1.0 / STEP), rng.standard_normal(count + 100))[50:-50]
    return sd * noise / noise.std()


def _trial(name: str, beta: np.ndarray, force: np.ndarray | None) -> Trial:
    time = STEP * np.arange(len(beta))
    columns = np.column_stack([beta, np.zeros(len(beta)) if force is None else force])
    return Trial(name, Signals(time, columns, ("beta", "force"), ("rad", "N")))


def _trials(motions: Mapping[str, np.ndarray], forces: Mapping[str, np.ndarray]) -> tuple[Trial, ...]:
    return tuple(_trial(name, beta, forces.get(name)) for name, beta in motions.items())


def _split(
    motions: Mapping[str, np.ndarray], forces: Mapping[str, np.ndarray]
) -> tuple[tuple[Trial, ...], tuple[Trial, ...]]:
    trials = _trials(motions, forces)
    return trials[:3], trials[3:]


def stairs(_: str, __: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Rounded to 0.8 N."""
    return np.asarray(np.round(force / 0.8) * 0.8)


def rung(_: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
    """A blow at the same time of every trial, after which something rings."""
    return force + 0.8 * np.exp(-(time - 9.0) / 0.4) * np.sin(2.0 * np.pi * 8.0 * (time - 9.0)) * (time > 9.0)
