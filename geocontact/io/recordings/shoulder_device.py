"""Files about a shoulder exoskeleton and its wearer: numbers of the device with sources, lengths of the person."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from pydantic import create_model

from geocontact.data.errors import InputError
from geocontact.data.plausible import Plausible
from geocontact.data.units import mm
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Document, Some, WithUnit, Word, checked
from geocontact.io.text.toml_text import toml_of

OF_PERSON = Plausible("a length of a person", mm, (100.0, 1000.0))
"""Upper arm, torso, or between the shoulders."""
LARGEST = 100_000
"""Bytes of a description."""


@dataclass(frozen=True)
class StatedNumber:
    """A number of a device in SI, where it is from, and why it is so."""

    value: float
    source: str
    note: str


@dataclass(frozen=True)
class SourcedQuantity(WithUnit):
    """A quantity that may say where it is from, in one of the words of `sources`."""

    sources: tuple[str, ...] = ()

    @property
    def example(self) -> str:
        """How it may be written."""
        value, unit = (32, "mm") if self.si == "m" else (1, self.si)
        return f'{{ value = {value}, unit = "{unit}", source = "invented", note = "why" }}'

    def sourced(self, stated: Any) -> StatedNumber:
        """The value in SI with what is said of it."""
        value, source = self.read(stated), str(stated.get("source", "invented"))
        if source not in self.sources:
            raise refusal(f"source {source!r:.60} is not known", f"write one of {', '.join(self.sources)}")
        return StatedNumber(value, source, str(stated.get("note", "")))

    def validated(self, stated: object, info: Any) -> StatedNumber:
        """What `sourced` makes of it, with a warning where that is unusual."""
        found = self.sourced(stated)
        self.doubted(found.value, stated, info)
        return found


class DeviceDescription(Document):
    """What differs from a device that is built in.

    Parameters
    ----------
    name
        For the record; the file's name by default.
    based_on
        The built-in device whose numbers count where none is given.
    numbers
        Numbers by name: `NAME = { value, unit, source, note }`.
    hinges
        Hinges and stroke of its cylinder, in the same way, in place of its levers: rod_y, rod_z, frame_y, frame_z,
        retracted, extended.
    controller
        Thresholds and sensors of its controller, in the same way: low, high, up, down, still, on, off, confirmed,
        running, smoothing, settled, turned, angle_noise, angle_step, delay, current_noise.
    """

    name: Word | None = None
    based_on: Word = "lucy"
    numbers: Mapping[str, Any] = {}
    hinges: Mapping[str, Any] = {}
    controller: Mapping[str, Any] = {}


@dataclass(frozen=True)
class DeviceFile:
    """Name, the device whose numbers count where none is given, and the numbers that are given."""

    name: str
    based_on: str
    numbers: Mapping[str, StatedNumber]
    controller: Mapping[str, StatedNumber]
    hinges: Mapping[str, StatedNumber]


def read_device_file(
    path: Path,
    units: Mapping[str, str],
    controlled: Mapping[str, str],
    sources: tuple[str, ...],
    hinges: Mapping[str, str],
) -> DeviceFile:
    """A device from `device.toml`; InputError for what it cannot be.

    Parameters
    ----------
    units, controlled
        SI unit of every number that a device has, and of every one that its controller has.
    sources
        Words that may say where a number is from.
    hinges
        SI unit of every number of a cylinder's hinges.
    """
    fields: dict[str, Any] = {}
    for field, own in (("numbers", units), ("hinges", hinges), ("controller", controlled)):
        some = Some(
            {name: Annotated[StatedNumber, SourcedQuantity(unit, sources=sources)] for name, unit in own.items()}
        )
        fields[field] = (Annotated[dict[str, StatedNumber], some], {})
    kind = create_model("Device", __base__=DeviceDescription, **fields)
    found: DeviceDescription = checked(path, kind, toml_of(path, LARGEST))
    return DeviceFile(found.name or path.stem, found.based_on, found.numbers, found.controller, found.hinges)


def read_person_file(path: Path, names: tuple[str, ...]) -> dict[str, float]:
    """Lengths of a person [m] from a TOML file, `upper_arm = { value = 300, unit = "mm" }`; any may be missing."""
    length = WithUnit(OF_PERSON)
    content = {name: each for name, each in toml_of(path, LARGEST).items() if name in names}
    if not content:
        raise InputError(path, "", f"none of {', '.join(names)}", f"write upper_arm = {length.example}")
    lengths: dict[str, float] = checked(
        path, Annotated[dict[str, float], Some(dict.fromkeys(names, Annotated[float, length]))], content
    )
    return lengths
