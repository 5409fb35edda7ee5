"""What a synthetic case is the answer to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, get_args

from geocontact.data.gap.case import GapCase
from geocontact.gap_benchmark.synthetic.ideal import IdealTrial

Kind = Literal["none", "single", "pair", "outside", "absorbed", "fault", "shift"]
KINDS: tuple[Kind, ...] = get_args(Kind)
"""none: nothing left out. single, pair: one or two rows of the vocabulary. outside: no row of it. absorbed: a row that
base parameters reproduce. fault: a discrete mistake in the data. shift: single, evaluation trials faster or larger."""


@dataclass(frozen=True)
class Label:
    """The truth about a synthetic case.

    Parameters
    ----------
    kind
        Which sort of case.
    effects
        Names of the vocabulary; () for none and outside, also where base parameters reproduce an effect they are named.
    words
        What was planted, for people.
    nats
        Visibility of each effect alone: half the squared norm of its signature on the calibration trials after the
        base parameters were refitted, whitened by sensor noise, propagated input noise and trial-to-trial variation.
        Outside the vocabulary it stands under "outside".
    nats_anew
        The same of the one effect, were everything placed anew in every trial as is usual (a millimetre, half a degree,
        a per cent of a calibration), whatever the laboratory does. None where it is not one.
    swallowed
        Share of the signature's energy (whitened by noise alone) that refitted base parameters take away.
    rmse_before, rmse_after, reduction
        Per channel, on fresh trials of the evaluation kind: the base refitted to the calibration trials, and the true
        simulator at its nominal parameters, both predicting from measured inputs. None where there is no such thing.
    window
        Shortest phase window that holds 70 % of a channel's squared gap on the fresh trials, noise left out.
    shares
        Part of each channel in the whole squared gap, channels in units of their floor.
    floor
        Per channel: sensor noise, input noise and trial-to-trial variation together, root mean square.
    faulty
        Names of the trials that hold a mistake in the data.
    imitated
        Whether some candidate reproduces an effect outside the table; who scores fills it in.
    """

    kind: Kind
    effects: tuple[str, ...]
    words: str
    nats: Mapping[str, float]
    swallowed: Mapping[str, float]
    rmse_before: Mapping[str, float | None]
    rmse_after: Mapping[str, float | None]
    reduction: Mapping[str, float | None]
    window: Mapping[str, tuple[float, float]]
    shares: Mapping[str, float]
    floor: Mapping[str, float]
    faulty: tuple[str, ...] = ()
    imitated: bool | None = None
    details: Mapping[str, str | float] = field(default_factory=dict)
    nats_anew: float | None = None

    def as_dict(self) -> dict[str, Any]:
        """Plain numbers, words, lists and dicts, as JSON takes them."""
        return {**asdict(self), "effects": list(self.effects), "faulty": list(self.faulty)}


@dataclass(frozen=True)
class SyntheticCase:
    """A synthetic case, the truth about it, and its calibration trials without noise."""

    case: GapCase
    label: Label
    ideal: tuple[IdealTrial, ...] = ()
