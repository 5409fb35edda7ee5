"""A simulated stance beside a force plate, as the study judges it (its sec. 2.5): errors; predictors without a model.

With the pelvis free upwards the impulse of any simulation is nearly body weight times time, and every stance looks like
the next: R² alone says little. Both know the length of the plate's stance, which a simulation has to find.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, LegMotion, recorded_tree
from geocontact.below_knee_prosthesis.simulate import GATE, Stance, share_of_foot
from geocontact.identify.signals.agreement import agreement
from geocontact.identify.signals.cycles import loaded_spans
from geocontact.identify.signals.filters import zero_lag
from geocontact.loads.centre_of_pressure import POINTS

CUTOFF = 40.0
"""Hz; of the plate's forces and of the simulated ones beside them, as the study has it."""
SLOWEST = 0.4
"""Share of a plate's rate: the cut-off of both where the plate is too slow for `CUTOFF`."""
SAMPLES = 101
"""Over the stance that the plate saw."""


@dataclass(frozen=True)
class Scoring:
    """What of a stance is compared with its plate.

    Parameters
    ----------
    around
        Swing before touch-down and after toe-off that is compared as well [s].
    centre_cutoff
        Zero-lag low-pass of both centres of pressure over the stance [Hz]; None for none.
    """

    around: float = 0.0
    centre_cutoff: float | None = None


OVER_STANCE = Scoring()
AS_STUDY = Scoring(0.25, 6.0)
"""The study's scoring (its sec. 2.5): swing, where both forces are nothing, and the filter make errors smaller."""


@dataclass(frozen=True, eq=False)
class PlateStance:
    """What a plate saw of a foot, in the frame of a person with a right prosthesis.

    Parameters
    ----------
    time
        [s].
    force
        On the foot [N].
    centre
        Of pressure [m]; NaN where the foot is not loaded.
    name, source
        Of the plate, and where it was recorded: what an error names.
    """

    time: Float[np.ndarray, " t"]
    force: Float[np.ndarray, "t 3"]
    centre: Float[np.ndarray, "t 3"]
    name: str = "the plate"
    source: str = ""


@dataclass(frozen=True, eq=False)
class StanceErrors:
    """Numbers of the comparison.

    Parameters
    ----------
    share
        Of the plate's stance, 0 to 1; less and more with swing around it.
    curves
        Simulated and measured by name: forces over body weight, impulse [s], centre of pressure (share of the foot).
        What was not simulated is NaN.
    table
        By quantity: R² and root mean square error in the curve's unit, over what was simulated.
    stance
        Length by simulation and by the plate [s]; NaN by simulation where it ended before toe-off.
    start
        Touch-down by the plate [s].
    """

    share: Float[np.ndarray, " s"]
    curves: Mapping[str, tuple[Float[np.ndarray, " s"], Float[np.ndarray, " s"]]]
    table: Mapping[str, tuple[float, float]]
    stance: tuple[float, float]
    start: float

    @property
    def simulated(self) -> float:
        """Share of the plate's stance that was simulated, 0 to 1."""
        inside = (self.share >= 0.0) & (self.share <= 1.0)
        return float(np.isfinite(self.curves["resultant"][0][inside]).mean())


def stance_errors(found: Stance, plate: PlateStance, scoring: Scoring = OVER_STANCE) -> StanceErrors:
    """Over the plate's stance, as far as it was simulated; ValueError where the plate has none.

    Forces of both pass the same zero-lag low-pass, each at its own rate and over all of its recording.
    """
    weight = found.motion.leg.person.mass * GRAVITY
    span = longest_stance(plate.time, plate.force[:, 1])
    if span is None:
        raise ValueError(f"the plate never carries {GATE:g} N")
    beside = scoring.around / (span[1] - span[0])
    share = np.linspace(-beside, 1.0 + beside, SAMPLES)
    time = span[0] + share * (span[1] - span[0])
    steps = [float(np.median(np.diff(each))) for each in (found.time, plate.time)]
    cutoff = min(CUTOFF, *(SLOWEST / step for step in steps))
    own = simulated_at(time, found.time, zero_lag(found.force, steps[0], cutoff)) / weight
    seen = at_times(time, plate.time, zero_lag(plate.force, steps[1], cutoff)) / weight
    curves = {"resultant": (np.linalg.norm(own, axis=1), np.linalg.norm(seen, axis=1))}
    for name, axis in (("vertical", 1), ("fore_aft", 0), ("medio_lateral", 2)):
        curves[name] = (own[:, axis], seen[:, axis])
    curves["impulse"] = _impulses(time, *curves["resultant"])
    poses, length = found.poses, found.foot.keel.length
    across = np.column_stack([np.interp(found.time, plate.time, column) for column in plate.centre.T])
    along = [share_of_foot(poses, length, across), *(found.along_foot(point) for point in POINTS)]
    if scoring.centre_cutoff is not None:
        along = [_smooth(each, steps[0], scoring.centre_cutoff) for each in along]
    seen_centre, *centres = simulated_at(time, found.time, np.column_stack(along)).T
    for point, centre in zip(POINTS, centres, strict=True):
        curves[f"cop_{point}"] = (centre, seen_centre)
    table = {}
    for name, (model, measured) in curves.items():
        told = agreement(model, measured, float(time[1] - time[0]))
        table[name] = (told.r2, told.rmsd)
    own_span = longest_stance(found.time, found.force[:, 1])
    lasting = np.nan if own_span is None else own_span[1] - own_span[0]
    return StanceErrors(share, curves, table, (float(lasting), float(span[1] - span[0])), float(span[0]))


def _smooth(values: Float[np.ndarray, " t"], step: float, cutoff: float) -> Float[np.ndarray, " t"]:
    """The longest run of known samples through a zero-lag low-pass; the others are NaN."""
    edges = np.diff(np.concatenate([[0], np.isfinite(values).astype(int), [0]]))
    runs = list(zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True))
    found = np.full_like(values, np.nan)
    if runs:
        first, behind = max(runs, key=lambda each: each[1] - each[0])
        found[first:behind] = zero_lag(values[first:behind], step, cutoff)
    return found


def _impulses(
    time: Float[np.ndarray, " s"], own: Float[np.ndarray, " s"], seen: Float[np.ndarray, " s"]
) -> tuple[Float[np.ndarray, " s"], Float[np.ndarray, " s"]]:
    """Impulses of forces over time, from the first sample that both have; the simulated one is NaN where it has
    none.
    """
    both = np.isfinite(own)
    model = np.full_like(own, np.nan)
    model[both] = _summed(time[both], own[both])
    measured = _summed(time, seen)
    return model, measured - measured[int(np.argmax(both))]


def _summed(time: Float[np.ndarray, " s"], value: Float[np.ndarray, " s"]) -> Float[np.ndarray, " s"]:
    """Integral since the first time by the trapezoidal rule; `scipy.integrate` takes half a second to import."""
    return np.concatenate([[0.0], np.cumsum(np.diff(time) * (value[1:] + value[:-1]) / 2.0)])


def longest_stance(time: Float[np.ndarray, " t"], load: Float[np.ndarray, " t"]) -> tuple[float, float] | None:
    """Start and end of the longest span under load [s]; None where there is none."""
    spans = loaded_spans(time, load, GATE)
    if not spans:
        return None
    longest = max(spans, key=lambda each: each.end - each.start)
    return float(longest.start), float(longest.end)


def at_times(
    wanted: Float[np.ndarray, " s"], time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t k"]
) -> Float[np.ndarray, "s k"]:
    """Columns at other times [s], linear between samples."""
    return np.column_stack([np.interp(wanted, time, column) for column in values.T])


def simulated_at(
    wanted: Float[np.ndarray, " s"], time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t k"]
) -> Float[np.ndarray, "s k"]:
    """The same of what was simulated: NaN before its start and past its end."""
    return np.column_stack([np.interp(wanted, time, column, np.nan, np.nan) for column in values.T])


ANKLE = "ankle_moment"
QUANTITIES = (
    "resultant",
    "vertical",
    "fore_aft",
    "medio_lateral",
    "impulse",
    "cop_ground",
    "cop_sphere",
    ANKLE,
)
"""In the order of the tables."""


@dataclass(frozen=True, eq=False)
class JudgedStance:
    """What is known of one stance of a study.

    Parameters
    ----------
    name, person, setting
        Whose it is, and on which foot: low, medium, high or a fulcrum in words.
    calibrated
        Whether the sole was fitted to it: then it is no prediction.
    errors
        Beside the plate, with the ankle's moment over body mass [N m/kg].
    """

    name: str
    person: str
    setting: str
    calibrated: bool
    stance: Stance
    plate: PlateStance
    errors: StanceErrors

    def measured(self, quantity: str) -> Float[np.ndarray, " s"]:
        """By the plate, over its stance."""
        return self.errors.curves[quantity][1]

    def simulated(self, quantity: str) -> Float[np.ndarray, " s"]:
        """By the model, over the plate's stance."""
        return self.errors.curves[quantity][0]


def judged(
    name: str,
    person: str,
    setting: str,
    stance: Stance,
    plate: PlateStance,
    *,
    calibrated: bool = False,
    scoring: Scoring = OVER_STANCE,
) -> JudgedStance:
    """A stance with its errors; ValueError where the plate has none."""
    errors = stance_errors(stance, plate, scoring)
    moments = _ankle_moments(stance, plate, errors)
    step = errors.stance[1] * float(errors.share[1] - errors.share[0])
    told = agreement(*moments, step)
    more = replace(
        errors,
        curves={**errors.curves, ANKLE: moments},
        table={**errors.table, ANKLE: (told.r2, told.rmsd)},
    )
    return JudgedStance(name, person, setting, calibrated, stance, plate, more)


def plate_ankle_moment(plate: PlateStance, motion: LegMotion) -> Float[np.ndarray, " t"]:
    """Moment of the plate's force about the recorded ankle in the foot's sagittal plane [N m], at the plate's times.

    Positive where it bends the toes up, as `Stance.ankle_moment`. Zero where the foot is not loaded; the plate's couple
    about its own surface is in the centre of pressure, that about the vertical is left out.
    """
    leg = motion.leg
    shank = recorded_tree(leg).poses(motion.values)["shank"]
    keel = shank * RigidTransform.from_components(leg.keel, leg.turn)
    ankle = at_times(plate.time, motion.time, shank.apply(leg.ankle))
    across = at_times(plate.time, motion.time, keel.rotation.apply([0.0, 0.0, 1.0]))
    arm = np.where(np.isfinite(plate.centre), plate.centre - ankle, 0.0)
    return np.asarray(np.einsum("ti,ti->t", np.cross(arm, plate.force), across))


def _ankle_moments(
    stance: Stance, plate: PlateStance, errors: StanceErrors
) -> tuple[Float[np.ndarray, " s"], Float[np.ndarray, " s"]]:
    """Simulated, as far as it was, and measured over the plate's stance, over body mass [N m/kg]."""
    mass, start = stance.motion.leg.person.mass, errors.start
    time = start + errors.share * errors.stance[1]
    seen = plate_ankle_moment(plate, stance.motion)
    return (
        simulated_at(time, stance.time, stance.ankle_moment[:, None])[:, 0] / mass,
        np.interp(time, plate.time, seen) / mass,
    )


MEAN, ANOTHER = "mean of the others", "another setting"


@dataclass(frozen=True, eq=False)
class MeasuredCurve:
    """One quantity over a stance as the plate saw it, and whose it is on which setting of the foot."""

    name: str
    person: str
    setting: str
    values: Float[np.ndarray, " s"]


def trivial_curves(measured: Sequence[MeasuredCurve], one: MeasuredCurve) -> dict[str, Float[np.ndarray, " s"]]:
    """Curves of both predictors for one of the stances; one that there is nothing for is missing.

    Mean of the other trials: of the same person, else of all others. Another setting: the person's first trial on
    another foot.
    """
    others = [each for each in measured if each.name != one.name]
    own = [each for each in others if each.person == one.person]
    found = {}
    if others:
        found[MEAN] = np.mean([each.values for each in own or others], axis=0)
    strange = next((each for each in own if each.setting != one.setting), None)
    if strange is not None:
        found[ANOTHER] = strange.values
    return found
