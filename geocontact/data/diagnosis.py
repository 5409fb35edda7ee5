"""What a diagnosis says: where the gap lies, which effect causes it, how far it shrinks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from geocontact.data.gap_cells import Region

Verdict = Literal["explained", "partly_explained", "no_gap", "unknown", "unresolved"]


@dataclass(frozen=True)
class CellsHeld:
    """The fewest cells of a pressure mat that hold 70 % of a channel's gap.

    Parameters
    ----------
    ids
        The fullest first.
    count
        Of all cells of the mat.
    share, load
        What they hold of the gap, and of the load that the base model expects.
    p_value
        That a gap spread over the mat as the load is would look as concentrated elsewhere, family-wise.
    """

    ids: tuple[str, ...]
    count: int
    share: float
    load: float
    p_value: float

    def as_dict(self) -> dict[str, Any]:
        """Keys of a `where` entry."""
        return {
            "cells": list(self.ids),
            "cells_share": self.share,
            "cells_load": self.load,
            "cells_p_value": self.p_value,
        }


@dataclass(frozen=True)
class Where:
    """One channel with a gap.

    Parameters
    ----------
    channel
        An output.
    phase
        Shortest window of the trial that holds 70 % of the channel's squared gap, 0...1.
    share
        The channel's part of the whole squared gap, each channel in units of its floor.
    p_value
        Of the most significant cell of the channel's gap map, family-wise.
    stage
        Where in the chain the named effect acts; "" when none is named.
    cells
        Where on the surface, of a channel that cells of a mat add up to.
    """

    channel: str
    phase: tuple[float, float]
    share: float
    p_value: float
    stage: str = ""
    cells: CellsHeld | None = None


@dataclass(frozen=True)
class ChannelGap:
    """Size of one channel's gap on the held-out trials, in the channel's SI unit.

    `reduction` and `ci95` are those expected of fresh trials of the same kind; `unexplained` is None where there is too
    little gap to speak of. `unit` is that SI unit, `trials` how many held-out trials have the channel.
    """

    rmse_before: float
    rmse_after: float
    noise_floor: float
    reduction: float
    ci95: tuple[float, float]
    unexplained: float | None
    unit: str = ""
    trials: int = 0

    @property
    def removed(self) -> float:
        """Part of the error that is removed on the held-out trials themselves; 0 where there is no error."""
        return 1.0 - self.rmse_after / self.rmse_before if self.rmse_before > 0.0 else 0.0


@dataclass(frozen=True)
class BudgetPart:
    """Share of one part in a channel's squared error on held-out trials, and its 95 % interval."""

    share: float
    ci95: tuple[float, float]


@dataclass(frozen=True)
class Detected:
    """An effect that is sure, whether it is worth a name or not.

    Parameters
    ----------
    effect
        Its name.
    nats
        Evidence of the model that has it over the one without it.
    channel
        That loses most by it.
    share, ci95
        Of that channel's squared error of the base model on held-out trials, and its 95 % interval.
    """

    effect: str
    nats: float
    channel: str
    share: float
    ci95: tuple[float, float]

    def as_dict(self) -> dict[str, Any]:
        """The content of diagnosis.json."""
        return {
            "effect": self.effect,
            "nats": self.nats,
            "channel": self.channel,
            "share": self.share,
            "ci95": list(self.ci95),
        }


@dataclass(frozen=True)
class Unmodelled:
    """What no effect of the table is, described without a model (`gap.unmodelled`).

    Parameters
    ----------
    kind
        "wandering_zero", "lost_samples" or "unrecorded_load".
    channel
        That it is in.
    share
        Of the channel's squared error, all trials.
    p_value
        That it is chance.
    words
        What, where, how large.
    phase
        Of a load, part of the trial, 0…1.
    trials
        Zero of each trial [the channel's unit], or samples that it lost; empty of a load.
    """

    kind: str
    channel: str
    share: float
    p_value: float
    words: str
    phase: tuple[float, float] | None
    trials: Mapping[str, float]

    def as_dict(self) -> dict[str, Any]:
        """The content of diagnosis.json."""
        return {
            "kind": self.kind,
            "channel": self.channel,
            "share": self.share,
            "p_value": self.p_value,
            "words": self.words,
            "phase": None if self.phase is None else list(self.phase),
            "trials": dict(self.trials),
        }

    @property
    def told(self) -> str:
        """Words, with the share."""
        return f"{self.words}, {self.share:.0%} of its squared error"


@dataclass(frozen=True)
class Estimate:
    """A parameter's value, its 95 % interval, and whether the trials identify it."""

    value: float
    ci95: tuple[float, float]
    unit: str
    identifiable: bool


@dataclass(frozen=True)
class DataErrorFound:
    """A discrete mistake in the data: which, on which channel, in which trials; factor 1 where it is not one."""

    effect: str
    channel: str
    factor: float
    trials: tuple[str, ...]


@dataclass(frozen=True)
class Partial:
    """What known effects explain where something unknown remains beside them.

    Parameters
    ----------
    effects
        One or two.
    gain_nats
        Gain of evidence over the base model.
    removed
        By channel, the part of its error that they remove on trials that were not used, and its 95 % interval.
    """

    effects: tuple[str, ...]
    gain_nats: float
    removed: Mapping[str, tuple[float, tuple[float, float]]]

    def as_dict(self) -> dict[str, Any]:
        """The content of diagnosis.json."""
        removed = {name: {"reduction": part, "ci95": list(ci95)} for name, (part, ci95) in self.removed.items()}
        return {"effects": list(self.effects), "gain_nats": self.gain_nats, "removed": removed}


@dataclass(frozen=True)
class NextExperiment:
    """What to record next.

    Parameters
    ----------
    separates
        Effects that it tells apart, or where none was found, that it would show.
    change
        What to do, in words with numbers.
    gain_nats
        By how much the smallest separation grows.
    share
        Share of repetitions after which all but the true one of these effects are out of question; None where none was
        found.
    """

    separates: tuple[str, ...]
    change: str
    gain_nats: float
    share: float | None = None

    def as_dict(self) -> dict[str, Any]:
        """The content of diagnosis.json."""
        numbers = {"gain_nats": self.gain_nats, "share": self.share}
        return {"separates": list(self.separates), "change": self.change, **numbers}


@dataclass(frozen=True)
class Diagnosis:
    """The answer to a gap case, as in diagnosis.json.

    `probabilities` is a distribution over single answers (effects, "none", "unknown"), `ambiguity` the effects that
    these data cannot tell apart, or, where nothing is named, that gain and may not be named, the best first; `behind`
    by how many nats the evidence of each of them that is not named is behind what is, `apart` by how many these trials
    tell it from that if it is there; `one_law` the classes of what is named, or of the likeliest where too many remain:
    effects that predict the same on these trials, that one first, for each that has such; `absorbed` those that would
    be invisible here, `partial` what known effects explain of a gap that is otherwise unknown, `next_experiment` what
    to record so that it can be identified; None where nothing is in question, or nothing that is simulated tells
    enough. `budget` is what the squared error on held-out trials consists of, by channel and part: `sensor`, `inputs`,
    `variation`, `effects`, `unexplained`; `detected` the effects that are sure, named or not;
    `unmodelled` what no effect is, in words; `regions` where the base model misses something;
    `thinned` how long trials were averaged and left out.
    """

    case: str
    system: str
    verdict: Verdict
    effects: tuple[str, ...]
    probabilities: Mapping[str, float]
    ambiguity: tuple[str, ...]
    absorbed: tuple[str, ...]
    where: tuple[Where, ...]
    gap: Mapping[str, ChannelGap]
    parameters: Mapping[str, Estimate]
    seconds: float
    version: str
    faults: tuple[DataErrorFound, ...] = ()
    remarks: tuple[str, ...] = field(default=())
    next_experiment: NextExperiment | None = None
    partial: Partial | None = None
    behind: Mapping[str, float] = field(default_factory=dict)
    one_law: tuple[tuple[str, ...], ...] = ()
    apart: Mapping[str, float] = field(default_factory=dict)
    budget: Mapping[str, Mapping[str, BudgetPart]] = field(default_factory=dict)
    detected: tuple[Detected, ...] = ()
    unmodelled: tuple[Unmodelled, ...] = ()
    regions: tuple[Region, ...] = ()
    thinned: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """Plain dicts, lists, strings, numbers and None, ready for JSON."""
        return {
            "case": self.case,
            "system": self.system,
            "verdict": self.verdict,
            "effects": list(self.effects),
            "probabilities": dict(self.probabilities),
            "ambiguity": list(self.ambiguity),
            "behind": dict(self.behind),
            "one_law": [list(group) for group in self.one_law],
            "apart": dict(self.apart),
            "absorbed": list(self.absorbed),
            "where": [
                {"channel": w.channel, "phase": list(w.phase), "share": w.share, "p_value": w.p_value}
                | ({"stage": w.stage} if w.stage else {})
                | ({} if w.cells is None else w.cells.as_dict())
                for w in self.where
            ],
            "gap": {
                name: {
                    "rmse_before": g.rmse_before,
                    "rmse_after": g.rmse_after,
                    "noise_floor": g.noise_floor,
                    "reduction": g.reduction,
                    "ci95": list(g.ci95),
                    "unexplained": g.unexplained,
                }
                for name, g in self.gap.items()
            },
            "budget": {
                channel: {name: {"share": part.share, "ci95": list(part.ci95)} for name, part in parts.items()}
                for channel, parts in self.budget.items()
            },
            "detected": [one.as_dict() for one in self.detected],
            "unmodelled": [one.as_dict() for one in self.unmodelled],
            "regions": [one.as_dict() for one in self.regions],
            "parameters": {
                name: {"value": e.value, "ci95": list(e.ci95), "unit": e.unit, "identifiable": e.identifiable}
                for name, e in self.parameters.items()
            },
            "partial": None if self.partial is None else self.partial.as_dict(),
            "next_experiment": None if self.next_experiment is None else self.next_experiment.as_dict(),
            "faults": [
                {"effect": f.effect, "channel": f.channel, "factor": f.factor, "trials": list(f.trials)}
                for f in self.faults
            ],
            "remarks": list(self.remarks),
            "thinned": list(self.thinned),
            "seconds": self.seconds,
            "version": self.version,
        }
