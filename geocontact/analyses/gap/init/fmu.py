"""What an FMU says of itself: inputs, outputs and parameters of modelDescription.xml, FMI 2.0 and 3.0.

FMI specification 2.0.4, section 2.2.7 (ScalarVariable, Real), and 3.0.1, section 2.4.7 (Float64).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

from defusedxml import ElementTree  # type: ignore[import-untyped]
from defusedxml.common import DefusedXmlException  # type: ignore[import-untyped]

from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter
from geocontact.io.text.units import si_unit

DESCRIPTION = "modelDescription.xml"
LARGEST = 100_000_000
"""Bytes of the description."""


@dataclass(frozen=True)
class FmuVariable:
    """One real variable; `unit` as units are written here, "" where the FMU gives none."""

    name: str
    causality: str
    unit: str
    start: float
    lower: float
    upper: float

    @property
    def parameter(self) -> Parameter:
        """The variable as a parameter of a base model: free between min and max, fixed where one is missing."""
        bounded = math.isfinite(self.lower) and math.isfinite(self.upper)
        return Parameter(self.name, self.unit, self.start, self.lower, self.upper, fixed=not bounded)


def read_fmu(file: Path) -> tuple[FmuVariable, ...]:
    """Real inputs, outputs and parameters of an FMU; InputError where it is no FMU for co-simulation."""
    try:
        with ZipFile(file) as archive:
            if archive.getinfo(DESCRIPTION).file_size > LARGEST:
                raise InputError(file, DESCRIPTION, f"has more than {LARGEST / 1e6:.0f} MB", "export fewer variables")
            root = ElementTree.fromstring(archive.read(DESCRIPTION))
    except (BadZipFile, KeyError, ElementTree.ParseError, DefusedXmlException, OSError) as error:
        raise InputError(file, "", f"is no FMU: {error}", "export the model as an FMU for co-simulation") from error
    if root.find("CoSimulation") is None:
        raise InputError(file, "", "is not made for co-simulation", "export the model as an FMU for co-simulation")
    found = []
    for one in root.iterfind("ModelVariables/*"):
        real = one.find("Real") if one.tag == "ScalarVariable" else one if one.tag == "Float64" else None
        causality = one.get("causality", "local")
        if real is None or causality not in ("input", "output", "parameter") or one.find("Dimension") is not None:
            continue
        unit = _written(real.get("unit", ""))
        numbers = [_number(file, one, real, key) for key in ("start", "min", "max")]
        found.append(FmuVariable(one.get("name", ""), causality, unit, *numbers))
    return tuple(found)


def _number(file: Path, one: Any, real: Any, key: str) -> float:
    usual = {"start": 0.0, "min": -math.inf, "max": math.inf}[key]
    text = real.get(key)
    try:
        value = usual if text is None else float(text)
    except ValueError:
        raise InputError(file, f"{one.get('name')} {key}", f"{text!r} is not a number", "export it again") from None
    if key == "start" and text is None and one.get("causality") == "parameter":
        raise InputError(file, f"{one.get('name')}", "is a parameter without a start", "give it one in the model")
    return value


def _written(unit: str) -> str:
    """A unit as Modelica writes it (N.m, N.m/rad, m2) as it is written here, unknown ones as they are."""
    known = si_unit(unit) or si_unit(unit.replace(".", " "))
    if known is not None and known[1] == 1.0:
        return known[0]
    return unit.replace(".", " ")
