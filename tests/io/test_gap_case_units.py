"""Units at the door of a gap case: exact by their definitions, one spelling as good as another, none guessed."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.io.text.units import ANGLE, DIMENSIONS, LENGTH, si_unit

UNITS = [(si, unit) for si, units in DIMENSIONS.items() for unit in units]

# From the definitions (SI brochure, ISO 80000-4; pound 0.45359237 kg, standard gravity 9.80665 m/s^2, inch 25.4 mm).
DEFINED = {
    "lbf": ("N", 4.4482216152605),
    "kgf": ("N", 9.80665),
    "psi": ("Pa", 6894.757293168361),
    "mmHg": ("Pa", 133.322387415),
    "bar": ("Pa", 1e5),
    "N/mm^2": ("Pa", 1e6),
    "MPa": ("Pa", 1e6),
    "mm^2": ("m^2", 1e-6),
    "in^2": ("m^2", 6.4516e-4),
    "deg": ("rad", math.pi / 180),
    "rpm": ("rad/s", 2 * math.pi / 60),
    "N mm": ("N m", 1e-3),
    "N m/deg": ("N m/rad", 180 / math.pi),
    "N/mm": ("N/m", 1e3),
    "N s/mm": ("N s/m", 1e3),
    "ms": ("s", 1e-3),
    "%": ("-", 0.01),
    "lb": ("kg", 0.45359237),
}


@pytest.mark.parametrize("unit", DEFINED)
def test_factors_are_those_of_the_definitions(unit: str) -> None:
    si, factor = DEFINED[unit]
    found = si_unit(unit)
    assert found is not None and found[0] == si and found[1] == pytest.approx(factor, rel=1e-14)


@pytest.mark.parametrize(("si", "unit"), UNITS, ids=[unit for _, unit in UNITS])
def test_every_unit_leads_to_its_dimension(si: str, unit: str) -> None:
    assert si_unit(unit) == (si, DIMENSIONS[si][unit])
    assert si_unit(si) == (si, 1.0), "the SI unit is a unit too, of factor 1"


def test_no_unit_has_two_dimensions() -> None:
    assert len({unit for _, unit in UNITS}) == len(UNITS)
    assert (DIMENSIONS["m"], DIMENSIONS["rad"]) == (LENGTH, ANGLE)


@pytest.mark.parametrize(("si", "unit"), UNITS, ids=[unit for _, unit in UNITS])
def test_prefixes_are_powers_of_ten(si: str, unit: str) -> None:
    """A unit that is another one with a prefix is that many of it; checked for every pair there is."""
    for prefix, factor in (("m", 1e-3), ("k", 1e3), ("M", 1e6), ("G", 1e9), ("u", 1e-6), ("h", 1e2), ("c", 1e-2)):
        turned = unit.split("/", maxsplit=1)[0]  # what is above the line
        power = 2 if turned.endswith("m^2") and " " not in turned else 3 if turned.endswith("m^3") else 1
        longer = f"{prefix}{unit}"
        if longer in DIMENSIONS[si] and longer != "min":
            assert DIMENSIONS[si][longer] == pytest.approx(DIMENSIONS[si][unit] * factor**power, rel=1e-14), longer


@pytest.mark.parametrize(
    ("spellings", "si"),
    [
        (("N m", "Nm", "N*m", "N·m", "N⋅m", "N.m", " N  m "), "N m"),
        (("m^2", "m2", "m²"), "m^2"),
        (("kg m^2", "kg·m²", "kgm2"), "kg m^2"),
        (("deg", "°"), "rad"),
        (("um", "µm", "μm"), "m"),
        (("N s/m", "Ns/m", "N·s/m"), "N s/m"),
        (("deg/s^2", "°/s²", "deg/s2"), "rad/s^2"),
    ],
)
def test_spellings_of_a_unit(spellings: tuple[str, ...], si: str) -> None:
    assert {si_unit(text) for text in spellings} == {si_unit(spellings[0])}
    found = si_unit(spellings[0])
    assert found is not None and found[0] == si


@pytest.mark.parametrize(
    "text", ["", " ", "KN", "n", "mpa", "newton", "m N", "m s", "MN", "N/m^n", "N^2", "m^4", "degC", "h", "[m]", "m\0"]
)
def test_what_is_not_known_is_not_guessed(text: str) -> None:
    assert si_unit(text) is None


@given(st.text(max_size=20))
def test_any_text_is_a_unit_or_none(text: str) -> None:
    found = si_unit(text)
    assert found is None or (found[0] in DIMENSIONS and found[1] > 0.0)


@given(st.sampled_from(UNITS), st.floats(-1e100, 1e100))
def test_a_value_survives_the_way_to_si_and_back(unit: tuple[str, str], value: float) -> None:
    found = si_unit(unit[1])
    assert found is not None
    assert value * found[1] / found[1] == pytest.approx(value, rel=4e-16, abs=1e-300)


def test_every_unit_is_in_the_reference() -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "reference" / "gap_case.md").read_text(encoding="utf-8")
    rows = page.split("## Units")[1].split("## Python")[0].split("\n\n")[1]
    assert sorted(re.findall("`(.*?)`", rows)) == sorted(unit for _, unit in UNITS)
