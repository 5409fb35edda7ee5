"""Exoskeletons sought one after the other: without help, share alone, all that varies, for the draws, and the front."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Float
from scipy.special import stdtrit

from geocontact.dynamics.collocation.solve import SolverOptions
from geocontact.standing_up.assistance_design import KNEE, HelpDesign, HelpTask, designed
from geocontact.standing_up.assistance_room import ROOM
from geocontact.standing_up.assisted_model import (
    SHARE,
    TIMING,
    AssistedModel,
    HabitSizes,
    assisted_model,
    seen_assisted,
)
from geocontact.standing_up.assisted_movement import Movement, Movements, StoppedByHandError
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.numbers_that_ran import FROM_FILE, Ran, model_numbers, parameter_numbers, search_numbers
from geocontact.standing_up.phase import PhaseProblem, judged
from geocontact.standing_up.strap_sites import STRAP_SITES, THIGH_STRAP, StrapSite
from geocontact.standing_up.trial_result import TrialResult, trial_result
from geocontact.standing_up.trials import StandingTrial

WORN, ALONE, BEST, ROBUST = "without help", "share alone", "chosen", "chosen for the draws"


class NoMovementError(ArithmeticError):
    """Nobody stands up with a design; `design` is its name."""

    def __init__(self, design: str, why: str) -> None:
        super().__init__(why)
        self.design = design


@dataclass(frozen=True, eq=False)
class CertifiedDesign:
    """One exoskeleton and the movement with it.

    Parameters
    ----------
    name
        As tables call it.
    limit
        Of the knee's true peak, as part of that without help; not a number without a limit.
    design
        None where nothing was sought.
    trials
        By the calibrated parameters.
    """

    name: str
    limit: float
    design: HelpDesign | None
    movement: Movement
    trials: tuple[TrialResult, ...]

    @property
    def certified(self) -> bool:
        """Whether every movement is."""
        return all(trial.certified for trial in self.trials)


@dataclass(frozen=True, eq=False)
class DrawnGain:
    """The aim with one drawn set of parameters, by the exoskeleton that is compared with and by the chosen one.

    Parameters
    ----------
    reference, chosen, knee
        Smooth peaks, or mean energy, and the knee's torque with the chosen one.
    largest_reference, largest_chosen, largest_knee
        True peaks.
    """

    reference: float
    chosen: float
    knee: float
    largest_reference: float
    largest_chosen: float
    largest_knee: float

    @property
    def gain(self) -> float:
        """Part of the reference that is saved."""
        return 1.0 - self.chosen / self.reference


def gain_interval(draws: Sequence[DrawnGain], level: float = 0.95) -> tuple[float, float]:
    """In which the gain of another draw lies, by Student's distribution; not numbers for fewer than two."""
    if len(draws) < 2:
        return float("nan"), float("nan")
    gains: Float[np.ndarray, " d"] = np.array([each.gain for each in draws])
    reach = float(stdtrit(len(gains) - 1, 0.5 + 0.5 * level) * gains.std(ddof=1) * np.sqrt(1.0 + 1.0 / len(gains)))
    return float(gains.mean()) - reach, float(gains.mean()) + reach


@dataclass(frozen=True, eq=False)
class HelpSettings:
    """What is sought, and how.

    Parameters
    ----------
    vary
        Names of `ROOM`.
    aim
        One of the measures: energy, or the strap at the thigh (strap), shank or pelvis.
    knee
        True peak of the person's knee torque at most, as part of that without help.
    nodes
        Intervals a second to begin with.
    draws, seed
        Sets of parameters that are drawn, and the seed of these draws.
    """

    vary: tuple[str, ...]
    aim: str = "strap"
    knee: float = 0.8
    nodes: float = 20.0
    draws: int = 0
    seed: int = 0


class HelpSearch:
    """The trials' movements, and designs that are sought with them.

    Once `stop` is set by Ctrl-C it begins nothing new.

    Parameters
    ----------
    p
        What is searched of all parameters of the model, help as it usually is.
    sd
        Standard deviations of those that vary between draws, 0 for the others.
    options
        Of the solver; its intervals do not count.
    stage
        Called with words before each movement.
    sites
        Where straps are.
    """

    def __init__(
        self,
        subject: Subject,
        trials: Sequence[StandingTrial],
        p: Float[np.ndarray, " p"],
        sd: Float[np.ndarray, " p"],
        settings: HelpSettings,
        options: SolverOptions,
        stage: Callable[[str], None] = lambda words: None,
        sites: Sequence[StrapSite] = (THIGH_STRAP,),
    ) -> None:
        self.trials, self.p, self.settings, self.stage, self.now, self.stop = trials, p, settings, stage, WORN, False
        self.model = assisted_model(subject, sites=sites)
        self.movements = Movements(self.model, subject, trials, options, settings.nodes, self._before)
        rng = np.random.default_rng(settings.seed)
        self.sets = np.array([p + sd * rng.normal(size=len(p)) for _ in range(settings.draws)])

    def _before(self) -> None:
        self.stage(f"{self.now}, movement {self.movements.solved + 1}")
        if self.stop:
            raise StoppedByHandError("interrupted")

    def worn(self) -> CertifiedDesign:
        """Without help; StoppedByHandError where Ctrl-C came before it was there, else NoMovementError."""
        without = self.p.copy()
        without[SHARE] = 0.0
        try:
            movement = self.movements.finely_at(without)
        except StoppedByHandError:
            raise
        except ArithmeticError as error:
            raise NoMovementError(WORN, str(error)) from error
        return self._certified(WORN, float("nan"), None, movement)

    def chosen(self, worn: CertifiedDesign, *, robust: bool = False) -> list[CertifiedDesign]:
        """Share alone, then everything, then for the worst of the draws too where it is to be `robust`.

        NoMovementError where a movement is not found, StoppedByHandError where Ctrl-C came before any.
        """
        vary, knee = self.settings.vary, self.settings.knee
        found: list[CertifiedDesign] = []
        every = (BEST, vary)
        for name, some in [every] if vary == ("share",) else [(ALONE, ("share",)), every]:
            found += self._sought(name, worn, knee, some, _start(found[-1]) if found else self.p[None])
        if not found:
            raise StoppedByHandError("interrupted")
        if robust:
            found += self._sought(ROBUST, worn, knee, vary, np.vstack([_start(found[-1]), self.sets]))
        return found

    def front(self, worn: CertifiedDesign, best: CertifiedDesign, count: int) -> tuple[CertifiedDesign, ...]:
        """So many from no more than without help on down to the limit that was asked for."""
        limits = np.linspace(1.0, self.settings.knee, count + 1)[:-1]
        found = [best]
        for limit in limits[::-1]:
            found += self._sought(f"knee at {limit:.3g}", worn, float(limit), self.settings.vary, _start(found[-1]))
        return tuple(found[:0:-1])

    def drawn(self, designs: Sequence[CertifiedDesign]) -> tuple[DrawnGain, ...]:
        """Draws by the exoskeleton that the gain is over and by the last; those without a movement are left out."""
        reference, last = designs[1] if len(designs) > 2 else designs[0], designs[-1]
        found: list[DrawnGain] = []
        index = HelpTask(self.settings.vary, self.settings.aim, 1.0).index
        aim = self.settings.aim
        for k, row in enumerate([] if self.stop else self.sets):
            self.now = f"draw {k + 1}"
            values = []
            for one in (reference, last):
                p = row.copy()
                p[[SHARE, TIMING]] = one.movement.found.p[[SHARE, TIMING]]
                if one is last:
                    p[index] = last.movement.found.p[index]
                try:
                    values.append(self.movements.at(p, slopes=False).asked)
                except StoppedByHandError:
                    self.stop = True
                    return tuple(found)
                except ArithmeticError:
                    break
            else:
                first, second = values
                found.append(
                    DrawnGain(
                        first.at(aim),
                        second.at(aim),
                        float(second.sizes[KNEE]),
                        first.largest_at(aim),
                        second.largest_at(aim),
                        float(second.largest[KNEE]),
                    )
                )
        return tuple(found)

    def _sought(
        self, name: str, worn: CertifiedDesign, limit: float, vary: tuple[str, ...], sets: Float[np.ndarray, "s p"]
    ) -> list[CertifiedDesign]:
        """One design; none once the search was stopped."""
        if self.stop:
            return []
        self.now = name
        knee = limit * float(worn.movement.asked.largest[KNEE])
        try:
            found = designed(self.movements, sets, HelpTask(vary, self.settings.aim, knee))
        except StoppedByHandError:
            self.stop = True
            return []
        except ArithmeticError as error:
            raise NoMovementError(name, str(error)) from error
        self.stop |= found.stopped
        return [self._certified(name, limit, found, found.movements[0])]

    def _certified(self, name: str, limit: float, found: HelpDesign | None, movement: Movement) -> CertifiedDesign:
        self.stage(f"{name}, certificate")
        standing, p = self.model.standing, movement.found.p
        phase = PhaseProblem(movement.problem, {}, standing.parameters, ())
        seen = judged(standing.stepper, self.model.controlled, standing.turning, phase, movement.found)
        trials = tuple(
            trial_result(trial, motion, each, partial(seen_assisted, self.model, motion, p, name=trial.name))
            for trial, motion, each in zip(self.trials, movement.found.motions, seen, strict=True)
        )
        return CertifiedDesign(name, limit, found, movement, trials)


def _start(one: CertifiedDesign) -> Float[np.ndarray, "s p"]:
    return one.movement.found.p[None]


def design_numbers(
    model: AssistedModel, designs: Sequence[CertifiedDesign], trials: Sequence[StandingTrial]
) -> list[Ran]:
    """Model, held parameters and the movement's cost once; what may vary and the meshes for each design."""
    first, every = designs[0].movement, model.standing.parameters
    there = () if model.standing.constants is None else model.standing.constants.sites
    absent = {name for site in STRAP_SITES if site.name not in [each.name for each in there] for name in site.names}
    chosen = {parameter for parameter, _, _ in ROOM.values()}
    rows = model_numbers(model.standing)
    rows.append(Ran("help width", model.width, "-", "invented", "of the help, in parts of the movement"))
    held = parameter_numbers(every, first.found.p, note=FROM_FILE)
    rows += [row for row in held if row.number not in chosen]
    rows += [*_habit(first.sizes)]
    rows.append(Ran("peak order", float(first.asked.order), "-", "invented", "of the norm that smooths peaks"))
    rows.append(Ran("peak places", float(first.asked.places), "-", "invented", "of an interval, for true peaks"))
    for one in designs:
        prefix = f"{one.name} "
        own = parameter_numbers(every, one.movement.found.p, note="as chosen, or as given", prefix=prefix)
        rows += [row for row in own if row.number.removeprefix(prefix) in chosen - absent]
        if one.design is not None:
            note = "true peak of the person's knee torque at most"
            rows.append(Ran(f"{prefix}limit of the knee", one.design.task.knee, "N m", "derived", note))
        rows += search_numbers(one.movement.found.motions, trials, prefix)
    return rows


def _habit(sizes: HabitSizes) -> list[Ran]:
    units = {"place": "m", "turn": "rad", "lean": "rad", "jerk": "(m/s^3)^-2 and (rad/s^3)^-2", "torque": "1/(N m)^2"}
    counts = dict.fromkeys(("place", "turn", "lean"), "deviation that counts as 1")
    rows = [
        Ran(f"habit {name}", getattr(sizes, name), unit, "invented", counts.get(name, "weight of the square"))
        for name, unit in units.items()
    ]
    note = "of the polynomials through the recorded coordinates"
    return [*rows, Ran("habit degree", float(sizes.degree), "-", "invented", note)]
