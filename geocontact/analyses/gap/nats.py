"""Evidence in words: what nats are as odds, and how far the first of a ranking is ahead of the second."""

from __future__ import annotations

import math
from collections.abc import Sequence

from geocontact.data.diagnosis_evidence import Ranked

ODDS = (
    "Evidence is in nats: with 3 nats the data are e³ = 20 times as probable under the one model as under the other, "
    "with 6 nats 400 times, with 20 nats e²⁰ = 500 million times."
)
"""Stands where nats come first on a page."""
DECIDES = 3.0
"""Nats below which a difference decides nothing: odds of less than 20 to 1."""
LARGE = 6
"""Powers of ten from which odds are said as one."""
SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def odds_words(nats: float) -> str:
    """ "20 times", "3000 times", "10⁸ times": how much more probable so many nats make the data.

    >>> odds_words(3.0), odds_words(6.0), odds_words(0.3), odds_words(20.0)
    ('20 times', '400 times', '1.3 times', '5 × 10⁸ times')
    """
    power = nats / math.log(10.0)
    if power < LARGE:
        digits = 2 if math.exp(nats) < 10.0 else 1
        return f"{float(f'{math.exp(nats):.{digits}g}'):g} times"
    whole = math.floor(power)
    first = round(10.0 ** (power - whole)) if power < 100.0 else 1
    first, whole = (1, whole + 1) if first == 10 else (first, whole)
    lead = f"{first} × " if first > 1 else ""
    return f"{lead}10{str(whole).translate(SUPERSCRIPTS)} times"


def ahead_words(ranking: Sequence[Ranked], named: Sequence[str]) -> str:
    """How far what is named is ahead of the best model without it; "" where nothing is named, or nothing is compared.

    Parameters
    ----------
    ranking
        The largest gain first.
    named
        Effects of the answer.
    """
    effects = frozenset(named)
    first = next((one for one in ranking if effects and frozenset(one.effects.split(" + ")) == effects), None)
    second = next((one for one in ranking if not effects <= frozenset(one.effects.split(" + "))), None)
    if first is None or second is None:
        return ""
    by = first.gain - second.gain
    if by < 0.0:
        return f"{first.label} is {-by:.1f} nats behind {second.label}, which a rule keeps from being named."
    said = f"{first.label} is {by:.1f} nats ahead of {second.label}, the best model without it: the data are "
    few = f" A difference of less than {DECIDES:g} nats decides nothing." if by < DECIDES else ""
    return f"{said}{odds_words(by)} as probable with it.{few}"
