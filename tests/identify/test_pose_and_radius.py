"""An offset of adduction and a radius that follows flexion as unknowns: found, or said to be no number of their own."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from geocontact.data.evolution import TiltedAreas
from geocontact.data.parameter import Parameter
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, MODULUS, SLOPE, AreaForce
from geocontact.elastic_modulus.identify import Identification, end_to_end, fitted, identify, modulus_parameter
from tests.elsewhere import Elsewhere
from tests.identify.synthetic_contact import DURATION, RADIUS, TRUE, coloured, synthetic_model

OFFSETS = np.radians([-3.0, -1.0, 0.0, 1.0, 3.0])
FREE = Parameter(ADDUCTION, "rad", 0.0, -0.05, 0.05)
BENT = Parameter(SLOPE, "1/rad", 0.0, -0.6, 0.6)
NOISE, TAU = 40.0, 0.02


def halves(unloads: float = 1.0) -> list[AreaForce]:
    """Medial and lateral: a positive offset takes area from one and gives it to the other, more so early."""
    whole = synthetic_model("disc", frames=41)
    time = whole.evolution.time
    per_rad = 6.0 * (1.0 - unloads * 0.5 * time / DURATION)
    models = []
    for share, way in ((0.55, -1.0), (0.45, 1.0)):
        base = share * whole.evolution.area
        tilted = base[:, :, None] * (1.0 + way * per_rad[:, None, None] * OFFSETS)
        evolution = replace(whole.evolution, area=base, tilts=TiltedAreas(OFFSETS, tilted))
        models.append(replace(whole, evolution=evolution))
    return models


@dataclass(frozen=True)
class Told:
    """What an identification says of its unknowns, E* first: values, intervals and what is told apart."""

    values: list[float]
    profiles: list[tuple[float, float]]
    drawn: list[tuple[float, float]]
    verdicts: dict[str, str]
    on_bound: tuple[str, ...]


def told(found: Identification) -> Told:
    ends = [] if found.replicates is None else list(zip(found.replicates.lower, found.replicates.upper, strict=True))
    verdicts = {name: group.verdict for name, group in found.told_apart.items()}
    return Told(
        list(found.fit.values.values()), [(p.lower, p.upper) for p in found.profiles.values()], ends, verdicts,
        found.on_bound,
    )  # fmt: skip


def with_noise(adduction: float, replicates: int) -> Told:
    models, rng = halves(), np.random.default_rng(8)
    forces = [m.force({MODULUS: TRUE, ADDUCTION: adduction}) + coloured(m.frames, NOISE, TAU, rng) for m in models]
    return told(identify(*end_to_end(models, forces), (FREE,), replicates=replicates, starts=2))


def test_adduction_is_found_from_both_sides_at_once(elsewhere: Elsewhere) -> None:
    """1.2 degrees between those evaluated, with noise that remembers: inside both intervals, which are tight."""
    found = elsewhere(with_noise, np.radians(1.2), 100)
    true, (lower, upper), drawn = np.radians(1.2), found.profiles[1], found.drawn[1]
    assert lower < true < upper and upper - lower < np.radians(0.4)
    assert drawn[0] < true < drawn[1]
    assert found.profiles[0][0] < TRUE < found.profiles[0][1]
    assert found.verdicts["E*, adduction"] == found.verdicts["free"] == "separable"


def test_adduction_without_noise_is_exact_with_a_lag_beside_it() -> None:
    models = [replace(model, frames=model.frames[4:-4]) for model in halves()]
    true = {MODULUS: TRUE, ADDUCTION: np.radians(-2.0), LAG: 0.02}
    joined = end_to_end(models, [model.force(true) for model in models])
    found = fitted(*joined, (modulus_parameter(), FREE, Parameter(LAG, "s", 0.0, -0.05, 0.05)), starts=1)
    assert found.values == pytest.approx(true, rel=1e-3)


def scaled_alike(sides: int) -> Told:
    models = halves(unloads=0.0)[:sides]
    forces = [model.force({MODULUS: TRUE, ADDUCTION: 0.01}) for model in models]
    forces[0] = forces[0] + coloured(models[0].frames, NOISE, TAU, np.random.default_rng(2)) * (sides == 1)
    return told(identify(*end_to_end(models, forces), (FREE,), replicates=0, starts=1))


def test_an_offset_that_scales_one_side_alike_in_all_frames_is_no_number_of_its_own(elsewhere: Elsewhere) -> None:
    """With one side alone; both sides together tell it, as the other one changes the other way."""
    alone = elsewhere(scaled_alike, 1)
    assert alone.verdicts["free"] == alone.verdicts["E*, adduction"] == "one number"
    assert ADDUCTION in alone.on_bound
    together = elsewhere(scaled_alike, 2)
    assert together.verdicts["free"] == "separable"
    assert together.values == pytest.approx([TRUE, 0.01], rel=1e-3)


def bent(flexion: np.ndarray) -> AreaForce:
    model = synthetic_model("disc", frames=41)
    return replace(model, evolution=replace(model.evolution, flexion=flexion))


def following(flexion: np.ndarray, slope: float) -> Told:
    model = bent(flexion)
    area = model.evolution.within(model.threshold)
    force = 4.0 / 3.0 * TRUE * (area / np.pi) ** 1.5 / (RADIUS * (1.0 + slope * flexion))
    noisy = force + coloured(model.frames, NOISE, TAU, np.random.default_rng(5))
    return told(identify(model, noisy, (BENT,), replicates=0, starts=1))


def test_slope_of_the_radius_is_found(elsewhere: Elsewhere) -> None:
    """R (1 - 0.3 phi) over 60 degrees of flexion."""
    flexion = np.radians(60.0) * np.sin(np.linspace(0.0, np.pi, 41)) ** 2
    found = elsewhere(following, flexion, -0.3)
    lower, upper = found.profiles[1]
    assert lower < -0.3 < upper and upper - lower < 0.1
    assert found.verdicts["E*, R"] == "one number", "its size stays one number with E*"
    assert found.verdicts["free"] == "separable"


def test_slope_at_constant_flexion_is_one_number_with_the_modulus(elsewhere: Elsewhere) -> None:
    found = elsewhere(following, np.full(41, np.radians(30.0)), 0.0)
    assert found.verdicts["free"] == found.verdicts["E*, slope"] == "one number"
    assert SLOPE in found.on_bound


def test_unknowns_that_the_areas_do_not_hold_are_errors() -> None:
    model = synthetic_model("disc")
    with pytest.raises(ValueError, match="one adduction only"):
        model.force({MODULUS: TRUE, ADDUCTION: 0.01})
    with pytest.raises(ValueError, match="flexion of the frames is not known"):
        model.force({MODULUS: TRUE, SLOPE: 0.1})
