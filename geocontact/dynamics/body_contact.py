"""Forces between two bodies of a tree: what acts on one acts back on the other, at the same place."""

from __future__ import annotations

from typing import TYPE_CHECKING

from geocontact.data.multibody.model import GROUND
from geocontact.dynamics.inverse_dynamics import Wrenches

if TYPE_CHECKING:
    from casadi import SX


def action_and_reaction(on: str, by: str, force: SX, place: SX) -> dict[str, tuple[SX, SX]]:
    """Loads on both bodies: force [N] at a place [m] on one, the opposite on the other, in the ground's frame.

    Either may be the ground, which is left out.
    """
    from casadi import cross

    moment = cross(place, force)
    both = {on: (force, moment), by: (-force, -moment)}
    return {body: wrench for body, wrench in both.items() if body != GROUND}


def together(*loads: Wrenches) -> dict[str, tuple[SX, SX]]:
    """Loads of several causes, added body by body."""
    found: dict[str, tuple[SX, SX]] = {}
    for each in loads:
        for body, (force, moment) in each.items():
            had = found.get(body)
            found[body] = (force, moment) if had is None else (had[0] + force, had[1] + moment)
    return found
