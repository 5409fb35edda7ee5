"""Exoskeletons chosen one after the other: without help, share alone, all that varies, for the draws, and the front."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.design.chosen import ALONE, BEST, ROBUST, WORN, CertifiedDesign, DrawnGain
from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.analyses.sit_to_stand.design.read import TrialsToHelp
from geocontact.analyses.sit_to_stand.design.result import StandingDesignResult
from geocontact.analyses.sit_to_stand.design.words import doubt, say
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.data.errors import InputError
from geocontact.dynamics.collocation.solve import SolverOptions, stopped_by_ctrl_c
from geocontact.standing_up.assistance.assisted_model import SHARE, assisted_model, seen_assisted
from geocontact.standing_up.assistance.design import KNEE, HelpDesign, HelpTask, designed
from geocontact.standing_up.assistance.movement import Movement, Movements, StoppedByHandError
from geocontact.standing_up.assistance.peaks import MEASURES
from geocontact.standing_up.judged import judged
from geocontact.standing_up.phase import PhaseProblem

TOLERANCE = 1e-8
Vector = Float[np.ndarray, " p"]


def run(given: TrialsToHelp, o: StandingDesignOptions, record: Record) -> StandingDesignResult:
    """Every design; InputError where the person does not stand up with the given parameters.

    Ctrl-C ends the search: what was found until then is the result. KeyboardInterrupt where nothing was.
    """
    with record.listener.stages("choosing") as stage:
        search = _DesignSearch(given, o, stage)
        with stopped_by_ctrl_c(search):
            worn = search.worn()
            designs = [worn, *search.chosen(worn)]
            front = search.front(worn, next(one for one in designs[::-1] if one.name != ROBUST))
            draws = search.drawn(designs)
    result = StandingDesignResult(
        record=record, options=o, given=given, model=search.model, designs=tuple(designs), front=front, draws=draws
    )
    doubt(result, stopped=search.stop)
    say(result, search.movements.solved, search.movements.seconds)
    return result


class _DesignSearch:
    """The trials' movements, and designs that are sought with them.

    Once `stop` is set by Ctrl-C it begins nothing new.
    """

    def __init__(self, given: TrialsToHelp, o: StandingDesignOptions, stage: Callable[[str], None]) -> None:
        self.given, self.o, self.stage, self.now, self.stop = given, o, stage, WORN, False
        self.model = assisted_model(given.trials.subject)
        options = SolverOptions("radau", o.degree, 1, TOLERANCE, o.iterations, o.time_limit)
        trials = given.trials
        self.movements = Movements(self.model, trials.subject, trials.trials, options, o.nodes, self._told)
        rng = np.random.default_rng(o.seed)
        self.sets = np.array([given.p + given.sd * rng.normal(size=len(given.p)) for _ in range(o.draws)])

    def _told(self) -> None:
        self.stage(f"{self.now}, movement {self.movements.solved + 1}")
        if self.stop:
            raise StoppedByHandError("interrupted")

    def worn(self) -> CertifiedDesign:
        without = self.given.p.copy()
        without[SHARE] = 0.0
        try:
            movement = self.movements.finely_at(without)
        except StoppedByHandError as error:
            raise KeyboardInterrupt from error
        except ArithmeticError as error:
            remedy = "check that they are of this person"
            raise InputError(self.o.parameters, "", f"nobody stands up with these: {error}", remedy) from error
        return self._certified(WORN, float("nan"), None, movement)

    def chosen(self, worn: CertifiedDesign) -> list[CertifiedDesign]:
        """Share alone, then everything, then for the draws too; KeyboardInterrupt where Ctrl-C came before any."""
        found: list[CertifiedDesign] = []
        every = (BEST, self.o.varied)
        for name, vary in [every] if self.o.varied == ("share",) else [(ALONE, ("share",)), every]:
            found += self._sought(name, worn, self.o.knee, vary, _start(found[-1]) if found else self.given.p[None])
        if not found:
            raise KeyboardInterrupt
        if self.o.robust:
            sets = np.vstack([_start(found[-1]), self.sets])
            found += self._sought(ROBUST, worn, self.o.knee, self.o.varied, sets)
        return found

    def front(self, worn: CertifiedDesign, best: CertifiedDesign) -> tuple[CertifiedDesign, ...]:
        """From no more than without help on down to the limit that was asked for."""
        limits = np.linspace(1.0, self.o.knee, self.o.front + 1)[:-1]
        found = [best]
        for limit in limits[::-1]:
            found += self._sought(f"knee at {limit:.3g}", worn, float(limit), self.o.varied, _start(found[-1]))
        return tuple(found[:0:-1])

    def drawn(self, designs: list[CertifiedDesign]) -> tuple[DrawnGain, ...]:
        """Draws by the exoskeleton that the gain is over and by the last; those without a movement are left out."""
        reference, last = designs[1] if len(designs) > 2 else designs[0], designs[-1]
        found: list[DrawnGain] = []
        index = HelpTask(self.o.varied, self.o.aim, 1.0).index
        aim = MEASURES.index(self.o.aim)
        for k, row in enumerate([] if self.stop else self.sets):
            self.now = f"draw {k + 1}"
            values = []
            for one in (reference, last):
                p = row.copy()
                p[SHARE:] = one.movement.found.p[SHARE:]
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
                        float(first.sizes[aim]),
                        float(second.sizes[aim]),
                        float(second.sizes[KNEE]),
                        float(first.largest[aim]),
                        float(second.largest[aim]),
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
            found = designed(self.movements, sets, HelpTask(vary, self.o.aim, knee))
        except StoppedByHandError:
            self.stop = True
            return []
        except ArithmeticError as error:
            remedy = "vary less, or give more `nodes`"
            raise InputError("", f"`vary`, {name}", f"a movement is not found: {error}", remedy) from error
        self.stop |= found.stopped
        return [self._certified(name, limit, found, found.movements[0])]

    def _certified(self, name: str, limit: float, found: HelpDesign | None, movement: Movement) -> CertifiedDesign:
        self.stage(f"{name}, certificate")
        standing, n = self.model.standing, self.model.standing.count
        phase = PhaseProblem(movement.problem, {}, standing.parameters, ())
        seen = judged(standing.equations, self.model.controlled, standing.turning, phase, movement.found)
        trials = tuple(
            TrialResult(
                recorded=trial,
                model=seen_assisted(self.model, motion, movement.found.p, trial.time, trial.name),
                points=seen_assisted(self.model, motion, movement.found.p, motion.held_times, trial.name),
                acceleration=motion.state(motion.held_times)[:, 2 * n : 3 * n],
                judged=each,
            )
            for trial, motion, each in zip(self.given.trials.trials, movement.found.motions, seen, strict=True)
        )
        return CertifiedDesign(name, limit, found, movement, trials)


def _start(one: CertifiedDesign) -> Float[np.ndarray, "s p"]:
    return one.movement.found.p[None]
