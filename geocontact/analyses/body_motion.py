"""Poses of one body over time, as the options of an analysis name them."""

from __future__ import annotations

from pathlib import Path
from typing import Literal, Protocol, runtime_checkable

from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.io.motion.motion import read_motion


@runtime_checkable
class MotionOptions(Protocol):
    """Options that say where poses come from; see `read_motion`."""

    @property
    def osim(self) -> Path | None:
        """Model whose joint turns coordinates into poses."""

    @property
    def joint(self) -> str | None:
        """Name of that joint."""

    @property
    def moving_body(self) -> Literal["child", "parent"] | None:
        """Which of its bodies moves."""

    @property
    def map(self) -> str | None:
        """Columns instead of a model."""

    @property
    def order(self) -> str | None:
        """Order of intrinsic rotations."""

    @property
    def angles(self) -> Literal["deg", "rad"] | None:
        """Unit of angles where the file does not say."""


def read_body_motion(record: Record, file: Path, o: MotionOptions) -> Motion:
    """Poses over seconds; InputError where `order` or `angles` has no effect, or time is in per cent of a cycle."""
    motion = read_motion(
        file,
        osim=o.osim,
        joint=o.joint,
        moving=o.moving_body or "child",
        mapping=o.map,
        order=o.order,
        angles=o.angles,
    )
    for option, value in (("order", o.order), ("angles", o.angles)):
        if value is not None and option not in motion.heeded:
            what = f"has no effect here: {file} is read without it"
            raise InputError("", f"`{option}`", what, "leave it out")
    if motion.time_unit != "s":
        raise InputError(file, "", "time is in per cent of a cycle", "write its time in s: rates and loads need it")
    record.add_input("motion", file, frames=len(motion), source=motion.source)
    if o.osim is not None:
        record.add_input("model", o.osim, joint=o.joint)
    return motion
