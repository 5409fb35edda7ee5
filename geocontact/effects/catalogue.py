"""Every effect, in the order of the vocabulary."""

from __future__ import annotations

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.effects.data_errors.side_swap import SIDE_SWAP
from geocontact.effects.data_errors.sign_flip import SIGN_FLIP
from geocontact.effects.data_errors.unit_error import UNIT_ERROR
from geocontact.effects.measurement.clock_slip import CLOCK_SLIP
from geocontact.effects.measurement.crosstalk import CROSSTALK
from geocontact.effects.measurement.filter_lag import FILTER_LAG
from geocontact.effects.measurement.saturation import SATURATION
from geocontact.effects.measurement.sensor_drift import SENSOR_DRIFT
from geocontact.effects.measurement.sensor_gain import SENSOR_GAIN
from geocontact.effects.measurement.sensor_offset import SENSOR_OFFSET
from geocontact.effects.measurement.time_shift import TIME_SHIFT
from geocontact.effects.mechanical.asymmetry import ASYMMETRY
from geocontact.effects.mechanical.axis_migration import AXIS_MIGRATION
from geocontact.effects.mechanical.contact_loss import CONTACT_LOSS
from geocontact.effects.mechanical.damping import DAMPING
from geocontact.effects.mechanical.dead_zone import DEAD_ZONE
from geocontact.effects.mechanical.dry_friction import DRY_FRICTION
from geocontact.effects.mechanical.end_stop import END_STOP
from geocontact.effects.mechanical.event_load import EVENT_LOAD
from geocontact.effects.mechanical.gravity_load import GRAVITY_LOAD
from geocontact.effects.mechanical.inertia_load import INERTIA_LOAD
from geocontact.effects.mechanical.motion_offset import MOTION_OFFSET
from geocontact.effects.mechanical.play import PLAY
from geocontact.effects.mechanical.preload import PRELOAD
from geocontact.effects.mechanical.relaxation import RELAXATION
from geocontact.effects.mechanical.series_compliance import SERIES_COMPLIANCE
from geocontact.effects.mechanical.slip import SLIP
from geocontact.effects.mechanical.stiffening import STIFFENING

EFFECTS: tuple[Effect, ...] = (
    TIME_SHIFT,
    CLOCK_SLIP,
    FILTER_LAG,
    MOTION_OFFSET,
    PLAY,
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
    UNIT_ERROR,
    SIGN_FLIP,
    SIDE_SWAP,
)


def candidates(system: System) -> tuple[Candidate, ...]:
    """Every candidate that applies to a system, then those of its own effects; bounds from its scale.

    Parameters
    ----------
    system
        The base, scaled to its trials (`System.scaled`, `system_of`).

    Examples
    --------
    >>> import geocontact as gc
    >>> def run(time, inputs, numbers):
    ...     return numbers["k"] * inputs[0]
    >>> spring = gc.simulator_base("spring", {"angle": "rad"}, {"torque": "N m"}, run)
    >>> system = spring.build((gc.Parameter("k", "N m/rad", 100.0, 10.0, 400.0),), {}, {})
    >>> [one.label for one in gc.candidates(system)][:4]
    ['time_shift', 'clock_slip.once', 'clock_slip.steady', 'filter_lag']
    """
    return tuple(one for effect in (*EFFECTS, *system.own) for one in effect.candidates(system))
