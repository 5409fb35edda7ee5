"""Words that what is said of a gap case is made of."""

from __future__ import annotations

from collections.abc import Sequence

from geocontact.data.gap.diagnosis import NextExperiment


def names(some: Sequence[str], last: str = "and") -> str:
    """`a, b and c`."""
    return f" {last} ".join([", ".join(some[:-1]), some[-1]]) if len(some) > 1 else "".join(some)


def percent(share: float) -> str:
    """A share as a whole percentage, with a minus sign."""
    return f"{100.0 * share:.0f}".replace("-", "−") if round(100.0 * share) else "0"


def proposal_words(one: NextExperiment, verdict: str) -> str:
    """What to record next, and what for: to show what is absorbed where nothing was found, else to tell apart."""
    some = names(one.separates)
    why = f"would show {some}" if verdict == "no_gap" else f"would tell {some} apart"
    return f"next: {one.change}; that {why} by {one.gain_nats:g} nats more"
