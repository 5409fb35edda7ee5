"""Where the cases of a benchmark come from: the generator of planted cases, or a folder that is simulated anew.

A folder (`case.toml` and trials, one without an effect) stands in where a system has no planted cases: the base model
is fitted to it, an effect of the candidates' own form is added, and its trials are recorded anew. That is an easier
task than a planted case, whose effects have other forms.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.data.gap_case import GapCase
from geocontact.gap.identifiability.signatures import at_nats

NOTHING, CONFOUNDED = "none", "absorbed"
BESIDES = 0.5  # of the nats asked for that an effect must at least show


def is_folder(source: str) -> bool:
    """Whether a source is a folder, not the name of a system."""
    return (Path(source) / "case.toml").is_file()


def name_of(source: str) -> str:
    """What is written of it: the system, or the name of the folder."""
    return Path(source).name if is_folder(source) else source


def bare_case(source: str, seed: int, place: int) -> GapCase:
    """A case without an effect; of a folder always the same."""
    from geocontact.gap_benchmark.synthetic.cases import synthetic_case
    from geocontact.io.cases.gap_case import read_gap_case

    if is_folder(source):
        return read_gap_case(Path(source))
    return synthetic_case(source, "none", np.random.SeedSequence(seed, spawn_key=(place,))).case


def known_to(source: str) -> tuple[str, ...]:
    """Effects of the vocabulary that the system of a source may have."""
    from geocontact.gap.identifiability.discriminability import offered
    from geocontact.gap_benchmark.synthetic.catalogue import plans
    from geocontact.systems.catalogue import system_of

    if is_folder(source):
        return tuple(dict.fromkeys(one.name for one in offered(system_of(bare_case(source, 0, 0)))))
    return tuple(dict.fromkeys(one.name for one in plans(source)))


def effects_of(source: str) -> tuple[str, ...]:
    """Those of them that a case of this source can have, none that base parameters always swallow."""
    from geocontact.gap_benchmark.synthetic.catalogue import CONFOUNDED, NO_GAP

    hidden = () if is_folder(source) else (*NO_GAP.get(source, ()), *CONFOUNDED[source])
    return tuple(name for name in known_to(source) if name not in hidden)


def has_confounded(source: str) -> bool:
    """Whether it has cases of effects that base parameters swallow."""
    return not is_folder(source)


def case_with(source: str, effect: str, nats: float, seed: int, place: int) -> GapCase | None:
    """A case with one effect, so visible; "absorbed" for one that is swallowed, "none" for none.

    None where the effect cannot be so visible, or where a folder has no such case.
    """
    from geocontact.gap_benchmark.synthetic.cases import NotFoundError, synthetic_case

    if is_folder(source):
        return None if effect == CONFOUNDED else _simulated(source, effect, nats, seed, place)
    kind = effect if effect in (NOTHING, CONFOUNDED) else "single"
    sequence = np.random.SeedSequence(seed, spawn_key=(place,))
    try:
        return synthetic_case(source, kind, sequence, *((effect, nats) if kind == "single" else ())).case
    except NotFoundError:
        return None


def _simulated(folder: str, effect: str, nats: float, seed: int, place: int) -> GapCase | None:
    """The case of a folder recorded anew, with an effect of a candidate's form."""
    from benchmarks.gap.simulated import case_of
    from geocontact.effects.catalogue import candidates
    from geocontact.gap.case.admission import admitted
    from geocontact.gap.case.preparation import problem_of
    from geocontact.gap.identifiability.signatures import base_state_of
    from geocontact.gap.selection.model_comparison import base_contender
    from geocontact.systems.catalogue import system_of

    case = bare_case(folder, seed, place)
    case = admitted(case, system_of(case))
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    key = int(np.random.SeedSequence(seed, spawn_key=(place,)).generate_state(1)[0])
    if effect == NOTHING:
        return case_of(case, problem, base.noise, problem.system, base.model.values, key)
    ground = base_state_of(problem, base.noise, base.model.values)
    sized = [at_nats(ground, one, nats) for one in candidates(problem.system) if one.name == effect and one.parameters]
    seen = [one for one in sized if one.visible > BESIDES * nats]
    if not seen:
        return None
    chosen = seen[place % len(seen)]
    values = {**base.model.values, **chosen.values}
    return case_of(case, problem, base.noise, chosen.candidate.apply(problem.system), values, key)
