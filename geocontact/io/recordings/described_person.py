"""A person in a description: sex, age, height, and own values of segments.

[persons.P1]
mass = { value = 31, unit = "kg" }
sex = "female"
age = { value = 9, unit = "years" }
height = { value = 1.36, unit = "m" }
segments.upper_arm = { mass = { value = 0.9, unit = "kg" }, length = { value = 25, unit = "cm" } }
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field

from geocontact.data.body_segments import Sex
from geocontact.data.plausible import AGE, TALL, Plausible
from geocontact.data.units import m
from geocontact.io.documents import Document, Some, WithUnit

LONG = Plausible("a length of a segment", m, (0.005, 1.5))
Mass = Annotated[float, WithUnit("kg"), Field(gt=0.0)]
Age = Annotated[float, WithUnit(AGE)]
OWN = {"mass": Mass, **dict.fromkeys(("length", "centre", "gyration"), Annotated[float, WithUnit(LONG), Field(gt=0.0)])}


class OwnSegments(Document):
    """Own values of segments in place of the table's, of one side.

    Parameters
    ----------
    head, trunk, upper_arm, forearm, hand, thigh, shank, foot
        Mass; length; mass centre from the proximal end; radius of gyration about it, across the long axis.
    """

    head: Annotated[Mapping[str, float], Some(OWN)] = {}
    trunk: Annotated[Mapping[str, float], Some(OWN)] = {}
    upper_arm: Annotated[Mapping[str, float], Some(OWN)] = {}
    forearm: Annotated[Mapping[str, float], Some(OWN)] = {}
    hand: Annotated[Mapping[str, float], Some(OWN)] = {}
    thigh: Annotated[Mapping[str, float], Some(OWN)] = {}
    shank: Annotated[Mapping[str, float], Some(OWN)] = {}
    foot: Annotated[Mapping[str, float], Some(OWN)] = {}

    @property
    def stated(self) -> dict[str, Mapping[str, float]]:
        """Own values by segment, of those that have any."""
        return {name: values for name in type(self).model_fields if (values := getattr(self, name))}


class DescribedPerson(Document):
    """Whose body it is.

    Parameters
    ----------
    sex
        Row of de Leva's table.
    age
        Below 18 years, from 6 on, masses are those of boys of that age.
    height
        Body height, which scales the table's lengths beside own values.
    segments
        Own values of segments.
    """

    sex: Sex = "male"
    age: Age | None = None
    height: Annotated[float, WithUnit(TALL)] | None = None
    segments: OwnSegments = OwnSegments()
