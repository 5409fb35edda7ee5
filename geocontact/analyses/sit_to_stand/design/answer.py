"""The answer of a choice in sentences and tiles: the strap's aim, the knee's limit, what a looser limit would save."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from geocontact.analyses.frame.words import rounded

SAVES = 0.1
"""Part of the aim that a looser limit of the knee has to save before it is named first."""
MOST = 0.9
"""Where several do, the tightest that has so much of the largest saving is named."""
ACTS = 0.005
"""How far the knee stays below a limit that does not act, as a part of its peak without help."""


@dataclass(frozen=True)
class AnsweredDesign:
    """Aim and knee of one design.

    Parameters
    ----------
    limit
        Of the knee's true peak, as part of that without help.
    aim
        What is least, in its unit.
    knee
        The knee's true peak, as part of that without help.
    """

    name: str
    limit: float
    aim: float
    knee: float


def answer(what: str, unit: str, designs: Sequence[AnsweredDesign], front: Sequence[AnsweredDesign]) -> list[str]:
    """What was reached and what it is compared with, the bargain at a looser limit, and where the limit stops acting.

    Parameters
    ----------
    what
        Name of the aim, such as "peak force of the strap".
    designs
        Without help first, what was chosen last.
    front
        Best designs at looser limits of the knee.
    """
    without, *others, best = designs
    beside = ", ".join(
        [f"{without.aim:.3g} {unit} without help", *(f"{d.aim:.3g} {unit} with {d.name}" for d in others)]
    )
    lines = [f"the {what} is {best.aim:.3g} {unit} ({beside}), with the knee at {best.knee:.0%} of its peak"]
    loose = sorted((one for one in front if one.limit > best.limit), key=lambda one: one.limit)
    saving = [one for one in loose if one.aim <= (1.0 - SAVES) * best.aim]
    if saving:
        least = min(one.aim for one in saving)
        named = next(one for one in saving if best.aim - one.aim >= MOST * (best.aim - least))
        lines.append(f"with the knee at {named.knee:.0%} instead of {best.knee:.0%} it is {named.aim:.3g} {unit}")
    free = [one for one in loose if one.knee < one.limit - ACTS]
    if free:
        lines.append(f"the limit of the knee has no effect above {max(one.knee for one in free):.1%}")
    return lines


def tiles(
    what: str, unit: str, designs: Sequence[AnsweredDesign], chosen: Sequence[tuple[str, float, str]]
) -> list[tuple[str, str]]:
    """Aim and knee of the chosen design beside those without help, and the chosen numbers; five at most."""
    without, best = designs[0], designs[-1]
    found = [
        (what, f"{best.aim:.3g} {unit} ({without.aim:.3g} {unit} without help)"),
        ("true peak of the knee", f"{best.knee:.1%} of that without help"),
    ]
    return [*found, *((name, f"{rounded(value, 3)} {of}".strip()) for name, value, of in map(readable, chosen))][:5]


def readable(number: tuple[str, float, str]) -> tuple[str, float, str]:
    """A length in mm, all else as it is."""
    name, value, unit = number
    return (name, 1e3 * value, "mm") if unit == "m" else number


def at_bounds(
    chosen: Sequence[tuple[str, float, str]], ended: Sequence[bool], room: Mapping[str, tuple[float, float]]
) -> list[str]:
    """Numbers that ended at a bound of what can be built: "place is at its upper bound 340 mm"."""
    lines = []
    for number, end in zip(chosen, ended, strict=True):
        name, value, _ = number
        least, most = room[name]
        side = "upper" if abs(value - most) < abs(value - least) else "lower"
        _, bound, unit = readable((name, most if side == "upper" else least, number[2]))
        if end:
            lines.append(f"{name} is at its {side} bound {rounded(bound, 3)} {unit}".strip())
    return lines
