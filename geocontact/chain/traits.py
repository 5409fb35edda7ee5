"""What effects ask of a system beyond its links: roles of its channels, which way it pushes, sizes that are plausible.

Effects read these; none asks for the name of a system. A system says only what its units and links do not say already.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

Role = Literal["load", "centre", "position", "travel", "displacement", "turn", "area", ""]
"""What a channel is:

- "load": a force or a moment, by its unit where the system does not say;
- "centre": a moment over a load, as the centre of pressure of a plate (`System.quotients`);
- "position": where a body is in space, a length or an angle; what m and rad are unless the system says otherwise;
- "travel": a position of which only the rate matters, so that a constant error of it does not show;
- "displacement": of one body against another, which neither gravity nor inertia knows;
- "turn": a rotation of one body against another, which acts through a lever and is one displacement with that;
- "area": of a contact.
"""
BY_UNIT: Mapping[str, Role] = MappingProxyType(
    {"N": "load", "N m": "load", "m": "position", "rad": "position", "m^2": "area"}
)
"""Role of a channel of which the system says nothing."""


@dataclass(frozen=True)
class Way:
    """How far what carries the load gives way at the most, with the largest load on it: bound of a spring in series.

    Parameters
    ----------
    most
        In what `of` says.
    of
        "input": half-ranges of the input that gives way; "deflection": largest deflections, in the law's unit; "unit":
        the unit of the input that gives way [m or rad].
    load
        Output that pushes it; the largest of the law's loads where it is "".

    Examples
    --------
    >>> import geocontact as gc
    >>> gc.chain.Way(most=0.01, of="unit", load="force")
    Way(most=0.01, of='unit', load='force')
    """

    most: float = 1.0
    of: Literal["input", "deflection", "unit"] = "input"
    load: str = ""


@dataclass(frozen=True)
class Migration:
    """How far the axis of a joint moves, or a length changes, with its angle.

    Parameters
    ----------
    most
        Per radian at the most, over the length of the device [1/rad].
    centre
        Angle at which the length is what the model says [rad]; the middle of the measured range where it is None.

    Examples
    --------
    >>> import geocontact as gc
    >>> gc.chain.Migration(most=0.1)
    Migration(most=0.1, centre=None)
    """

    most: float = 0.3
    centre: float | None = None


@dataclass(frozen=True)
class Mass:
    """A body whose mass the model may lack, and what moves it.

    Parameters
    ----------
    variant
        What the candidate is called ("tip"); "" where there is no other.
    moved
        Inputs that move it: one angle, with the lever; x, y and the pitch of a body in the plane, whose loads along x
        and y are the first two; none where it moves with the deflection.
    lever
        Name of the number that is its distance from the axis [m].

    Examples
    --------
    >>> import geocontact as gc
    >>> gc.chain.Mass("tip", moved=("angle",), lever="L")
    Mass(variant='tip', moved=('angle',), lever='L')
    """

    variant: str = ""
    moved: tuple[str, ...] = ()
    lever: str = ""


@dataclass(frozen=True)
class Traits:
    """What a system says of itself to effects.

    Parameters
    ----------
    roles
        Of the channels whose role does not follow from the unit.
    pushes_only
        Whether its contact can push, to the positive side, and never pull.
    plausible
        Largest plausible constant error of an input, where its unit does not say [rad]; of lengths and areas over their
        half-range in the trials. 0 for none.
    way, migration
        Bounds of a spring in series, and of an axis that moves.
    masses
        Bodies whose mass may be lacking; None for one that moves with the input that gives way.

    Examples
    --------
    >>> import geocontact as gc
    >>> roles = {"strap": "displacement"}
    >>> traits = gc.chain.Traits(roles, pushes_only=True, plausible={"strap": 2.5})
    >>> traits.way.of, traits.migration.most, traits.masses is None
    ('input', 0.3, True)
    """

    roles: Mapping[str, Role] = field(default_factory=lambda: MappingProxyType({}))
    pushes_only: bool = False
    plausible: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    way: Way = Way()
    migration: Migration = Migration()
    masses: tuple[Mass, ...] | None = None
