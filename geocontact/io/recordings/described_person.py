"""A person in a description, of whatever system: sex, age, height, and own values of segments.

[persons.P1]
mass = { value = 31, unit = "kg" }
sex = "female"
age = { value = 9, unit = "years" }
height = { value = 1.36, unit = "m" }
segments.upper_arm = { mass = { value = 0.9, unit = "kg" }, length = { value = 25, unit = "cm" } }

A study of one person has `[person]` in place of `[persons.P1]`. Segments are those of one side between de Leva's ends
and count from the proximal one, the foot from the heel; `head_arms_trunk` is one rigid body over the hips and counts
from these upwards.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from geocontact.data.body_segments import OWN_VALUES, SEGMENTS, Sex
from geocontact.data.plausible import AGE, TALL, Plausible
from geocontact.data.units import m
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Document, WithUnit

LONG = Plausible("a length of a segment", m, (0.005, 1.5))
Mass = Annotated[float, WithUnit("kg"), Field(gt=0.0)]
Age = Annotated[float, WithUnit(AGE)]
Length = Annotated[float, WithUnit(LONG), Field(gt=0.0)]
OWN = {"mass": Mass, **dict.fromkeys(("length", "centre", "gyration"), Length)}
OVER_HIPS = "head_arms_trunk"
"""Head, arms and trunk as one rigid body."""
NAMES = (*SEGMENTS["male"], OVER_HIPS)


class OwnSegment(Document):
    """Own values of one segment in place of the table's.

    Parameters
    ----------
    mass
        Mass, of one side.
    length
        Between de Leva's ends.
    centre
        Mass centre from the proximal end, of a foot from the heel, of head_arms_trunk from the hips.
    gyration
        Radius of gyration across the long axis.
    """

    mass: Mass | None = None
    length: Length | None = None
    centre: Length | None = None
    gyration: Length | None = None

    @property
    def stated(self) -> dict[str, float]:
        """Values that are there."""
        return {key: value for key in OWN_VALUES if (value := getattr(self, key)) is not None}


class DescribedPerson(Document):
    """Whose body it is.

    Parameters
    ----------
    sex
        Row of de Leva's table.
    age
        From 6 years on; below 18 masses are those of boys.
    height
        Body height, for lengths beside own values.
    segments
        Own values by segment: head, trunk, upper_arm, forearm, hand, thigh, shank, foot or head_arms_trunk.
    """

    sex: Sex = "male"
    age: Age | None = None
    height: Annotated[float, WithUnit(TALL)] | None = None
    segments: dict[str, OwnSegment] = Field(default_factory=dict)

    @property
    def own(self) -> dict[str, dict[str, float]]:
        """Own values by segment of de Leva's table, of those that have any."""
        return {name: v for name, each in self.segments.items() if (v := each.stated) and name != OVER_HIPS}

    @property
    def over_hips(self) -> dict[str, float]:
        """Own values of head, arms and trunk as one body."""
        body = self.segments.get(OVER_HIPS)
        return {} if body is None else body.stated

    @model_validator(mode="after")
    def _require_segments(self) -> DescribedPerson:
        odd = next((name for name in self.segments if name not in NAMES), None)
        if odd is not None:
            raise refusal(f"a body has no {odd[:80]}", f"it has {', '.join(NAMES)}", at=("segments", odd))
        return self
