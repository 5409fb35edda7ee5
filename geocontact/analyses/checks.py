"""Options that would do nothing are mistakes: the user believes that they did something."""

from __future__ import annotations

from geocontact.data.errors import InputError

Idle = tuple[bool, str, str, str]
"""Whether it is so, the option, what is wrong with it, the remedy."""


def bootstrap_rule(count: int, usual: int) -> Idle:
    """Replicates that are neither none nor enough."""
    what, remedy = f"{count} is not 100 to 100000", f"give {usual}, or 0 for none"
    return (count != 0 and not 100 <= count <= 100_000, "`bootstrap`", what, remedy)


def refuse(*rows: Idle) -> None:
    """Refuse the first of these mistakes that is made."""
    for wrong, option, what, remedy in rows:
        if wrong:
            raise InputError("", option, what, remedy)
