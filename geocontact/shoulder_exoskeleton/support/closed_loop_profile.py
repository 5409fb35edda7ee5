"""A profile that is best in the simulation, too: linear program, simulation, correction, again until both agree.

A linear program needs the torque on the arm as own + A x. Without a simulation it is the cylinder's torque at the human
elevation: the device's own weight, its passive joints and what the cuff loses are missing, and so a tenth to a quarter
of the torque. Here every arm is simulated in closed loop under the profile of the program before. From then on A has
the elevation of the device's own arm and the phases that its controller detects, times a gain at each moment, and own
is what the simulation gives besides: at the profile that was simulated the corrected program and the simulation are
the same, moment by moment. The gain is how much more torque reaches the arm for more of the cylinder's, from two
simulations under the arm's own best profile, so that no other arm has a part in it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float, Int

from geocontact.shoulder_exoskeleton.device import Device
from geocontact.shoulder_exoskeleton.support.arm_trial import (
    ArmTrial,
    ModelError,
    Support,
    Transfer,
    support_case,
    varied_case,
)
from geocontact.shoulder_exoskeleton.support.best_profile import (
    Aim,
    SupportProfile,
    best_profile,
    measured,
    passed,
    scaled,
)
from geocontact.shoulder_exoskeleton.support.controlled_arm import SimulatedSupport, simulated_support
from geocontact.shoulder_exoskeleton.support.outcome import Factors
from geocontact.shoulder_exoskeleton.support.profile_limits import ACTS, Among, FactorKey, Limits, SupportCase

ROUNDS = 12
"""Programs and simulations until they must agree; two to four do."""
SLACK = 0.01
"""N m by which a limit may be passed in the simulation."""
WORTH = 3e-3
"""Share of the torque for which another round is made."""
LESS = 0.8
"""Share of its factors under which an arm is simulated once more, for the gain."""
SEEN = 0.2
"""N m of more torque of the cylinder from which a moment has a gain of its own; elsewhere it is the arm's median."""
GAINS = (0.5, 1.25)
"""Bounds of the gain at a moment: beyond, the cuff has slipped in one simulation and stuck in the other."""
JUMP = 0.2
"""N m beyond a limit that no line foresaw: the cuff slips there."""
PATIENCE = 3
"""Profiles that pass a limit until the best of them is lowered."""
BACK, NUDGED = 0.95, 0.99
"""Times its factors: far beyond a limit, and close to it."""
MORE = (1.05, 1.02)
"""Times the factors of a profile that is tried in the end where programs and simulations have not agreed."""
DRAWS = 60
"""Draws of the model's errors, for a choice that is certain."""

Make = Callable[[Among, Limits, Aim, float], SupportProfile]
"""How a profile is made: `best_profile`, `uniform_profile`."""


@dataclass(frozen=True, eq=False)
class SettledProfile:
    """A profile whose plan and simulation agree.

    Parameters
    ----------
    profile
        Its value is what is planned.
    value
        What is simulated, by the aim.
    runs
        Every arm under it by the trials' names, with exact sensors.
    transfers
        Of the cylinder's torque to the arms, from these runs.
    passed
        By how much the worst limit is passed in the simulation [N m]; at most `SLACK` unless nothing keeps them.
    """

    profile: SupportProfile
    value: float
    runs: Mapping[str, SimulatedSupport]
    transfers: Mapping[str, Transfer]
    passed: float


@dataclass(frozen=True, eq=False)
class ClosedLoop:
    """A device on arms, and what a profile must keep.

    Parameters
    ----------
    error
        What draws are made of, where `limits` ask for certainty.
    seed
        Of these draws; those of a person are the same whoever is beside.
    """

    device: Device
    support: Support
    limits: Limits = field(default_factory=Limits)
    aim: Aim = "mean"
    worst_share: float = 0.25
    error: ModelError = field(default_factory=ModelError)
    draws: int = DRAWS
    seed: int = 0
    _starts: dict[str, Transfer] = field(default_factory=dict)
    _phases: dict[str, Int[np.ndarray, " t"]] = field(default_factory=dict)

    def run(self, trial: ArmTrial, factors: Factors) -> SimulatedSupport:
        """The arm under a profile with exact sensors; ArithmeticError as of `simulated_support`.

        A profile that loses the arm is a result that is `lost`, and keeps no limit.
        """
        found = simulated_support(trial, self.device, factors, guess=self._phases.get(trial.name))
        self._phases[trial.name] = found.arm.phase
        return found

    def start(self, trial: ArmTrial) -> Transfer:
        """Transfer of torque under the arm's own best profile, with the gain there.

        `OutOfCuffError` where the arm is not in its cuff under that: markers, lengths or units are wrong.
        """
        if trial.name not in self._starts:
            own = best_profile([support_case(trial, self.support)], Limits(reserve=self.limits.reserve)).factors
            more, less = self.run(trial, own), self.run(trial, scaled(own, LESS))
            if more.lost:
                simulated_support(trial, self.device, own, strict=True)
            gain = self._gain(trial, (more, own), (less, scaled(own, LESS)))
            self._starts[trial.name] = self.corrected(trial, more, own, gain)
        return self._starts[trial.name]

    def corrected(
        self, trial: ArmTrial, run: SimulatedSupport, factors: Factors, gain: Float[np.ndarray, " t"] | float
    ) -> Transfer:
        """With which the case under these factors is what was simulated."""
        bare = Transfer(run.arm.simulation.elevation, gain)
        given = support_case(trial, self.support, transfer=bare).given(factors)
        return Transfer(bare.elevation, gain, run.torque - given, run.force - given / trial.lever)

    def transfer(self, trial: ArmTrial, factors: Factors) -> Transfer:
        """Outcome of an arm that took no part in making a profile, under it."""
        return self.corrected(trial, self.run(trial, factors), factors, self.start(trial).gain)

    def among(
        self, trials: Sequence[ArmTrial], transfers: Mapping[str, Transfer], scales: Mapping[str, float]
    ) -> Among:
        """What a profile is chosen from."""
        cases = [support_case(each, self.support, transfer=transfers[each.name]) for each in trials]
        persons = dict.fromkeys(each.person for each in trials) if self.limits.certainty > 0.0 else ()
        return Among(cases, {each: self._drawn(each, trials, transfers) for each in persons}, scales)

    def settled(
        self, trials: Sequence[ArmTrial], make: Make = best_profile, scales: Mapping[str, float] | None = None
    ) -> SettledProfile:
        """The profile of these arms; ValueError where no factor keeps the limits, ArithmeticError as of `run`.

        Where the cuff lets an arm go and pushes it up, which no line foresees, the factor of that moment is halved
        towards the last one that was kept; where none has been kept yet, all factors are lowered.
        """
        among = self.among(trials, {each.name: self.start(each) for each in trials}, scales or {})
        gains = {each.name: self.start(each).gain for each in trials}
        transfers = {each.name: self.start(each) for each in trials}
        kept: SettledProfile | None = None
        tried: list[SettledProfile] = []
        slipped, margin = dict[FactorKey, float](), 0.0
        for _ in range(ROUNDS):
            caps = {} if kept is None else {key: 0.5 * (kept.profile.factors[key] + x) for key, x in slipped.items()}
            profile = make(among, replace(self.limits, caps=caps, margin=margin), self.aim, self.worst_share)
            if kept is not None and profile.value - kept.value <= WORTH:
                return kept
            if kept is None and len(tried) >= PATIENCE:
                least = min(tried, key=lambda each: each.passed)
                profile = _times(least.profile, BACK if least.passed > JUMP else NUDGED)
            found, after = self._simulated(trials, profile, gains)
            tried.append(found)
            margin += found.passed if SLACK < found.passed < JUMP else 0.0
            if found.passed <= SLACK and (kept is None or found.value > kept.value):
                kept = found
            jumps = {} if kept is None else self._jumps(trials, found)
            for key in jumps.values():
                slipped[key] = min(profile.factors[key], slipped.get(key, 1.0))
            transfers |= {name: each for name, each in found.transfers.items() if name not in jumps}
            among = self.among(trials, transfers, scales or {}) if jumps else after
        return min(tried, key=lambda each: each.passed) if kept is None else self._raised(trials, kept, gains)

    def _raised(
        self,
        trials: Sequence[ArmTrial],
        kept: SettledProfile,
        gains: Mapping[str, Float[np.ndarray, " t"] | float],
    ) -> SettledProfile:
        """More of a profile as long as it keeps its limits."""
        for scale in MORE:
            for _ in range(ROUNDS):
                found, _ = self._simulated(trials, _times(kept.profile, scale), gains)
                if found.passed > SLACK or found.value <= kept.value:
                    break
                kept = found
        return kept

    def _simulated(
        self,
        trials: Sequence[ArmTrial],
        profile: SupportProfile,
        gains: Mapping[str, Float[np.ndarray, " t"] | float],
    ) -> tuple[SettledProfile, Among]:
        """A profile in the simulation, and what the next one is chosen from."""
        factors = {each.name: profile.of(each.person) for each in trials}
        runs = {each.name: self.run(each, factors[each.name]) for each in trials}
        transfers = {
            each.name: self.corrected(each, runs[each.name], factors[each.name], gains[each.name]) for each in trials
        }
        after = self.among(trials, transfers, profile.scales)
        taken = [(each.person, runs[each.name].outcome.reduction) for each in trials]
        value = measured(taken, self.aim, self.worst_share)
        beyond = passed(after, self.limits, profile.factors)
        if any(each.lost for each in runs.values()):
            beyond = max(beyond, 2.0 * JUMP)
        return SettledProfile(profile, value, runs, transfers, beyond), after

    def _jumps(self, trials: Sequence[ArmTrial], found: SettledProfile) -> dict[str, FactorKey]:
        """By trial that is pushed far beyond what was planned the factor that gives most at the worst moment."""
        names = {}
        for trial in trials:
            case = support_case(trial, self.support, transfer=found.transfers[trial.name])
            factors = found.profile.of(trial.person)
            over = case.support(factors) - (1.0 - self.limits.reserve) * np.maximum(case.needed, 0.0)
            over[np.abs(case.per_factor).max(axis=1) < ACTS] = -np.inf
            if over.max() > JUMP:
                parts = case.per_factor[over.argmax()] * [factors[key] for key in case.keys]
                names[trial.name] = case.keys[int(parts.argmax())]
        return names

    def _gain(
        self, trial: ArmTrial, more: tuple[SimulatedSupport, Factors], less: tuple[SimulatedSupport, Factors]
    ) -> Float[np.ndarray, " t"]:
        cylinder = [
            support_case(trial, self.support, transfer=Transfer(run.arm.simulation.elevation)).given(factors)
            for run, factors in (more, less)
        ]
        change = cylinder[0] - cylinder[1]
        seen = change > SEEN
        gain = np.clip((more[0].torque - less[0].torque)[seen] / change[seen], *GAINS)
        found = np.full(len(change), float(np.median(gain)) if np.any(seen) else 1.0)
        found[seen] = gain
        return found

    def _drawn(
        self, person: str, trials: Sequence[ArmTrial], transfers: Mapping[str, Transfer]
    ) -> list[list[SupportCase]]:
        rng = np.random.default_rng([self.seed, 1, *person.encode()])
        own = [each for each in trials if each.person == person]
        return [
            [varied_case(each, self.support, self.error, rng, transfer=transfers[each.name]) for each in own]
            for _ in range(self.draws)
        ]


def _times(profile: SupportProfile, scale: float) -> SupportProfile:
    return replace(profile, factors=scaled(profile.factors, scale))
