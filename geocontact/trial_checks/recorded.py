"""A recorded trial as its checks see it, and what a check says."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.data.multibody.force_plate import LOADED, ForcePlate
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody

UP = np.array([0.0, 1.0, 0.0])
"""Upwards in the model's axes."""


@dataclass(frozen=True, eq=False)
class FootPlate:
    """A plate, the file it is of, and the foot that is said to stand on it.

    Parameters
    ----------
    plate
        In the same axes as the markers.
    source
        Its file.
    side
        "right" or "left"; empty where nobody said.
    """

    plate: ForcePlate
    source: str
    side: str = ""

    @property
    def normal(self) -> Float[np.ndarray, " t"]:
        """Force out of the floor [N], over the plate's time; 0 where the file has nothing."""
        return np.asarray(np.nan_to_num(self.plate.wrench.force @ self.plate.normal))

    def steps(self, shortest: float) -> list[slice]:
        """Times at which somebody steps on the plate and off again, at least `shortest` [s] later.

        The load begins and ends below `LOADED` [N] within the recording.
        """
        on = np.concatenate([[False], self.normal >= LOADED, [False]])
        starts, stops = np.flatnonzero(~on[:-1] & on[1:]), np.flatnonzero(on[:-1] & ~on[1:])
        time, last = self.plate.time, len(self.plate.time)
        return [
            slice(int(a), int(b))
            for a, b in zip(starts, stops, strict=True)
            if a > 0 and b < last and time[b - 1] - time[a] >= shortest
        ]


@dataclass(frozen=True, eq=False)
class MovedModel:
    """A model and its coordinates over time, as a file has them.

    Parameters
    ----------
    model
        Of the person.
    time
        [s].
    values
        One column for each coordinate [rad, m]; that of one that the file does not have is its default.
    source
        The file.
    rates
        Of the same coordinates [rad/s, m/s], where a file of its own has them.
    """

    model: Multibody
    time: Float[np.ndarray, " t"]
    values: Float[np.ndarray, "t n"]
    source: str
    rates: Float[np.ndarray, "t n"] | None = None


@dataclass(frozen=True, eq=False)
class RecordedChannel:
    """A channel that is neither marker nor plate: a force, a moment, an angle, an electromyogram.

    Parameters
    ----------
    name, unit
        Its name, and the SI unit of its values.
    time, values
        [s], and in that unit; NaN where nothing was measured.
    source
        The file.
    """

    name: str
    unit: str
    time: Float[np.ndarray, " t"]
    values: Float[np.ndarray, " t"]
    source: str


@dataclass(frozen=True, eq=False)
class TrialInputs:
    """Whatever an analysis was given of a trial, in one set of axes and on one clock.

    Parameters
    ----------
    markers, standing
        Markers of the trial, and of a trial in which the person stands still; None where there are none.
    plates
        Plates that the analysis uses.
    mass, height
        Of the person [kg, m]; None where it is not given.
    age
        Of the person [years]; None where it is not given, which is that of an adult.
    upper_arm
        Of the person, shoulder to elbow [m]; None where it is not given.
    mass_option
        How the user gave it, for messages: an option or a key of a file.
    stands_at
        Time at which the person stands on the plates, all together, and hardly moves [s]; None where none is known.
    surely
        Whether both feet are known to be on these plates then, and not only that the load is steady.
    floor
        Height of the floor that the analysis takes [m]; None where it takes none.
    up
        Unit vector upwards.
    turn
        By which the files were turned into these axes; None where they were not.
    moved
        A model along the coordinates of a file; None where none are read.
    channels
        Whatever else was recorded.
    walk
        Velocity of the hip over the foot in a step [m/s], where there are no markers; None where it is not known.
    on_sole
        Whether heel and toes are points of the sole, and no markers above it.
    beside
        Further plates of the same file, on which the other foot may stand.
    """

    markers: MarkerTrajectories | None = None
    standing: MarkerTrajectories | None = None
    plates: tuple[FootPlate, ...] = ()
    mass: float | None = None
    height: float | None = None
    upper_arm: float | None = None
    mass_option: str = "`mass`"
    age: float | None = None
    stands_at: float | None = None
    surely: bool = True
    floor: float | None = None
    up: Float[np.ndarray, " 3"] = field(default_factory=UP.copy)
    turn: Rotation | None = None
    moved: MovedModel | None = None
    channels: tuple[RecordedChannel, ...] = ()
    walk: Float[np.ndarray, " 3"] | None = None
    on_sole: bool = False
    beside: tuple[ForcePlate, ...] = ()

    @property
    def recordings(self) -> tuple[MarkerTrajectories, ...]:
        """The recordings of markers that there are."""
        return tuple(each for each in (self.standing, self.markers) if each is not None)


@dataclass(frozen=True)
class Contradiction:
    """Two inputs that cannot both be right.

    Parameters
    ----------
    source, place
        The file, and where in it or by which option.
    what
        What is compared with what, with both numbers.
    remedy
        The likely cause and what to do about it.
    refuse
        Whether no result would mean anything.
    """

    source: str
    place: str
    what: str
    remedy: str
    refuse: bool = False

    def __str__(self) -> str:
        where = " ".join(part for part in (self.source, self.place) if part)
        return f"{where}: {self.what}; {self.remedy}"


@dataclass(frozen=True)
class Check:
    """A comparison of two inputs of one trial.

    Parameters
    ----------
    name
        A short name for the table.
    compares
        What is compared with what.
    limit
        From which difference on it speaks, and where that limit comes from.
    find
        All contradictions in a trial; nothing where an input that it needs is not there.
    of_all
        Whether it is about all samples, so that a result which contradicts its data may come from it; else about a few.
    """

    name: str
    compares: str
    limit: str
    find: Callable[[TrialInputs], Iterator[Contradiction]]
    of_all: bool = True
