"""Makes one labelled synthetic case from a seed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.catalogue import (
    CONFOUNDED,
    LABORATORIES,
    NO_GAP,
    SCENES,
    plans,
    unknown_effects,
)
from geocontact.gap_benchmark.synthetic.course import Path
from geocontact.gap_benchmark.synthetic.data_errors import draw_data_error
from geocontact.gap_benchmark.synthetic.data_errors import words as fault_words
from geocontact.gap_benchmark.synthetic.hooks import BASE, Hooks, Outputs
from geocontact.gap_benchmark.synthetic.label import KINDS, Kind, Label, SyntheticCase, ideal
from geocontact.gap_benchmark.synthetic.laboratories.elsewhere import placed_as_usual, slightly_wrong
from geocontact.gap_benchmark.synthetic.magnitudes import magnitudes_of
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, NotFoundError, SyntheticMagnitudes
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.systems.interface import NotConvergedError
from geocontact.gap_benchmark.synthetic.trials import (
    NO_DATA_ERROR,
    SyntheticDataError,
    SyntheticTrial,
    as_measured,
    case_of,
    fine_enough,
    record,
    truth,
)
from geocontact.gap_benchmark.synthetic.visibility import (
    Reach,
    Sight,
    WhitenedTrial,
    floor,
    reach,
    refit,
    sight,
    starts,
    whitener,
)

FRESH = 40
"""Fresh trials on which the true reduction is measured."""
FAINTEST, BRIGHTEST = 3.0, 8000.0
"""Range of visibility of single effects [nats]."""
HIDDEN, SHARE_HIDDEN, WHOLE = 1.5, 0.97, 40.0
"""An absorbed effect shows less than this [nats], base parameters reproduce at least this share of it, and before
they do it is at least this large [nats]."""
ALIKE, APART = 0.9, 10.0
"""Limits of a pair: largest cosine between the visible signatures; what each shows at least beside the other [nats]."""
ATTEMPTS = 60
TRIALS = ((3, 2), (3, 2), (3, 2), (4, 2), (3, 3))
"""For calibration and evaluation, where the laboratory has no number of its own."""


@dataclass(frozen=True)
class Stage:
    """A scene with its calibration movements, ready to tell how visible something is."""

    scene: SyntheticScene
    trials: tuple[WhitenedTrial, ...]
    floor: Float[np.ndarray, " c"]
    scale: SyntheticMagnitudes

    def sight(self, hooks: Hooks, data_errors: Sequence[SyntheticDataError] = ()) -> Sight:
        """Visibility of what is hooked in and of mistakes in the data, by calibration trial."""
        planted: list[Outputs] = []
        trials = list(self.trials)
        for i, one in enumerate(self.trials):
            data_error = data_errors[i] if data_errors else NO_DATA_ERROR
            if data_error.channel in self.scene.inputs:
                course = one.path(np.arange(one.count) * self.scene.step)
                wrong = replace(
                    course,
                    position=data_error.inputs(self.scene, course.position),
                    rate=data_error.inputs(self.scene, course.rate),
                )
                trials[i] = replace(one, model=self.scene.base_model(wrong))
            clean = truth(self.scene, one.path, one.count, self.scene.theta, hooks, self.scene.body.fine)
            planted.append(data_error.outputs(self.scene, clean))
        return sight(self.scene, trials, planted, self.floor)

    @property
    def anew(self) -> Stage:
        """The same with everything placed anew in every trial, as is usual, whatever the laboratory does."""
        trials = [replace(one, placed=placed_as_usual(self.scene, one.path, one.count)) for one in self.trials]
        return replace(self, trials=tuple(trials))


@dataclass(frozen=True)
class DrawnCase:
    """What is to be planted: hooks or a mistake, and how visible each effect is alone."""

    effects: tuple[str, ...] = ()
    words: str = "nothing is left out"
    hooks: Hooks = BASE
    sights: Mapping[str, Sight] | None = None
    data_error: SyntheticDataError = NO_DATA_ERROR
    faulty: frozenset[int] = frozenset()
    details: Mapping[str, str | float] | None = None

    def by_trial(self, count: int) -> list[SyntheticDataError]:
        """The mistake of each of the first trials."""
        return [self.data_error if i in self.faulty else NO_DATA_ERROR for i in range(count)]


def synthetic_case(
    system: str,
    kind: str,
    seed: int | np.random.SeedSequence,
    effect: str | None = None,
    nats: float | None = None,
    laboratory: str = "home",
) -> SyntheticCase:
    """A labelled case; synthetic.

    Parameters
    ----------
    system
        One of `scenes.SCENES`.
    kind
        See `label.KINDS`.
    seed
        The same seed gives the same case.
    effect, nats
        For one that must be of this name, about this visible; drawn where they are None.
    laboratory
        Who records it, one of `laboratories.catalogue.LABORATORIES`.
    """
    if system not in SCENES:
        raise ValueError(f"no synthetic cases for system {system!r}; there are {', '.join(SCENES)}")
    if kind not in KINDS:
        raise ValueError(f"unknown kind {kind!r}; kinds are {', '.join(KINDS)}")
    if laboratory not in LABORATORIES:
        raise ValueError(f"unknown laboratory {laboratory!r}; laboratories are {', '.join(LABORATORIES)}")
    sequence = np.random.SeedSequence(seed) if isinstance(seed, int) else seed
    last: Exception | None = None
    for attempt in range(ATTEMPTS):
        key = (*sequence.spawn_key, attempt)
        rng = np.random.default_rng(np.random.SeedSequence(sequence.entropy, spawn_key=key))
        try:
            scene = LABORATORIES[laboratory](rng, SCENES[system](rng, shifted=kind == "shift"))
            known = next(k for k in KINDS if k == kind)
            return attempt_at(rng, scene, known, effect, nats, name_of(system, sequence))
        except (NotFoundError, NotConvergedError) as why:
            last = why
    raise NotFoundError(f"{system} {kind} {effect or ''}: nothing suitable in {ATTEMPTS} draws; last: {last}")


def name_of(system: str, sequence: np.random.SeedSequence) -> str:
    """A name that tells nothing of the answer."""
    return f"{system}_{int(sequence.generate_state(1)[0]):08x}"


def attempt_at(
    rng: Rng, scene: SyntheticScene, kind: Kind, effect: str | None, nats: float | None, name: str
) -> SyntheticCase:
    """One draw; raises where it does not give what the kind asks for."""
    learn, hold = scene.laboratory.trials or TRIALS[rng.integers(len(TRIALS))]
    stage = prepared(scene, [scene.path(rng, i) for i in range(learn)], kind)
    if len(scene.laboratory.standing):
        scene = slightly_wrong(scene, stage.anew.trials, stage.floor)
        stage = replace(stage, scene=scene)
    found = FINDERS[kind](rng, stage, effect, nats)
    if not all(math.isfinite(seen.nats) for seen in (found.sights or {}).values()):
        raise NotFoundError(f"{found.words}: how visible it is cannot be computed")
    fine = fine_enough(scene, stage.trials[0].path, found.hooks)
    gaps = scene.laboratory.clock.kept if rng.random() < scene.laboratory.clock.losing else None
    data_errors = found.by_trial(learn + hold)
    paths = [one.path for one in stage.trials] + [scene.later(rng, i) for i in range(hold)]
    recordings = [
        record(scene, p, rng, found.hooks, f, fine, gaps, turn)
        for turn, (p, f) in enumerate(zip(paths, data_errors, strict=True))
    ]
    share = sum(f is not NO_DATA_ERROR for f in data_errors[learn:]) / hold
    fresh = [
        record(
            scene,
            scene.later(rng, i),
            rng,
            found.hooks,
            found.data_error if (i + 0.5) / FRESH < share else NO_DATA_ERROR,
            fine,
            turn=learn + i % hold,
        )
        for i in range(FRESH)
    ]
    theta = fitted(scene, recordings[:learn], stage.floor, rng)
    how_far = reach(scene, fresh, theta, found.hooks, fine, stage.floor)
    case, names = case_of(rng, scene, recordings, learn, name)
    label = label_of(kind, found, how_far, scene, stage, names)
    if not all(true is None or math.isfinite(true) for true in label.reduction.values()):
        raise NotFoundError(f"{found.words}: how far the gap shrinks cannot be computed")
    return SyntheticCase(case, label, ideal(scene, stage.trials, found.hooks, fine))


def prepared(scene: SyntheticScene, paths: Sequence[Path], kind: Kind) -> Stage:
    """Whitened calibration trials and the magnitudes in them."""
    trials = tuple(whitener(scene, path) for path in paths)
    return Stage(scene, trials, floor(scene, trials), magnitudes_of(scene, trials, 0.1 if kind == "absorbed" else 1.0))


def fitted(
    scene: SyntheticScene, recordings: Sequence[SyntheticTrial], floors: Float[np.ndarray, " c"], rng: Rng
) -> Float[np.ndarray, " p"]:
    """The base refitted to recorded trials."""
    models = [scene.base_model(as_measured(one)) for one in recordings]
    return refit(scene, models, [one.outputs for one in recordings], floors, starts(scene, rng))


def nothing(_: Rng, __: Stage, ___: str | None, ____: float | None) -> DrawnCase:
    """No effect."""
    return DrawnCase()


def single(rng: Rng, stage: Stage, effect: str | None, nats: float | None) -> DrawnCase:
    """One effect of the vocabulary, its visibility spread evenly over the decades."""
    known = [
        one for one in plans(stage.scene.system, stage.scene.laboratory.forms) if one.name == effect or effect is None
    ]
    if not known:
        raise ValueError(f"no planted effect {effect!r} for the {stage.scene.system}")
    if effect is None:
        hard = NO_GAP.get(stage.scene.system, ())
        known = [one for one in known if one.name not in hard]
    plan = known[rng.integers(len(known))]
    target = nats or float(np.exp(rng.uniform(np.log(FAINTEST), np.log(BRIGHTEST))))
    return chosen(stage, plan, plan.drawn(rng, stage.scale), target, least=FAINTEST if nats is None else 0.7 * nats)


def chosen(stage: Stage, plan: InjectionPlan, draw: Draw, target: float, least: float) -> DrawnCase:
    """The amplitude that is as visible as `target`."""
    size, seen = amplitude(stage, draw, target)
    if seen.nats < least:
        raise NotFoundError(f"{plan.name} shows {seen.nats:.2g} nats at most")
    details: dict[str, str | float] = {"variant": draw.variant, "amplitude": size}
    return DrawnCase((plan.name,), draw.words(size), draw.hooks(size), {plan.name: seen}, details=details)


def amplitude(stage: Stage, draw: Draw, target: float) -> tuple[float, Sight]:
    """Amplitude whose visibility is within a tenth of `target` nats, or the largest; secant in logarithms."""
    size = math.sqrt(draw.low * draw.high)
    points: list[tuple[float, float, Sight]] = []
    for _ in range(14):
        seen = stage.sight(draw.hooks(size))
        level = math.log(max(seen.nats, 1e-12))
        points.append((math.log(size), level, seen))
        off = math.log(target) - level
        if abs(off) < 0.1:
            break
        slope = 2.0
        if len(points) > 1 and abs(points[-1][0] - points[-2][0]) > 1e-9:
            slope = (points[-1][1] - points[-2][1]) / (points[-1][0] - points[-2][0])
            slope = min(max(slope, 0.7), 6.0)
        new = min(max(math.log(size) + off / slope, math.log(draw.low)), math.log(draw.high))
        if abs(new - math.log(size)) < 1e-9:
            break
        size = math.exp(new)
    best = min(points, key=lambda point: abs(point[1] - math.log(target)))
    return math.exp(best[0]), best[2]


def pair(rng: Rng, stage: Stage, _: str | None, __: float | None) -> DrawnCase:
    """Two effects that are visible about alike, none of which the base parameters reproduce."""
    hard = NO_GAP.get(stage.scene.system, ())
    known = [one for one in plans(stage.scene.system, stage.scene.laboratory.forms) if one.name not in hard]
    first, second = (known[i] for i in rng.choice(len(known), 2, replace=False))
    level = float(np.exp(rng.uniform(np.log(20.0), np.log(BRIGHTEST))))
    found = []
    for plan in (first, second):
        target = level * float(np.exp(rng.uniform(-0.5, 0.5)))
        found.append(chosen(stage, plan, plan.drawn(rng, stage.scale), target, least=0.8 * target))
    hooks = found[0].hooks + found[1].hooks
    if hooks.cannot_be_solved:
        raise NotFoundError("a spring in series is not combined with a law that remembers")
    alone = [one.sights or {} for one in found]
    both = stage.sight(hooks)
    n, m = (one[plan.name].nats for one, plan in zip(alone, (first, second), strict=True))
    cosine = (both.nats - n - m) / (2.0 * math.sqrt(n * m))  # of the angle between the visible signatures
    if abs(cosine) > ALIKE or min(n, m) * (1.0 - cosine**2) < APART:
        raise NotFoundError("one of the two can stand for both")
    details: dict[str, str | float] = {"both_nats": both.nats, "cosine": cosine}
    for one in found:
        details |= {f"{one.effects[0]}.{key}": value for key, value in (one.details or {}).items()}
    words = " and ".join(one.words for one in found)
    return DrawnCase((first.name, second.name), words, hooks, {**alone[0], **alone[1]}, details=details)


def outside(rng: Rng, stage: Stage, effect: str | None, nats: float | None) -> DrawnCase:
    """Something that the vocabulary has no word for."""
    known = [one for one in unknown_effects(stage.scene.system) if one.name == effect or effect is None]
    plan = known[rng.integers(len(known))]
    target = nats or float(np.exp(rng.uniform(np.log(10.0), np.log(BRIGHTEST))))
    found = chosen(stage, plan, plan.drawn(rng, stage.scale), target, least=min(10.0, 0.7 * target))
    seen = (found.sights or {})[plan.name]
    words = f"{found.words} (not in the table)"
    return replace(
        found, effects=(), words=words, sights={"outside": seen}, details={**(found.details or {}), "sort": plan.name}
    )


def confounded(rng: Rng, stage: Stage, effect: str | None, _: float | None) -> DrawnCase:
    """An effect of some size that refitted base parameters reproduce on these trials."""
    known = [
        one
        for one in plans(stage.scene.system, stage.scene.laboratory.forms)
        if one.name in CONFOUNDED[stage.scene.system]
    ]
    known = [one for one in known if one.name == effect or effect is None]
    plan = known[rng.integers(len(known))]
    draw = plan.drawn(rng, stage.scale)
    largest, seen = amplitude(stage, draw, rng.uniform(0.3, 1.0) * HIDDEN)
    smallest = math.sqrt(WHOLE / max(seen.whole, WHOLE))
    size = largest * float(np.exp(rng.uniform(0.5 * math.log(smallest), 0.0)))
    seen = stage.sight(draw.hooks(size))
    if seen.nats > HIDDEN or seen.swallowed < SHARE_HIDDEN or seen.whole < WHOLE:
        raise NotFoundError(f"{plan.name}: {seen.nats:.2g} of {seen.whole:.2g} nats, {seen.swallowed:.1%} swallowed")
    details: dict[str, str | float] = {"variant": draw.variant, "amplitude": size}
    return DrawnCase((plan.name,), draw.words(size), draw.hooks(size), {plan.name: seen}, details=details)


def mistake(rng: Rng, stage: Stage, effect: str | None, _: float | None) -> DrawnCase:
    """A mistake in the data of all trials or of some; visible, or it would be an absorbed one."""
    data_error = draw_data_error(rng, stage.scene)
    if effect is not None and data_error.effect != effect:
        raise NotFoundError("another mistake is asked for")
    count = len(stage.trials)
    everywhere = frozenset(range(count + 3))
    faulty = everywhere
    if rng.random() < 0.4:
        some = rng.choice(count + 2, int(rng.integers(1, 3)), replace=False)
        faulty = frozenset(int(i) for i in some)
    if not faulty & set(range(count)):
        raise NotFoundError("no calibration trial is concerned")
    seen = stage.sight(BASE, DrawnCase(data_error=data_error, faulty=faulty).by_trial(count))
    if seen.nats < 10.0:
        raise NotFoundError("the mistake does not show")
    words = fault_words(data_error, stage.scene) + ("" if faulty is everywhere else ", in some trials only")
    details: Mapping[str, str | float] = {"channel": data_error.channel, "factor": data_error.factor}
    return DrawnCase((data_error.effect,), words, BASE, {data_error.effect: seen}, data_error, faulty, details)


FINDERS: Mapping[Kind, Callable[[Rng, Stage, str | None, float | None], DrawnCase]] = {
    "none": nothing,
    "single": single,
    "pair": pair,
    "outside": outside,
    "absorbed": confounded,
    "fault": mistake,
    "shift": single,
}


def label_of(
    kind: Kind, found: DrawnCase, how_far: Reach, scene: SyntheticScene, stage: Stage, names: tuple[str, ...]
) -> Label:
    """What is true of the case."""
    sights = found.sights or {}
    before, after = how_far.before, how_far.after
    reduction: dict[str, float | None] = {c: 1.0 - after[c] / before[c] for c in scene.outputs}
    if kind in ("none", "absorbed"):  # nothing is named, so nothing shrinks
        reduction = dict.fromkeys(scene.outputs, 0.0)
    if kind == "outside":
        reduction = dict.fromkeys(scene.outputs, None)
    return Label(
        kind=kind,
        effects=found.effects,
        words=found.words,
        nats={name: seen.nats for name, seen in sights.items()},
        nats_anew=stage.anew.sight(found.hooks, found.by_trial(len(stage.trials))).nats if len(sights) == 1 else None,
        swallowed={name: seen.swallowed for name, seen in sights.items()},
        rmse_before=dict(before),
        rmse_after=dict(after),
        reduction=reduction,
        window=how_far.window,
        shares=how_far.shares,
        floor=dict(zip(scene.outputs, stage.floor.tolist(), strict=True)),
        faulty=tuple(name for i, name in enumerate(names) if i in found.faulty),
        details=dict(found.details or {}),
    )
