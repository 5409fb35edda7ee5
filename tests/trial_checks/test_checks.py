"""Every check of a recorded trial: an input that it speaks of, one that nearly makes it speak, and the untouched one.

The walker is made here, in closed form, with nothing of the package: a pelvis that goes at constant speed, feet that
stand still during stance and swing by a smooth polynomial, and plates whose force keeps the walker's mean weight.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, filtfilt
from scipy.spatial.transform import Rotation

from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.wrench import Wrench
from geocontact.trial_checks.channel_checks import breadths
from geocontact.trial_checks.recorded import FootPlate, TrialInputs
from geocontact.trial_checks.table import CHECKS, contradictions
from tests.trial_checks import modelled

RATE, SPEED, STRIDE, DUTY = 100.0, 1.2, 1.2, 0.62
"""Hz, m/s, s of a cycle, share of it with a foot on the floor."""
MASS, GRAVITY, ONSET = 75.0, 9.80665, 20.0
STANDING_STILL = np.linspace(0.0, 0.5, 51)


def foot_place(time: np.ndarray, first: float) -> np.ndarray:
    """Place of an ankle along the walk [m] for a foot that lands at `first` and every cycle after."""
    cycle, since = np.divmod(time - first, STRIDE)
    swing = np.clip((since - DUTY * STRIDE) / ((1.0 - DUTY) * STRIDE), 0.0, 1.0)
    smooth = 10.0 * swing**3 - 15.0 * swing**4 + 6.0 * swing**5
    return SPEED * STRIDE * (cycle + smooth) + SPEED * first


def lifted(time: np.ndarray, first: float) -> np.ndarray:
    """Height of a foot over where it stands [m]."""
    since = np.mod(time - first, STRIDE)
    swing = np.clip((since - DUTY * STRIDE) / ((1.0 - DUTY) * STRIDE), 0.0, 1.0)
    return 0.08 * np.sin(np.pi * swing) ** 2


def marked(time: np.ndarray, *, walks: bool = True) -> MarkerTrajectories:
    """Pelvis, knees and feet; x forwards, y up, z to the right."""
    places = {}
    for side, sign, first in (("R", 1.0, 0.6), ("L", -1.0, 0.0)):
        foot = foot_place(time, first) if walks else np.zeros_like(time)
        up = lifted(time, first) if walks else np.zeros_like(time)
        middle = SPEED * time + 0.3 if walks else np.full_like(time, 0.05)
        for name, x, y, z in (("HEE", -0.06, 0.04, 0.09), ("TOE", 0.15, 0.035, 0.11), ("ANK", 0.0, 0.09, 0.13)):
            places[side + name] = np.column_stack([foot + x, up + y, np.full_like(time, sign * z)])
        for name, x, y, z in (("ASI", 0.1, 0.95, 0.12), ("PSI", -0.1, 0.98, 0.05)):
            places[side + name] = np.column_stack([middle + x, np.full_like(time, y), np.full_like(time, sign * z)])
    return MarkerTrajectories(time, np.stack(list(places.values()), axis=1), tuple(places), "walk.trc")


def plate_of(time: np.ndarray, name: str, land: float, sign: float) -> ForcePlate:
    """The step that begins at `land`: mean force MASS g / (2 DUTY), braking, then propulsion."""
    share = (time - land) / (DUTY * STRIDE)
    on = (share > 0.0) & (share < 1.0)
    bump = np.where(on, np.sin(np.pi * np.clip(share, 0.0, 1.0)) ** 0.5, 0.0)
    mean = float((np.sin(np.pi * np.linspace(0.0, 1.0, 10001)) ** 0.5).mean())
    normal = MASS * GRAVITY / (2.0 * DUTY) * bump / mean
    along = -0.15 * normal * np.cos(np.pi * np.clip(share, 0.0, 1.0))
    force = np.column_stack([along, normal, 0.04 * normal])
    heel = foot_place(np.array([land + 0.1]), land)[0]
    place = np.column_stack([heel - 0.05 + 0.2 * np.clip(share, 0.0, 1.0), np.zeros_like(time), 0 * time + sign * 0.1])
    wrench = Wrench(force, np.column_stack([0 * time, 0.01 * normal, 0 * time]), place, "ground")
    return ForcePlate(name, time, wrench, np.zeros(3), np.array([0.0, 1.0, 0.0]))


TIME = np.arange(0.0, 3.6, 1.0 / RATE)
PLATES = np.arange(0.0, 3.6, 1e-3)


def walk() -> TrialInputs:
    """One step on each of two plates."""
    right, left = plate_of(PLATES, "right", 0.6, 1.0), plate_of(PLATES, "left", 1.2, -1.0)
    plates = FootPlate(right, "plates.mot", "right"), FootPlate(left, "plates.mot", "left")
    return TrialInputs(marked(TIME), replace(marked(STANDING_STILL, walks=False), source="still.trc"), plates, MASS)


def spoke(trial: TrialInputs) -> set[str]:
    """Names of the checks that found something."""
    return {check.name for check, _ in contradictions(trial)}


def moved(trial: TrialInputs, change: Callable[[np.ndarray], np.ndarray]) -> TrialInputs:
    """With other places of markers (t, m, 3)."""
    seen = trial.markers
    assert seen is not None
    return replace(trial, markers=replace(seen, positions=change(seen.positions.copy())))


def plated(trial: TrialInputs, change: Callable[[ForcePlate], ForcePlate]) -> TrialInputs:
    """With other plates."""
    return replace(trial, plates=tuple(replace(on, plate=change(on.plate)) for on in trial.plates))


def standing_moved(trial: TrialInputs, marker: int | None, by: float) -> TrialInputs:
    """With one marker of the standing trial, or all of them, higher up [m]."""
    still = trial.standing
    assert still is not None
    places = still.positions.copy()
    places[:, slice(None) if marker is None else marker, 1] += by
    return replace(trial, standing=replace(still, positions=places))


def spiked(by: float) -> Callable[[np.ndarray], np.ndarray]:
    """Three frames of one marker aside [m]."""

    def change(places: np.ndarray) -> np.ndarray:
        places[150:153, 1, 2] += by
        return places

    return change


def swapped(places: np.ndarray) -> np.ndarray:
    """Labels of the right and left ASIS exchanged from the middle on."""
    places[180:, [3, 8]] = places[180:, [8, 3]]
    return places


def heel_for_toe(places: np.ndarray) -> np.ndarray:
    """Labels of heel and toes exchanged on both feet."""
    places[:, [0, 1, 5, 6]] = places[:, [1, 0, 6, 5]]
    return places


def heels(by: float) -> Callable[[np.ndarray], np.ndarray]:
    """Markers of both heels farther down [m]."""

    def change(places: np.ndarray) -> np.ndarray:
        places[:, [0, 5], 1] -= by
        return places

    return change


def later(by: float) -> Callable[[ForcePlate], ForcePlate]:
    """A clock that is late [s]."""
    return lambda plate: replace(plate, time=plate.time + by)


def forced(factors: tuple[float, float, float]) -> Callable[[ForcePlate], ForcePlate]:
    """Force times factors by axis."""

    def change(plate: ForcePlate) -> ForcePlate:
        return replace(plate, wrench=replace(plate.wrench, force=plate.wrench.force * np.array(factors)))

    return change


def one_twice(plate: ForcePlate) -> ForcePlate:
    """The force along the walk in place of that across it."""
    return replace(plate, wrench=replace(plate.wrench, force=plate.wrench.force[:, [0, 1, 0]]))


def later_half(trial: TrialInputs, by: float) -> TrialInputs:
    """A standing trial whose second half begins later [s]."""
    still = trial.standing
    assert still is not None
    time = still.time + by * (np.arange(len(still.time)) >= len(still.time) // 2)
    return replace(trial, standing=replace(still, time=time))


def twisted(plate: ForcePlate) -> ForcePlate:
    """Moments in N mm."""
    return replace(plate, wrench=replace(plate.wrench, moment=1e3 * plate.wrench.moment))


def millimetres(plate: ForcePlate) -> ForcePlate:
    """Centre of pressure in mm."""
    return replace(plate, wrench=replace(plate.wrench, origin=1e3 * plate.wrench.origin))


def exchanged(trial: TrialInputs) -> TrialInputs:
    """The two plates under each other's foot."""
    right, left = trial.plates
    return replace(trial, plates=(replace(right, side="left"), replace(left, side="right")))


def stood(kilograms: float) -> Callable[[TrialInputs], TrialInputs]:
    """Somebody of 75 kg who stands on a plate, whose mass is said to be another."""
    time = np.arange(0.0, 1.0, 1e-3)
    force = np.column_stack([0.0 * time, np.full_like(time, MASS * GRAVITY), 0.0 * time])
    wrench = Wrench(force, 0.0 * force, 0.0 * force, "ground")
    plate = ForcePlate("feet", time, wrench, np.zeros(3), np.array([0.0, 1.0, 0.0]))
    return lambda _: TrialInputs(plates=(FootPlate(plate, "plates.mot"),), mass=kilograms, stands_at=0.9)


def renamed(trial: TrialInputs) -> TrialInputs:
    """Right called left."""
    assert trial.markers is not None
    names = tuple({"R": "L", "L": "R"}[name[0]] + name[1:] for name in trial.markers.names)
    return replace(trial, standing=None, markers=replace(trial.markers, names=names))


def edged(by: float) -> Callable[[ForcePlate], ForcePlate]:
    """With corners of 0.6 m along the walk, whose middle is elsewhere than that of the step [m]."""

    def change(plate: ForcePlate) -> ForcePlate:
        middle = np.nanmedian(plate.centre_of_pressure(), axis=0) + np.array([by, 0.0, 0.0])
        corners = middle + np.array([[0.3, 0.0, 0.2], [0.3, 0.0, -0.2], [-0.3, 0.0, -0.2], [-0.3, 0.0, 0.2]])
        return replace(plate, corners=corners)

    return change


Z_UP = Rotation.from_matrix([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
TURNED = Rotation.from_euler("y", 90.0, degrees=True)


def aside(by: float) -> Callable[[np.ndarray], np.ndarray]:
    """One marker of the pelvis elsewhere on it in the walk [m]; another trial than the standing one."""

    def change(places: np.ndarray) -> np.ndarray:
        places[:, 3] += np.array([by, 0.0, 0.0])
        return places

    return change


def slipping(by: float) -> Callable[[np.ndarray], np.ndarray]:
    """The right ASIS slides along the pelvis from 1 to 2.6 s [m]."""

    def change(places: np.ndarray) -> np.ndarray:
        places[:, 3, 0] += by * np.clip((TIME - 1.0) / 1.6, 0.0, 1.0)
        return places

    return change


def labelled(*pairs: str) -> Callable[[TrialInputs], TrialInputs]:
    """Two further markers for each word, a number behind it: 0.1 m above the right ASIS, and ever farther; words 20 mm
    apart."""

    def change(trial: TrialInputs) -> TrialInputs:
        seen = trial.markers
        one = seen.positions[:, 3] + [0.0, 0.1, 0.0]
        other = one + np.linspace(0.1, 0.3, len(one))[:, None] * [0.0, 1.0, 0.0]
        beside = [0.02 * k * np.array([0.0, 0.0, 1.0]) for k in range(len(pairs))]
        places = [seen.positions, *([(each + off)[:, None] for off in beside for each in (one, other)])]
        names = (*seen.names, *(f"{word}{k}" for word in pairs for k in (1, 8)))
        return replace(trial, markers=replace(seen, positions=np.concatenate(places, axis=1), names=names))

    return change


def held(frames: int) -> Callable[[np.ndarray], np.ndarray]:
    """The right PSIS stays where it was at 1 s, and comes back to its course at 0.4 m/s, so that it does not jump."""

    def change(places: np.ndarray) -> np.ndarray:
        off = np.zeros_like(places[:, 4])
        off[100 : 100 + frames] = places[100, 4] - places[100 : 100 + frames, 4]
        for k in range(100 + frames, len(off)):
            size = np.linalg.norm(off[k - 1])
            off[k] = off[k - 1] * max(0.0, 1.0 - 0.004 / size) if size > 0.0 else 0.0
        places[:, 4] += off
        return places

    return change


def bridged(frames: int) -> Callable[[np.ndarray], np.ndarray]:
    """The right toes go along a straight line for so many frames of a swing."""

    def change(places: np.ndarray) -> np.ndarray:
        first = 150
        share = np.linspace(0.0, 1.0, frames + 1)[:, None]
        last = places[first + frames, 1]
        places[first : first + frames + 1, 1] = (1.0 - share) * places[first, 1] + share * last
        return places

    return change


def filtered(hertz: float) -> Callable[[ForcePlate], ForcePlate]:
    """Force through a low-pass filter, forwards and backwards; the centre of pressure as it was."""
    b, a = butter(2, hertz / 500.0)

    def change(plate: ForcePlate) -> ForcePlate:
        return replace(plate, wrench=replace(plate.wrench, force=filtfilt(b, a, plate.wrench.force, axis=0)))

    return change


def capped(share: float) -> Callable[[ForcePlate], ForcePlate]:
    """A plate whose range ends at this share of its largest force."""

    def change(plate: ForcePlate) -> ForcePlate:
        force = plate.wrench.force.copy()
        force[:, 1] = np.minimum(force[:, 1], share * force[:, 1].max())
        return replace(plate, wrench=replace(plate.wrench, force=force))

    return change


def doubled(by: float) -> Callable[[np.ndarray], np.ndarray]:
    """The left PSIS at the place of the left ASIS, or so far above it [m]."""

    def change(places: np.ndarray) -> np.ndarray:
        places[:, 9] = places[:, 8] + np.array([0.0, by, 0.0])
        return places

    return change


def part(seen: MarkerTrajectories | None, frames: int) -> MarkerTrajectories:
    """Some frames in the swing of the left foot, in which all of that foot keeps its distances to all others."""
    assert seen is not None
    return MarkerTrajectories(seen.time[90 : 90 + frames], seen.positions[90 : 90 + frames], seen.names, seen.source)


def carried(kilograms: float) -> Callable[[TrialInputs], TrialInputs]:
    """A person whose upper arm is 0.3 m long, which belongs to 1.61 m."""
    return lambda _: TrialInputs(mass=kilograms, upper_arm=0.3)


DAMAGED: dict[str, tuple[str, Callable[[TrialInputs], TrialInputs]]] = {
    "a jump of 150 mm": ("jump", lambda t: moved(t, spiked(0.15))),
    "labels exchanged half-way": ("jump", lambda t: moved(t, swapped)),
    "ten times as fast": (
        "speed",
        lambda t: replace(t, markers=replace(t.markers, time=0.1 * t.markers.time), plates=()),
    ),
    "z is up": ("upright", lambda t: replace(t, markers=t.markers.turned(Z_UP), plates=())),
    "right called left": ("right and left", renamed),
    "heel and toes exchanged": ("heel and toes", lambda t: moved(replace(t, standing=None), heel_for_toe)),
    "plates 0.15 m aside": ("foot on plate", lambda t: moved(t, lambda p: p + np.array([0.0, 0.0, 0.15]))),
    "an axis mirrored": ("right and left", lambda t: moved(t, lambda p: p * np.array([1.0, 1.0, -1.0]))),
    "a marker that was moved": ("standing trial", lambda t: moved(t, aside(0.04))),
    "the standing trial of somebody else": ("standing trial", lambda t: moved(t, lambda p: 1.25 * p)),
    "mass x 0.7": ("mass", lambda t: replace(t, mass=0.7 * MASS)),
    "mass x 2.2, pounds": ("mass", lambda t: replace(t, mass=2.20462 * MASS)),
    "force / 2": ("mass", lambda t: plated(t, forced((0.5, 0.5, 0.5)))),
    "force in kN": ("mass", lambda t: plated(t, forced((0.1, 0.1, 0.1)))),
    "90 kg where the plate carries 75": ("standing weight", stood(90.0)),
    "force on the plate": ("force on the foot", lambda t: plated(t, forced((-1.0, -1.0, -1.0)))),
    "corners 0.4 m away": ("on the plate", lambda t: plated(t, edged(0.4))),
    "moments in N mm": ("size of shear", lambda t: plated(t, twisted)),
    "shear ten times": ("size of shear", lambda t: plated(t, forced((10.0, 1.0, 10.0)))),
    "sign along the walk": ("braking", lambda t: plated(t, forced((-1.0, 1.0, 1.0)))),
    "plates turned by 90 degrees": ("braking", lambda t: plated(t, lambda p: p.turned(TURNED))),
    "plates elsewhere": ("foot on plate", lambda t: moved(t, lambda p: p + np.array([0.8, 0.0, 0.0]))),
    "plates exchanged": ("foot on plate", exchanged),
    "one plate for both feet": (
        "one plate for each foot",
        lambda t: replace(t, plates=(t.plates[0], replace(t.plates[0], side="left"))),
    ),
    "centre of pressure in mm": ("foot on plate", lambda t: plated(t, millimetres)),
    "nobody on the plates": ("mass", lambda t: plated(t, forced((0.02, 0.02, 0.02)))),
    "floor 50 mm up": ("floor", lambda t: moved(t, lambda p: p + np.array([0.0, 0.05, 0.0]))),
    "a heel's marker 45 mm lower": ("floor", lambda t: moved(replace(t, standing=None), heels(0.045))),
    "markers in cm, called mm": (
        "unit of length",
        lambda t: moved(replace(t, standing=None, plates=()), lambda p: 0.1 * p),
    ),
    "a standing trial in cm": (
        "unit of length",
        lambda t: replace(t, standing=replace(t.standing, positions=10.0 * t.standing.positions)),
    ),
    "a foot that does not stand flat": ("foot while standing", lambda t: standing_moved(t, 1, 0.07)),
    "a floor 50 mm lower": ("foot while standing", lambda t: standing_moved(replace(t, floor=0.0), None, 0.05)),
    "the walk alone 50 mm up": ("floor of both trials", lambda t: moved(t, lambda p: p + np.array([0.0, 0.05, 0.0]))),
    "the plate of the other foot": ("at rest under load", lambda t: plated(t, later(0.45))),
    "a plate 0.1 s late": ("clock", lambda t: plated(t, later(0.1))),
    "a plate 0.1 s early": ("clock", lambda t: plated(t, later(-0.1))),
    "a marker that slips by 40 mm": ("one segment", lambda t: moved(replace(t, standing=None), slipping(0.04))),
    "thigh markers that part": ("one segment", labelled("RTH")),
    "the walk for the standing trial": ("standing trial twice", lambda t: replace(t, standing=t.markers)),
    "a marker's column copied": ("one marker twice", lambda t: moved(replace(t, standing=None), doubled(0.0))),
    "a gap filled with the last place": ("frozen marker", lambda t: moved(replace(t, standing=None), held(12))),
    "a gap filled by a straight line": ("frozen marker", lambda t: moved(replace(t, standing=None), bridged(18))),
    "force filtered at 3 Hz": ("clock", lambda t: plated(t, filtered(3.0))),
    "a plate's range that ends at 0.9 of the force": ("end of range", lambda t: plated(t, capped(0.9))),
    "no force along the floor": ("braking", lambda t: plated(t, forced((0.0, 1.0, 0.0)))),
    "a tenth of the force along the walk": ("braking", lambda t: plated(t, forced((0.1, 1.0, 1.0)))),
    "one component twice": ("copied component", lambda t: plated(t, one_twice)),
    "thirty frames missing": ("sampling", lambda t: later_half(t, 0.3)),
    "82 kg in pounds": ("mass and upper arm", carried(181.0)),
    **modelled.DAMAGED,
}
NEARLY: dict[str, Callable[[TrialInputs], TrialInputs]] = {
    "as it is": lambda t: t,
    "three times as fast": lambda t: replace(t, markers=replace(t.markers, time=t.markers.time / 3.0), plates=()),
    "a jump of 15 mm": lambda t: moved(t, spiked(0.015)),
    "a marker 15 mm elsewhere": lambda t: moved(t, aside(0.015)),
    "mass x 0.85": lambda t: replace(t, mass=0.85 * MASS),
    "mass x 1.3": lambda t: replace(t, mass=1.3 * MASS),
    "force x 0.8": lambda t: plated(t, forced((0.8, 0.8, 0.8))),
    "80 kg where the plate carries 75": stood(80.0),
    "toes 20 mm higher than the heel": lambda t: standing_moved(t, 1, 0.02),
    "a floor 15 mm lower": lambda t: standing_moved(replace(t, floor=0.0), None, 0.015),
    "6 frames along a straight line": lambda t: moved(replace(t, standing=None), bridged(6)),
    "a plate's range that ends at the force": lambda t: plated(t, capped(0.9999)),
    "force filtered at 20 Hz": lambda t: plated(t, filtered(20.0)),
    "half of the braking": lambda t: plated(t, forced((0.5, 1.0, 1.0))),
    "0.03 s late": lambda t: plated(t, later(0.03)),
    "floor 15 mm up": lambda t: moved(t, lambda p: p + np.array([0.0, 0.015, 0.0])),
    "plates 40 mm aside": lambda t: moved(t, lambda p: p + np.array([0.0, 0.0, 0.04])),
    "corners 0.25 m away": lambda t: plated(t, edged(0.25)),
    "a marker that slips by 15 mm": lambda t: moved(replace(t, standing=None), slipping(0.015)),
    "numbers that name no segment": labelled("M", "T", "marker_", "Point", "Th"),
    "a marker 5 mm beside another": lambda t: moved(replace(t, standing=None), doubled(0.005)),
    "0.2 s of a walk with the standing trial": lambda t: replace(t, markers=part(t.markers, 20), plates=()),
    "5 frames with the last place": lambda t: moved(replace(t, standing=None), held(5)),
    "heels' markers 30 mm lower": lambda t: moved(replace(t, standing=None), heels(0.03)),
    "half as large": lambda t: moved(replace(t, standing=None, plates=()), lambda p: 0.6 * p),
    "two frames missing": lambda t: later_half(t, 0.02),
    "110 kg with an upper arm of 0.3 m": carried(110.0),
    **modelled.NEARLY,
    "walking along -x": lambda t: replace(
        plated(t, lambda p: p.turned(Rotation.from_euler("y", 180.0, degrees=True))),
        markers=t.markers.turned(Rotation.from_euler("y", 180.0, degrees=True)),
    ),
}


@pytest.mark.parametrize("damage", DAMAGED)
def test_a_wrong_input_is_named(damage: str) -> None:
    check, change = DAMAGED[damage]
    assert check in spoke(change(walk()))


@pytest.mark.parametrize("change", NEARLY.values(), ids=NEARLY)
def test_what_nearly_trips_is_silent(change: Callable[[TrialInputs], TrialInputs]) -> None:
    assert spoke(change(walk())) == set()


def test_every_check_has_an_input_that_trips_it() -> None:
    assert {check for check, _ in DAMAGED.values()} == {check.name for check in CHECKS}


def test_landmarks_never_seen_together_have_no_breadth() -> None:
    """Nor a line of numpy's: the right one is seen in the first half, the left one in the second."""
    seen = marked(STANDING_STILL, walks=False)
    places, half = seen.positions.copy(), len(seen.time) // 2
    for name in ("RASI", "LASI"):
        places[slice(half, None) if name == "RASI" else slice(half), seen.names.index(name)] = np.nan
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not list(breadths(TrialInputs(replace(seen, positions=places))))


def test_same_recording_twice_is_refused() -> None:
    trial = walk()
    found = contradictions(replace(trial, standing=trial.markers))
    assert found[0][1].refuse and "frame by frame" in found[0][1].what


def test_exchanged_labels_are_refused_with_their_names_and_time() -> None:
    (found,) = [one for _, one in contradictions(moved(walk(), swapped)) if one.refuse]
    assert "RASI and LASI" in found.what and "1.80 s" in found.what


def test_mass_is_estimated() -> None:
    """0.8 times the weight for 1 / (2 x 0.62) = 0.806: the mass within 1 %."""
    (found,) = [one for check, one in contradictions(replace(walk(), mass=0.5 * MASS)) if check.name == "mass"]
    assert "about 76 kg" in found.remedy or "about 75 kg" in found.remedy


def test_another_mass_is_refused_with_that_of_the_plates() -> None:
    (found,) = [one for _, one in contradictions(stood(100.0)(walk()))]
    assert found.refuse and "75.0 kg" in found.remedy


def test_lateness_is_estimated() -> None:
    found = [one.what for check, one in contradictions(plated(walk(), later(0.12))) if check.name == "clock"]
    assert found and all("0.12 s after" in what or "0.11 s after" in what or "0.13 s after" in what for what in found)


def test_axes_that_would_mend_it_are_named() -> None:
    trial = walk()
    assert trial.markers is not None
    found = contradictions(TrialInputs(trial.markers.turned(Z_UP)))
    assert "`axes` x,z,-y" in found[0][1].remedy
