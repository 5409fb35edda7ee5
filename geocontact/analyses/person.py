"""Segments of a described person, confronted with the table of their mass, height and age."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from geocontact.analyses.frame.collector import reserve
from geocontact.data.body_segments import ADULT, BodySegments, Sex, body_segments
from geocontact.data.errors import InputError
from geocontact.data.plausible import TALL
from geocontact.io.recordings.described_person import OVER_HIPS, DescribedPerson

SUM = 0.01
"""Share of body mass by which own masses of all segments may differ from it."""
OWN = {"mass": (0.5, 1.8), "length": (0.65, 1.5)}
"""Times the table's value for the person's mass and height that an own value may be: a unit of length is 10, an inch
2.54, both legs for one 2; trunks with and without arms and head differ by 1.5."""
WITHIN = {"centre": 1.0, "gyration": 0.7}
"""Parts of a segment's length that its mass centre and radius of gyration may be; of a rod they are 0.5 and 0.29."""
OFF_CENTRE = 0.15
"""Parts of its length that the mass centre of a segment may be off the table's."""
SHANK = (0.26, 0.74)
"""Parts of its length from the knee that the mass centre of a shank may be: a cone's is 0.25 from its base, and the
residual limb is cut off a frustum."""
MORE = 1.01
"""Factor by which an own value is changed to see whether anything depends on it."""
LIGHTEST, SHORTEST = 35.0, 1.3
"""Body mass [kg] and height [m] below which an adult may be a child, whose age is missing or in months."""


def doubt_value(where: str, key: str, value: float, usual: float, length: float, beside: str) -> None:
    """A reservation for an own value that is far from the table's, or not within its segment.

    Parameters
    ----------
    usual, length
        The table's value, and the length of the segment [m].
    beside
        What the table is of, in words.
    """
    if key in OWN:
        share, (least, most), of = value / usual, OWN[key], f"times that of {beside}"
    else:
        share, (least, most), of = value / length, (0.0, WITHIN[key]), "times its length"
    if not least <= share <= most:
        what = f"{where}: its {key} is {share:.2g} {of}"
        reserve(f"{what}: is it in its unit, of one side, and of this person?", cause=True)


def doubt_centre(where: str, centre: float, usual: float, end: str) -> None:
    """A reservation for a mass centre [share of the length] far from the table's, as from the other end."""
    if abs(centre - usual) > OFF_CENTRE and centre <= WITHIN["centre"]:
        what = f"its centre is at {centre:.2f} of its length, {usual:.2f} in the table"
        reserve(f"{where}: {what}: is it from the {end}?", cause=True)


def name_unused(at: tuple[Path | str, str], names: Sequence[str], command: str, why: str = "") -> None:
    """One reservation that names keys of a person which a command does not use; none without names."""
    if names:
        listed = ", ".join(f"`{name}`" for name in names)
        are = "are" if len(names) > 1 else "is"
        reserve(f"{at[0]} {at[1]}: {listed} {are} not used by {command}" + (f"; {why}" if why else ""))


def stated_of_body(person: DescribedPerson) -> list[str]:
    """Age and own values of segments as they are written, for a command that needs no segments."""
    every = [f"segments.{name}" for name, values in person.segments.items() if values.stated]
    return ([] if person.age is None else ["age"]) + every


def unused_values(person: DescribedPerson, mass: float, used: Callable[[BodySegments], Sequence[float]]) -> list[str]:
    """Own values of segments that change nothing a command uses, as they are written; a segment alone if all are.

    Parameters
    ----------
    used
        What the command takes of the segments. A value of which one hundredth more leaves that as it is is not used.
    """

    def taken(own: Mapping[str, Mapping[str, float]]) -> list[float]:
        return list(used(body_segments(person.sex, person.age, mass=mass, height=person.height, own=own)))

    own, found = person.own, [f"segments.{OVER_HIPS}"] if person.over_hips else []
    before = taken(own)
    for name, values in own.items():
        idle = [k for k, v in values.items() if taken(own | {name: {**values, k: MORE * v}}) == before]
        whole = len(idle) == len(values)
        found += [f"segments.{name}"] if whole else [f"segments.{name}.{key}" for key in idle]
    return found


def doubt_age(at: tuple[Path | str, str], sex: Sex, age: float | None, mass: float, height: float | None) -> None:
    """Reservations for boys' masses, and for an age that body mass or height contradicts, also where none is stated.

    Children weigh 2 a + 3 to 7 a + 10 kg at a years here: lines of ours outside of charts of growth.
    """
    where = f"{at[0]} {at[1]}".strip()
    small = mass < LIGHTEST or (height is not None and height < SHORTEST)
    size = f"{mass:.3g} kg" if height is None else f"{mass:.3g} kg and {height:.3g} m"
    if age is None:
        if small:
            reserve(f"{where}: {size} without an age have segments of an adult; state the age of a child", cause=True)
    elif age < ADULT:
        girls = ", which are applied to girls as well" if sex == "female" else ""
        reserve(f"{where}: masses of segments of boys of {age:g} years (Jensen){girls}; centres and radii of adults")
        if not 2.0 * age + 3.0 <= mass <= 7.0 * age + 10.0:
            reserve(f"{where}: {mass:.3g} kg at {age:g} years: is the age in years and the mass in kg?", cause=True)
    elif small:
        reserve(f"{where}: {mass:.3g} kg at {age:g} years: is the age in years, not in months?", cause=True)


def _require_shank(found: BodySegments, at: tuple[Path | str, str]) -> None:
    """InputError for a mass centre at which no shank that tapers evenly has it."""
    least, most = SHANK
    centre = found["shank"].centre
    if not least <= centre <= most:
        what = f"the shank's centre is at {centre:.2f} of its length, not {least:g} to {most:g}"
        raise InputError(*at, what, "give it from the knee, in the unit of the length; de Leva's men have 0.45")


def person_segments(
    sex: Sex,
    age: float | None,
    mass: float,
    height: float | None,
    own: Mapping[str, Mapping[str, float]],
    at: tuple[Path | str, str],
) -> BodySegments:
    """Segments of a person; InputError for what cannot be, reservations for what is far from the table.

    Parameters
    ----------
    mass, height
        Of the body [kg, m].
    own
        Own values by segment, as `data.body_segments.body_segments` takes them.
    at
        File and place in it, for messages.
    """
    source, place = at
    where = f"{source} {place}".strip()
    doubt_age((source, f"{place} age" if source else "`age`"), sex, age, mass, height)
    try:
        found = body_segments(sex, age, mass=mass, height=height, own=own)
    except ValueError as error:
        raise InputError(source, place, str(error), "write length or height") from error
    if not own:
        return found
    _require_shank(found, at)
    if height is None and any("length" in values for values in own.values()):
        impossible = TALL.refusal(found.stature)
        if impossible is not None:
            reserve(f"{where}: by own lengths of segments, {impossible[0]}: are they in their unit?", cause=True)
    if found["trunk"].mass <= 0.0 or abs(found.whole - 1.0) > SUM:
        what = (
            f"all segments have {found.whole * mass:.3g} kg, the trunk {found['trunk'].mass * mass:.3g}, of {mass:.3g}"
        )
        raise InputError(source, place, f"{what} kg", "masses of limbs are of one side; check their sum")
    usual = body_segments(sex, age)
    scale = found.stature / usual.stature
    beside = f"a person of {mass:.3g} kg" + ("" if height is None else f" and {height:.3g} m")
    for name, values in own.items():
        for key, value in values.items():
            table = usual[name].mass * mass if key == "mass" else scale * usual[name].length
            doubt_value(f"{where} {name}", key, value, table, found[name].length, beside)
        doubt_centre(f"{where} {name}", found[name].centre, usual[name].centre, usual[name].ends[0])
    return found
