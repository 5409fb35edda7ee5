"""Exoskeletons sought one after the other: without help, share alone, all that varies, for the draws, and the front."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import norm

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.sit_to_stand.design.designs import ALONE, BEST, ROBUST, WORN, CertifiedDesign, DrawnGain
from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.analyses.sit_to_stand.standing_trials import StandingUpTrials, standing_trials
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.data.errors import InputError
from geocontact.dynamics.collocation.solve import SolverOptions
from geocontact.io.recordings.spheres import read_contact_intervals, read_contact_parameters
from geocontact.standing_up.assistance_design import KNEE, HelpDesign, HelpTask, designed
from geocontact.standing_up.assisted_model import ASSISTANCE_PARAMETERS, SHARE, assisted_model, seen_assisted
from geocontact.standing_up.assisted_movement import MEASURES, Movement, Movements, StoppedByHandError
from geocontact.standing_up.exoskeleton import WORN_PARAMETERS
from geocontact.standing_up.phase import PhaseProblem, judged
from geocontact.standing_up.strap_sites import searched, usual

LEVEL = 0.95
"""Probability of a calibration's intervals."""
TOLERANCE = 1e-8
Vector = Float[np.ndarray, " p"]


@dataclass(frozen=True, eq=False)
class TrialsToHelp:
    """Trials whose movement is to be kept.

    Parameters
    ----------
    p
        What is searched of all parameters of the assisted model, help as it usually is.
    sd
        Standard deviations of those that the calibration has intervals of, 0 for the others.
    """

    trials: StandingUpTrials
    p: Float[np.ndarray, " p"]
    sd: Float[np.ndarray, " p"]


def read(o: StandingDesignOptions) -> TrialsToHelp:
    """Everything the options name; InputError where no exoskeleton is worn or draws lack intervals."""
    trials = standing_trials(o.study, "study", o.c3d_unit)
    if not trials.exoskeleton:
        what, remedy = "is not of a person with an exoskeleton", "write exoskeleton = true, and torques and strap"
        raise InputError(o.study, "", what, remedy)
    if len(trials.sites) > 1:
        remedy = f"leave out {', '.join(f'strap_{site.name}' for site in trials.sites[1:])}"
        raise InputError(o.study, "", "a design has one strap, at the thigh", remedy)
    if trials.seated:
        remedy = "leave sitting out: a movement that is kept begins at seat-off"
        raise InputError(o.study, "sitting", "has no effect on a design", remedy)
    bounds = {each.name: (each.least, each.most) for each in WORN_PARAMETERS}
    values = read_contact_parameters(o.parameters, {each.name: each.unit for each in WORN_PARAMETERS}, bounds)
    ends = read_contact_intervals(o.parameters, values)
    add_input("`parameters`", o.parameters, parameters=len(values))
    if o.draws and not ends:
        remedy = "give parameters.csv of a calibration, or no draws"
        raise InputError(o.parameters, "lower, upper", "has no intervals to draw from", remedy)
    p = searched(WORN_PARAMETERS, [values[each.name] for each in WORN_PARAMETERS])
    reach = 2.0 * float(norm.ppf(0.5 + 0.5 * LEVEL))
    sd = np.zeros(len(p))
    for k, each in enumerate(WORN_PARAMETERS):
        if each.name in ends:
            low, high = (each.searched(end) for end in ends[each.name])
            sd[k] = (high - low) / reach
    return TrialsToHelp(trials, np.r_[p, usual(ASSISTANCE_PARAMETERS)], np.r_[sd, np.zeros(len(ASSISTANCE_PARAMETERS))])


class DesignSearch:
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
        """Without help; KeyboardInterrupt where Ctrl-C came before it was there."""
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
