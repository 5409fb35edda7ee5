"""What trials can tell at all: which effects they would show, which they cannot tell apart, from which size on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from threadpoolctl import threadpool_limits

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.diagnosis import NextExperiment
from geocontact.data.gap_case import GapCase
from geocontact.effects.catalogue import candidates
from geocontact.gap.attribute import Attribution, Listener, attribute, no_listener
from geocontact.gap.case.admission import admitted
from geocontact.gap.experiment.proposal import Proposal, first_of, proposed
from geocontact.gap.identifiability.detectability import Detectability, detectabilities
from geocontact.gap.identifiability.non_identifiable import confounded, mistakes, shown, visibilities
from geocontact.gap.identifiability.separability import Separation, classes, separations
from geocontact.gap.identifiability.signatures import BaseState, Sized, at_nats, base_state_of
from geocontact.gap.selection.verdict import with_lapses

NATS = 50.0  # visible nats that effects are compared at


@dataclass(frozen=True)
class Discriminability:
    """What was found out about the trials of a case.

    Parameters
    ----------
    found
        The diagnosis that noise and base parameters are taken from.
    ground
        Base model and whitening of all trials.
    effects
        Every candidate asked about, as visible as asked for, or as its bounds let it be.
    separations, classes
        Every one against every other, and those that are not separable.
    detectabilities
        From which amplitude on each is seen.
    absorbed
        Effects, and mistakes in the data, that refitted base parameters reproduce, the most completely reproduced
        first.
    mistakes
        Names of mistakes in the data that would leave a gap in every variant, if made in all calibration trials.
    planned
        What to record next, with the experiment and what it was chosen by.
    """

    found: Attribution
    ground: BaseState
    effects: tuple[Sized, ...]
    separations: tuple[Separation, ...]
    classes: tuple[tuple[str, ...], ...]
    detectabilities: tuple[Detectability, ...]
    absorbed: tuple[str, ...]
    mistakes: tuple[str, ...]
    planned: Proposal | None

    @property
    def proposal(self) -> NextExperiment | None:
        """What to record next, in words and nats."""
        return None if self.planned is None else self.planned.said


def offered(system: System, names: Sequence[str] = ()) -> tuple[Candidate, ...]:
    """Candidates with a parameter, those of some effects only where names are given."""
    return tuple(one for one in known(system, names) if one.parameters)


def known(system: System, names: Sequence[str] = ()) -> tuple[Candidate, ...]:
    """The same with mistakes in the data, which have no parameter."""
    return tuple(one for one in candidates(system) if not names or one.name in names or one.label in names)


def discriminability(
    case: GapCase,
    system: System,
    names: Sequence[str] = (),
    nats: float = NATS,
    step: Callable[[], None] = lambda: None,
    at: Listener = no_listener,
) -> Discriminability:
    """What the trials of a case tell of effects, on one core.

    Noise, deviations of trials and base parameters are those of the diagnosis' answer, so that a gap which is there
    does not pass for noise; effects are set on top of the base model.

    Parameters
    ----------
    case, system
        As for `gap.diagnose.diagnose`.
    names
        Effects or candidates asked about; all where there are none.
    nats
        How visible each effect is taken to be when it is held against others.
    step
        Called twice per candidate.
    at
        Called in words with what is being done, while the case is diagnosed first.
    """
    with threadpool_limits(limits=1):
        found = attribute(admitted(case, system), system, candidates, at)
        found = replace(found, answer=with_lapses(found.answer, found.offered))
        problem, judged = found.clean, found.answer.chosen.judged
        ground = base_state_of(problem, judged.noise, judged.model.values)
        asked = offered(problem.system, names)
        effects = tuple(at_nats(ground, one, nats) for one in asked)
        apart = separations(ground, effects, step)
        wrong = mistakes(problem, known(problem.system, names))
        hidden = tuple(each.name for each in confounded((*visibilities(problem, asked), *wrong), ()))
        seen = detectabilities(ground, offered(problem.system), asked, step)
        planned = proposed(found, first_of(asked, hidden))
    return Discriminability(found, ground, effects, apart, classes(apart), seen, hidden, shown(wrong), planned)
