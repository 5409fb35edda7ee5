"""How often and how large: rates of sampling, breadths of a body, and the size of whatever else was recorded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.trial_checks.landmarks import middle
from geocontact.trial_checks.recorded import Check, Contradiction, TrialInputs

MISSING = 4.5
"""Steps of time that one step may last; loggers that skip samples skip one or two."""
SLOWEST, FASTEST, ENOUGH = 8.0, 50_000.0, 10
"""Hz, and samples from which a rate is looked at. Cameras take 25 to 500, plates 100 to 5000, electromyographs up to
4000 (Winter, Biomechanics and Motor Control of Human Movement, 2009, section 3.4)."""


@dataclass(frozen=True)
class Size:
    """How large the largest value of a channel is.

    Parameters
    ----------
    least, most
        In the SI unit.
    likely
        What it may be where it is less, and where it is more.
    source
        Where the two are from.
    """

    least: float
    most: float
    likely: tuple[str, str]
    source: str


SIZES = {
    "N": Size(0.05, 2e4, ("kN", "mN"), "a cuff at rest; 12 times the weight, a jump's landing"),
    "N m": Size(5e-3, 2e3, ("kN m", "N mm"), "a finger; 10 N m/kg of a jump"),
    "rad": Size(1e-4, 20.0, ("turns", "degrees"), "sway of who stands; three turns"),
    "m": Size(1e-5, 50.0, ("km", "mm"), "skin; the length of a hall"),
    "Pa": Size(10.0, 5e8, ("MPa", "mPa"), "a cell of a mat at rest; strength of bone and metal"),
    "V": Size(1e-6, 20.0, ("kV", "mV"), "noise of an electromyogram's electrode; an amplifier's supply"),
}
"""By unit; what people, their implants and devices do not go beyond."""


BREADTHS = {
    "pelvis": (("asis",), ("asis",), 0.12, 0.5),
    "shoulders": (("shoulder",), ("shoulder",), 0.15, 0.8),
    "foot": (("heel",), ("toe",), 0.07, 0.45),
}
"""Landmarks on the right and on the left, of a foot heel and toes of one side, and m between which they are apart; in
recordings of five people 0.25 to 0.28, 0.31 to 0.42 and 0.18 to 0.28 m, so that the limits hold a child too."""


def breadths(trial: TrialInputs) -> Iterator[Contradiction]:
    """Breadth of pelvis and shoulders and length of the feet, by their labels, with those of people."""
    for seen in trial.recordings:
        off: list[str] = []
        for part, (ones, others, least, most) in BREADTHS.items():
            for side in ("right", "left") if part == "foot" else ("",):
                one, other = middle(seen, ones, side or "right"), middle(seen, others, side or "left")
                if one is None or other is None:
                    continue
                both = np.linalg.norm(one - other, axis=1)
                if np.isnan(both).all():  # never seen together
                    continue
                apart = float(np.nanmedian(both))
                if not least <= apart <= most:
                    which = f"{side} foot" if side else part
                    off.append(f"{which} {1e3 * apart:.3g} mm")
        if off:
            what = f"its markers are too near or too far from each other: {', '.join(off)}"
            yield Contradiction(seen.source, "", what, "is its unit of length right?")


def _rate(time: Float[np.ndarray, " t"]) -> float:
    """Samples in a second, by the median step [Hz]; NaN for few."""
    return 1.0 / float(np.median(np.diff(time))) if len(time) >= ENOUGH else float("nan")


def rates(trial: TrialInputs) -> Iterator[Contradiction]:
    """Samples in a second of markers, plates, coordinates and channels."""
    clocks = [(seen.source, "", seen.time) for seen in trial.recordings]
    clocks += [(on.source, on.plate.name, on.plate.time) for on in trial.plates]
    clocks += [(one.source, one.name, one.time) for one in trial.channels]
    clocks += [] if trial.moved is None else [(trial.moved.source, "", trial.moved.time)]
    said: set[tuple[str, float]] = set()
    for source, place, time in clocks:
        if (source, _rate(time)) not in said:
            said.add((source, _rate(time)))
            yield from odd_rate(source, place, time)


def odd_rate(
    source: str, place: str, time: Float[np.ndarray, " t"], slowest: float = SLOWEST
) -> Iterator[Contradiction]:
    """Samples in a second of one recording, at least `slowest` [Hz], and the longest time without one."""
    rate = _rate(time)
    if np.isfinite(rate) and not slowest <= rate <= FASTEST:
        what = f"has {rate:.3g} samples in a second, over {time[-1] - time[0]:.4g} s"
        yield Contradiction(source, place, what, "is its time in s, not in ms, frames or minutes?")
    if len(time) < ENOUGH:
        return
    steps = np.diff(time)
    k, usual = int(np.argmax(steps)), float(np.median(steps))
    if steps[k] > MISSING * usual:
        what = f"has nothing from {time[k]:.4g} to {time[k + 1]:.4g} s, and otherwise a sample every {usual:.3g} s"
        yield Contradiction(source, place, what, "are rows missing? gaps are bridged, as if they had been measured")


def sizes_of_channels(trial: TrialInputs) -> Iterator[Contradiction]:
    """Largest value of a channel with what its unit can be."""
    for one in trial.channels:
        known = SIZES.get(one.unit)
        values = np.abs(one.values[np.isfinite(one.values)])
        if known is None or not values.any():
            continue
        largest = float(values.max())
        if not known.least <= largest <= known.most:
            likely = known.likely[0 if largest < known.least else 1]
            what = f"{one.name} reaches {largest:.3g} {one.unit}"
            yield Contradiction(one.source, "", what, f"is it in {likely}?")


LENGTH_CHECKS = (
    Check(
        "unit of length",
        "breadth of pelvis and shoulders, and length of the feet, with those of people",
        "; ".join(f"{least:g} to {most:g} m" for _, _, least, most in BREADTHS.values())
        + "; five people: 0.25 to 0.28, 0.31 to 0.42, 0.18 to 0.28 m",
        breadths,
    ),
)
"""A check of the unit, before those that another unit makes speak."""
CHANNEL_CHECKS = (
    Check(
        "sampling",
        "samples in a second with those of measuring devices, and the longest step of time with the usual one",
        f"{SLOWEST:g} to {FASTEST:g} Hz; cameras take 25 to 500, plates 100 to 5000 (Winter, Biomechanics, 2009); "
        f"{MISSING:g} steps",
        rates,
    ),
    Check(
        "size of a channel",
        "largest value of every other channel with what its unit can be",
        "; ".join(f"{one.least:g} to {one.most:g} {unit} ({one.source})" for unit, one in SIZES.items()),
        sizes_of_channels,
    ),
)
"""Checks of time and of whatever else was recorded."""
