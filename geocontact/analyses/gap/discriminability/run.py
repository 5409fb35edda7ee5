"""What the trials of a gap case can tell."""

from __future__ import annotations

from geocontact.analyses.gap.discriminability.options import DiscriminabilityOptions
from geocontact.analyses.gap.discriminability.read import Question
from geocontact.analyses.gap.discriminability.result import DiscriminabilityResult
from geocontact.analyses.gap.discriminability.words import confusion_sentences, sizes_sentence
from geocontact.analyses.run_record import Record
from geocontact.gap.identifiability.discriminability import discriminability, offered


def run(question: Question, o: DiscriminabilityOptions, record: Record) -> DiscriminabilityResult:
    """Every effect on top of the base model, and what is found in words."""
    case, system, names = question.given.case, question.given.system, question.effects
    with record.listener.progress("effects", 2 * len(offered(system, names))) as step:
        found = discriminability(case, system, names, o.nats, step)
    for sentence in (*confusion_sentences(found), sizes_sentence(found)):
        if sentence:
            record.say(sentence)
    return DiscriminabilityResult(record=record, options=o, case=case, found=found)
