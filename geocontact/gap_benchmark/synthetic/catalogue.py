"""Scenes by system, laboratories, and every injected effect; mistakes in the data are exact, in `data_errors`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from geocontact.gap_benchmark.synthetic.effects.attachment import CONTACT_LOSS, DEAD_ZONE, SERIES_COMPLIANCE, SLIP
from geocontact.gap_benchmark.synthetic.effects.delays import AVERAGING, FILTER_LAG, TIME_SHIFT
from geocontact.gap_benchmark.synthetic.effects.dissipation import DAMPING, DRY_FRICTION, STICKING, THINNING
from geocontact.gap_benchmark.synthetic.effects.elasticity import (
    ASYMMETRY,
    CREEPING,
    END_STOP,
    LOCKING,
    PRELOAD,
    RELAXATION,
    STIFFENING,
)
from geocontact.gap_benchmark.synthetic.effects.loads import EVENT_LOAD, GRAVITY_LOAD, INERTIA_LOAD
from geocontact.gap_benchmark.synthetic.effects.motion import AXIS_MIGRATION, MOTION_OFFSET
from geocontact.gap_benchmark.synthetic.effects.sensors import (
    CROSSTALK,
    LEANING,
    ONE_SIDED,
    SATURATION,
    SENSOR_DRIFT,
    SENSOR_GAIN,
    SENSOR_OFFSET,
    SMALL_LOADS,
)
from geocontact.gap_benchmark.synthetic.effects.unknown import UNKNOWN
from geocontact.gap_benchmark.synthetic.laboratories.elsewhere import placement_laboratory
from geocontact.gap_benchmark.synthetic.laboratories.kinds import LABORATORY_KINDS, laboratory_of_kind
from geocontact.gap_benchmark.synthetic.laboratories.recorder import inputs_laboratory, recorder_laboratory
from geocontact.gap_benchmark.synthetic.laboratory import Forms
from geocontact.gap_benchmark.synthetic.plan import EffectNumbers, InjectionPlan
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.systems import elbow, foot, knee, shoulder, sit_to_stand

SCENES: Mapping[str, Callable[..., SyntheticScene]] = {
    "elbow": elbow.elbow_scene,
    "foot": foot.foot_scene,
    "shoulder": shoulder.shoulder_scene,
    "knee": knee.knee_scene,
    "sit_to_stand": sit_to_stand.sit_to_stand_scene,
}
NUMBERS: Mapping[str, EffectNumbers] = {
    "elbow": elbow.EFFECTS,
    "foot": foot.EFFECTS,
    "shoulder": shoulder.EFFECTS,
    "knee": knee.EFFECTS,
    "sit_to_stand": sit_to_stand.EFFECTS,
}
"""What effects ask of each."""
CONFOUNDED = {system: one.confounded for system, one in NUMBERS.items()}
"""Effects that base parameters reproduce nearly, if they are of a plain form."""
NO_GAP = {system: one.no_gap for system, one in NUMBERS.items() if one.no_gap}
"""Those that leave no visible gap of their own kind at all: never planted as a single one or in a pair."""

PLANS: tuple[InjectionPlan, ...] = (
    TIME_SHIFT,
    FILTER_LAG,
    MOTION_OFFSET,
    AXIS_MIGRATION,
    SERIES_COMPLIANCE,
    STIFFENING,
    DAMPING,
    RELAXATION,
    DRY_FRICTION,
    DEAD_ZONE,
    END_STOP,
    PRELOAD,
    SLIP,
    CONTACT_LOSS,
    ASYMMETRY,
    EVENT_LOAD,
    GRAVITY_LOAD,
    INERTIA_LOAD,
    SENSOR_GAIN,
    SENSOR_OFFSET,
    SENSOR_DRIFT,
    SATURATION,
    CROSSTALK,
)
SECOND = {one.name: one for one in (AVERAGING, LEANING, ONE_SIDED, SMALL_LOADS, CREEPING, LOCKING, STICKING, THINNING)}
"""Effects that have a second family of equations; the others are of the first in either."""

LABORATORIES: Mapping[str, Callable[[Rng, SyntheticScene], SyntheticScene]] = {
    "home": lambda _, scene: scene,
    "recorder": recorder_laboratory,
    "placement": placement_laboratory,
    "inputs": inputs_laboratory,
    **{name: partial(laboratory_of_kind, kind=kind) for name, kind in LABORATORY_KINDS.items()},
}


def plans(system: str, forms: Forms = "first") -> tuple[InjectionPlan, ...]:
    """Those of the vocabulary that apply to a system, in one family of equations."""
    known = PLANS if forms == "first" else tuple(SECOND.get(one.name, one) for one in PLANS)
    return tuple(one for one in known if one.name in NUMBERS[system].names)


def unknown_effects(system: str) -> tuple[InjectionPlan, ...]:
    """Those outside of the vocabulary that a system may have."""
    return tuple(one for one in UNKNOWN if one.name in NUMBERS[system].unknown)
