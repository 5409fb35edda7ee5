"""What trials can tell, in sentences: what is seen, what is swallowed, what is told apart, and from which size on."""

from __future__ import annotations

from geocontact.analyses.gap.words import names, percent, proposal_words
from geocontact.gap.identifiability.detectability import POWER, Detectability
from geocontact.gap.identifiability.discriminability import Discriminability
from geocontact.gap.identifiability.signatures import rest_of
from geocontact.gap.levels import APART


def confusion_sentences(c: Discriminability) -> list[str]:
    """One sentence each, without a full stop: how many are seen, which never, swallowed, confused; what to record."""
    never = [one.candidate.label for one in c.detectabilities if one.smallest is None]
    count = len(c.detectabilities)
    said = [f"of {count} effects and variants these trials show {count - len(never)}, if they are large enough"]
    if never:
        said.append(f"not to be seen at any plausible size: {names(never)}")
    if c.absorbed:
        said.append(
            f"base parameters imitate nearly all of {names(c.absorbed)}: they leave wrong parameters, hardly a gap"
        )
    if c.mistakes:
        said.append(f"mistakes in the data that would leave a gap, made in all trials: {names(c.mistakes)}")
    said += [f"not to be told apart (less than {APART:g} nats between any two): {names(one)}" for one in c.classes]
    if not c.classes and len(c.effects) > 1:
        said.append(f"any two of these effects would be told apart by {APART:g} nats or more, one way round at least")
    if c.proposal is not None:
        said.append(proposal_words(c.proposal, c.found.answer.verdict))
    return said


def sizes_sentence(c: Discriminability) -> str:
    """How large every effect that is seen must be; empty where none is."""
    seen = [amplitude_words(one) for one in c.detectabilities if one.smallest is not None]
    return f"predicted to be seen in {percent(POWER)} of 100 repetitions: {'; '.join(seen)}" if seen else ""


def amplitude_words(one: Detectability) -> str:
    """ "damping from damping.b = 0.83 N s/m on"; an amplitude that shrinks as the effect grows is an upper limit."""
    p, rest = one.candidate.parameters[0], rest_of(one.candidate)
    on = "down" if one.at.amplitude < rest and p.lower >= 0.0 else "on"
    return f"{one.candidate.label} from {p.name} = {size_words(one)} {on}"


def size_words(one: Detectability) -> str:
    """ "0.83 N s/m": the amplitude with its unit, if it has one."""
    unit = one.candidate.parameters[0].unit
    return f"{one.at.amplitude:.3g}".replace("-", "−") + ("" if unit == "-" else f" {unit}")
