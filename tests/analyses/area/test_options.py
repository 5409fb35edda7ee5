"""The options of an area analysis: as they are typed, as Python gives them, and what is refused."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

import geocontact as gc
from geocontact.analyses.area.options import AreaOptions, PressureOptions
from geocontact.analyses.frame.options import declared
from geocontact.cli.command import option
from geocontact.data.errors import InputError

TESTS = Path(__file__).parents[2]
BODIES: dict[str, Any] = {"moving": Path("a.stl"), "fixed": Path("b.stl"), "unit": "mm"}
MOTION: dict[str, Any] = {"motion": ("gait.csv",)}
SWEEP: dict[str, Any] = {"sweep": ("flexion", 0.0, 1.0, 0.1)}
LAYER: dict[str, Any] = {"pressure": True, "modulus": gc.MPa(500), "poisson": 0.46}
OPTIONS = {one.name: one for one in declared(AreaOptions)}


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        *(("threshold", text, (4e-3,)) for text in ("4", "4mm", "0.4cm", "0.004 m", " 4 ")),
        ("threshold", "4,0.1mm", (4e-3, 1e-4)),
        ("threshold", "0mm,5", (0.0, 5e-3)),
        *(("bounds", text, 0.02) for text in ("0.02", "2%", "2 %")),
        ("tolerance", "10%", 0.1),
        ("sweep", "flexion=0:90:5", ("flexion", 0.0, gc.deg(90), gc.deg(5))),
        ("sweep", "a=0:2", ("a", 0.0, gc.deg(2), gc.deg(1))),
        ("adduction", "x=-2", ("x", gc.deg(-2))),
        ("modulus", "0.5 GPa", 5e8),
        ("piece", "1", 1e-3),
        *(("thickness", text, value) for text, value in ((" rays ", "rays"), ("8mm", 8e-3), ("3", 3e-3))),
    ],
)
def test_what_is_typed_becomes_si(name: str, text: str, value: object) -> None:
    found = OPTIONS[name].read(text)
    if isinstance(value, tuple) and isinstance(value[0], str):
        assert (found[0], found[1:]) == (value[0], pytest.approx(value[1:], rel=1e-15))
    else:
        assert found == (value if isinstance(value, str) else pytest.approx(value, rel=1e-15))


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "no motion": ({}, "`motion`: give either `motion` or `sweep`; exactly one of them is needed"),
    "two motions": (MOTION | SWEEP, "`motion`: give either `motion` or `sweep`; exactly one of them is needed"),
    "order of a sweep": (
        SWEEP | {"order": "XYZ"},
        "`order`: has no effect with `sweep`, which reads no motion file; leave it out",
    ),
    "order of a joint": (
        MOTION | {"order": "XYZ", "osim": Path("knee.osim")},
        "`order`: has no effect with `osim`: the joint gives the order; leave it out",
    ),
    "map of a joint": (
        MOTION | {"map": "rx=a", "osim": Path("knee.osim")},
        "`map`: with `osim` names the columns twice; give one",
    ),
    "side without a convention": (
        MOTION | {"side": "left"},
        "`side`: has no effect without `convention` or `split`; give `convention` or `split`",
    ),
    "split without a side": (
        MOTION | {"split": "z=1"},
        (
            "`split`: 'z=1' does not say which side of the plane is medial; give `side` right or left "
            "where z points to the subject's right, else `medial` - or +"
        ),
    ),
    "side of a plane across x": (
        MOTION | {"split": "x", "side": "left"},
        (
            "`side`: left does not say which side of a plane across x is medial: z is what points to the right; "
            "give `medial` - or +"
        ),
    ),
    "side with medial": (
        MOTION | {"split": "z", "side": "left", "medial": "+"},
        "`side`: has no effect with `medial`, which says what is medial; give one",
    ),
    "convention without a side": (
        MOTION | {"convention": "grood-suntay"},
        "`side`: is missing with `convention`; give right or left",
    ),
    "moving body of poses": (
        MOTION | {"moving_body": "parent"},
        "`moving_body`: parent needs a joint or a knee convention; swap the two meshes, or give `osim` and `joint`",
    ),
    "axis without a sweep": (
        MOTION | {"axis": "0,0,0,0,0,1"},
        "`axis`: has no effect without `sweep`; give `sweep`",
    ),
    "tolerance of nothing": (
        MOTION | {"tolerance": 0.1},
        "`tolerance`: has no effect without `compare`; give your measured areas too, or leave it out",
    ),
    "modulus without pressures": (
        MOTION | {"modulus": 1e6},
        "`modulus`: has no effect without `pressure`; give `pressure`",
    ),
    "pressures without a modulus": (
        MOTION | {"pressure": True, "poisson": 0.3},
        "`modulus`: is missing with `pressure`; give for example 500MPa",
    ),
    "second layer without pressures": (
        MOTION | LAYER | {"thickness_moving": 1e-3},
        "`thickness_moving`: has no effect without `modulus_moving`; give `modulus_moving`",
    ),
    "no threads": (MOTION | {"workers": 0}, "`workers`: 0 is less than one thread; give 1 or more"),
    "threshold negative": (
        MOTION | {"threshold": (-1e-3,)},
        "`threshold`: -1 mm cannot be a threshold of contact: that is 0 to 200 mm; check the value and its unit",
    ),
    "threshold in metres": (
        MOTION | {"threshold": (4.0,)},
        "`threshold`: 4000 mm cannot be a threshold of contact: that is 0 to 200 mm; is 4 mm meant?",
    ),
    "modulus in MPa": (
        MOTION | LAYER | {"modulus": 50},
        "`modulus`: 5e-05 MPa cannot be Young's modulus: that is 0.001 to 2e+06 MPa; is 50 MPa meant?",
    ),
    "sweep in degrees": (
        {"sweep": ("flexion", 0, 90, 1)},
        "`sweep`: 5156.62 deg cannot be an angle of a joint: that is -720 to 720 deg; is 90 deg meant?",
    ),
    "threshold nan": (
        MOTION | {"threshold": (math.nan,)},
        "`threshold`: nan is not a finite number; give a number",
    ),
    "no threshold": (
        MOTION | {"threshold": ()},
        "`threshold`: there is none; give for example 4 mm",
    ),
    "threshold twice": (
        MOTION | {"threshold": (1e-3, 1e-3)},
        "`threshold`: (0.001, 0.001) names a threshold twice; give each once",
    ),
    "bounds of zero": (
        MOTION | {"bounds": 0.0},
        "`bounds`: 0 % cannot be a share: that is 1e-10 to 100 %; check the value and its unit",
    ),
    "modulus infinite": (
        MOTION | LAYER | {"modulus": math.inf},
        "`modulus`: inf is not a finite number; give a number",
    ),
    "thickness of zero": (
        MOTION | LAYER | {"thickness": 0.0},
        "`thickness`: 0 mm cannot be the thickness of a layer: that is 0.01 to 1000 mm; check the value and its unit",
    ),
    "Poisson's ratio of rubber": (
        MOTION | LAYER | {"poisson": 0.5},
        (
            "`poisson`: 0.5 cannot be Poisson's ratio of a layer, below 0.5: that is 0 to 0.4999; "
            "check the value and its unit"
        ),
    ),
    "adduction about no axis": (
        MOTION | {"adduction": ("w", 0.0)},
        "`adduction`: 'w' is not an axis; turn about x, y or z",
    ),
    "adduction of a right angle": (
        MOTION | {"adduction": ("x", 1.5)},
        "`adduction`: 85.9437 deg cannot be a small turn: that is -45 to 45 deg; is 1.5 deg meant?",
    ),
}


@pytest.mark.parametrize(("given", "said"), REFUSED.values(), ids=REFUSED.keys())
def test_what_cannot_be_or_has_no_effect_is_refused_in_python_words(given: dict[str, Any], said: str) -> None:
    """Before any file is read: there are none of these."""
    with pytest.raises(InputError) as refused:
        AreaOptions(**BODIES, **given)
    assert str(refused.value) == said


def test_the_side_of_a_convention_goes_with_a_medial_direction() -> None:
    """The knee angles' side, beside a plane in a frame whose z is not to the right."""
    given = {"convention": "grood-suntay", "side": "left", "split": "x", "medial": "-"}
    assert AreaOptions(**BODIES, **MOTION, **given).medial == "-"


def test_a_sound_call_is_not_refused() -> None:
    rays = {"thickness": "rays", "modulus_moving": 1e9, "poisson_moving": 0.0, "thickness_moving": 3e-3}
    given = AreaOptions(**BODIES, **MOTION, **LAYER, **rays, adduction=("x", gc.deg(45)), threshold=(0.0,))
    assert given.in_si()["modulus [Pa]"] == 5e8 and given.in_si()["thickness [m]"] == "rays"
    assert PressureOptions(**BODIES, **MOTION, modulus=1e6, poisson=0.3).pressure is True


def test_every_option_is_tried_in_some_test() -> None:
    """A new option is named in these tests or those of the command line, or this fails."""
    here = (TESTS / "analyses/area", TESTS / "cli")
    texts = "".join(file.read_text(encoding="utf-8") for folder in here for file in folder.glob("*.py"))
    for name, one in OPTIONS.items():
        if not one.positional:
            assert any(word in texts for word in (f"{name}=", f'"{name}":', f'"--{option(one)}"')), name
