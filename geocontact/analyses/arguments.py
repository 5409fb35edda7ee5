"""Arguments of a call from Python that fit no option, or lack one: one line with the name that was meant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches

from geocontact.analyses.options import Options, declared

ALIKE = 0.6
"""Least similarity (0 to 1, Ratcliff and Obershelp) of a name that is suggested."""


def require_arguments(
    command: str, options: type[Options], inputs: Sequence[object], named: Mapping[str, object]
) -> None:
    """TypeError that names every argument that is unknown, given twice or missing, and the nearest one there is."""
    known = [one for one in declared(options) if one.settable]
    places = [one.name for one in known if one.positional]
    given = {*places[: len(inputs)], *named}
    names = [one.name for one in known]
    wrong = [_unknown(name, [each for each in names if each not in given]) for name in named if name not in names]
    wrong += [f"`{name}` is given twice" for name in places[: len(inputs)] if name in named]
    if len(inputs) > len(places):
        wrong.append(f"{len(inputs)} arguments without a name, where only {_listed(places)} can do without")
    missing = [one.name for one in known if one.required and one.name not in given]
    if missing:
        wrong.append(f"{_listed(missing)} {'is' if len(missing) == 1 else 'are'} missing")
    if wrong:
        raise TypeError(f"{command}: {'; '.join(wrong)}")


def _unknown(name: str, names: Sequence[str]) -> str:
    near = get_close_matches(name, names, n=1, cutoff=ALIKE)
    meant = f" (did you mean `{near[0]}`?)" if near else f" (there are {_listed(names)})"
    return f"there is no argument `{name}`{meant}"


def _listed(names: Sequence[str]) -> str:
    quoted = [f"`{name}`" for name in names]
    return " and ".join([", ".join(quoted[:-1]), quoted[-1]] if len(quoted) > 1 else quoted)
