"""Which plate acts on which body: OpenSim's external loads (`ExternalLoads`), read and written."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from posixpath import basename
from xml.etree.ElementTree import Element

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.xml_text import escape, quoteattr
from geocontact.io.opensim.osim_xml import is_true, label, read_document, text_of
from geocontact.io.text.file_preflight import open_file

GROUND = ("ground", "/ground", "")
BEGINNING = 20_000
"""Bytes of a file in which its kind stands."""


@dataclass(frozen=True)
class ExternalLoad:
    """A plate of a file and the body that it acts on.

    Parameters
    ----------
    plate
        By the beginning of its columns of force.
    body
        By its name.
    torque
        Whether the plate's free torque acts too.
    force_frame, point_frame
        Bodies that force with torque, and point, are expressed in; "" for the ground.
    """

    plate: str
    body: str
    torque: bool = True
    force_frame: str = ""
    point_frame: str = ""

    @property
    def moves(self) -> bool:
        """Whether it is expressed in a body."""
        return bool(self.force_frame or self.point_frame)


def read_external_loads(path: str | PathLike[str]) -> tuple[Path, tuple[ExternalLoad, ...]]:
    """The file of the plates, beside this one unless it says otherwise, and who acts on whom.

    Points or torques of another plate than the force's are refused. Without a torque the plate's own does not act.
    """
    file = fspath(path)
    root = read_document(path)
    loads = [e for e in root.iter("ExternalForce") if not _is_off(file, e)]
    if not loads:
        raise InputError(file, "", "holds no ExternalForce that applies", "give OpenSim's external loads (.xml)")
    owner = next(root.iter("ExternalLoads"), root)
    data = text_of(owner, "datafile")
    if not data:
        raise InputError(file, "", "names no <datafile>", "name the .mot file of the plates")
    return Path(file).parent / data, tuple(_load(file, e) for e in loads)


def may_hold_loads(file: Path) -> bool:
    """Whether the beginning of an .xml has external loads, or that of a .mot columns of a force (…_vx)."""
    try:
        with open_file(file) as opened:
            text = opened.read(BEGINNING).decode("latin-1")
    except InputError:
        return False  # it is no input of the run
    if file.suffix.lower() == ".xml":
        return "<ExternalLoads" in text
    return re.search(r"(?:^|_)(?:v|f)x\s", text, re.IGNORECASE | re.MULTILINE) is not None


def _load(file: str, element: Element) -> ExternalLoad:
    frames = [text_of(element, f"{part}_expressed_in_body") for part in ("force", "point")]
    body, force = basename(text_of(element, "applied_to_body")), text_of(element, "force_identifier")
    if not body or not force:
        raise InputError(file, label(element), "names no body or no force", "give applied_to_body and force_identifier")
    stem = force.removesuffix("v")
    if not text_of(element, "point_identifier"):
        remedy = f"name the columns of the point, {stem}p: a force at a body's origin is not read"
        raise InputError(file, label(element), "names no <point_identifier>", remedy)
    if text_of(element, "point_identifier") != f"{stem}p":
        what = f"'{text_of(element, 'point_identifier')[:40]}' does not belong to the force '{force[:40]}'"
        raise InputError(file, f"{label(element)} <point_identifier>", what, f"expected {stem}p")
    torque = text_of(element, "torque_identifier")
    known = {stem.replace("force", word) + letter for word in ("torque", "moment") for letter in ("", "m")}
    if torque and torque not in known | {each.rstrip("_") for each in known}:  # a beginning of the names, OpenSim says
        what = f"'{torque[:40]}' does not belong to the force '{force[:40]}'"
        raise InputError(file, f"{label(element)} <torque_identifier>", what, f"expected {min(known)}")
    named = ["" if each in GROUND else basename(each) for each in frames]
    if named[0] and not named[1]:
        what = f"the force is expressed in {named[0]} and its point in the ground: a plate has both in the ground"
        warnings.warn(
            InputWarning(f"{file} {label(element)}: {what}; is <force_expressed_in_body> ground?"), stacklevel=2
        )
    return ExternalLoad(stem.rstrip("_"), body, bool(torque), *named)


def _is_off(file: str, element: Element) -> bool:
    if element.find("appliesForce") is not None:
        return not is_true(file, element, "appliesForce")
    return is_true(file, element, "isDisabled")


FORCE = """\t\t\t<ExternalForce name={name}>
\t\t\t\t<applied_to_body>{body}</applied_to_body>
\t\t\t\t<force_expressed_in_body>{frame}</force_expressed_in_body>
\t\t\t\t<point_expressed_in_body>{frame}</point_expressed_in_body>
\t\t\t\t<force_identifier>{stem}_v</force_identifier>
\t\t\t\t<point_identifier>{stem}_p</point_identifier>
\t\t\t\t<torque_identifier>{torque}</torque_identifier>
\t\t\t</ExternalForce>
"""
WHOLE = """<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="40000">
\t<ExternalLoads name="externalloads">
\t\t<objects>
{forces}\t\t</objects>
\t\t<groups />
\t\t<datafile>{data}</datafile>
\t</ExternalLoads>
</OpenSimDocument>
"""


def write_external_loads(
    path: Path, data: str, bodies: Mapping[str, str], *, torques: bool = False, frame: str = "ground"
) -> None:
    """Forces in the ground's frame or a body's, with torques or without.

    Parameters
    ----------
    data
        Name of the .mot file beside this one, with columns STEM_vx … and STEM_px ….
    bodies
        Body that each force acts on, by its stem, which holds the word "force".
    torques
        Whether there are columns of torques, named as those of the force with the word "torque": left_torque_x for
        left_force_vx.
    frame
        Body in whose frame forces, points and torques are.
    """
    forces = "".join(
        FORCE.format(
            name=quoteattr(stem),
            body=escape(body),
            frame=escape(frame),
            stem=escape(stem),
            torque=escape(stem.replace("force", "torque") + "_") if torques else "",
        )
        for stem, body in bodies.items()
    )
    path.write_text(WHOLE.format(forces=forces, data=escape(data)), encoding="utf-8")
