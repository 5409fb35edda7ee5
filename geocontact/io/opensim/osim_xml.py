"""OpenSim model files as XML: safe parsing, numbers with their place, frames and where they sit in their body."""

from __future__ import annotations

import re
from collections.abc import Iterator
from os import PathLike, fspath
from posixpath import join, normpath
from xml.etree.ElementTree import Element, ParseError, SubElement

import defusedxml.ElementTree  # type: ignore[import-untyped]
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.errors import InputError
from geocontact.data.plausible import LARGEST_MEANT
from geocontact.io.text.file_preflight import decoded, read_text_bytes

LARGEST_MODEL = 32_000_000
"""Bytes of an .osim file; full-body models are below 10 MB."""

OLDEST = 20_000
"""Version of files that are read, as they state it: OpenSim 2.0. Earlier ones write joints in other ways."""

_DEEPEST = 50
_SCOPED = re.compile(rb"(</?[A-Za-z_][\w.]*)::")
_COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
_ENCODING = re.compile(rb"""\s*<\?xml[^>]*encoding=["']([\w-]+)["']""")
_SETS = ("BodySet", "JointSet", "ForceSet", "ComponentSet")


def read_model(path: str | PathLike[str]) -> Element:
    """The `Model` element of an .osim file. External entities and entity expansion are refused."""
    root = read_document(path, "OpenSim model")
    model = root if root.tag == "Model" else root.find("Model")
    if root.tag not in ("OpenSimDocument", "Model") or model is None:
        what = f"root element is <{root.tag[:40]}>, not an OpenSim model"
        raise InputError(fspath(path), "", what, "give an .osim file")
    version = root.get("Version", "")
    if version.isdecimal() and int(version) < OLDEST:
        what = f"is of version {version}, before OpenSim 2.0"
        raise InputError(fspath(path), "", what, "open and save the model with OpenSim 3.3 or later")
    _gather(model)
    name_joints_apart(model)
    return model


def outside_of_sets(model: Element) -> list[Element]:
    """What a model holds by itself (`<components>`) where others have a set for it."""
    return [e for e in model.findall("components/*") if _set_of(e)]


def name_joints_apart(model: Element) -> None:
    """The second joint `back` of a model is `back_0`, the third `back_1`, as OpenSim calls them."""
    known: set[str] = set()
    for joint in (e for e in model.iter() if e.tag.endswith("Joint") and e.get("name")):
        name = joint.get("name", "")
        count = 0
        while name in known:
            name, count = f"{joint.get('name', '')}_{count}", count + 1
        joint.set("name", name)
        known.add(name)


def _gather(model: Element) -> None:
    """Put it into the sets, so that bodies, joints, markers, forces and constraints are found in one place."""
    for element in outside_of_sets(model):
        name = _set_of(element)
        holder = model.find(name)
        holder = SubElement(model, name) if holder is None else holder
        objects = holder.find("objects")
        (SubElement(holder, "objects") if objects is None else objects).append(element)
    for inner in model.findall("components"):
        for element in [e for e in inner if _set_of(e)]:
            inner.remove(element)


def _set_of(element: Element) -> str:
    kinds = {"Body": "BodySet", "Marker": "MarkerSet"}
    ends = {"Joint": "JointSet", "Force": "ForceSet", "Constraint": "ConstraintSet"}
    return kinds.get(element.tag, next((name for end, name in ends.items() if element.tag.endswith(end)), ""))


def read_document(path: str | PathLike[str], kind: str = "OpenSim document") -> Element:
    """Root of one of OpenSim's XML files. External entities and entity expansion are refused."""
    file = fspath(path)
    try:
        root = _parsed(_readable(read_text_bytes(file, LARGEST_MODEL, "is it a model?"), file))
    except InputError:
        raise
    except (ParseError, ValueError, LookupError) as error:
        raise InputError(file, "", f"not a readable {kind} ({error})", "is the file complete?") from error
    return root


def _readable(text: bytes, file: str) -> bytes:
    """The same in UTF-8 where it is said to be that, or nothing is said, and it is not."""
    said = _ENCODING.match(text)
    return text if said and said[1].lower() != b"utf-8" else decoded(text, file).encode()


def _parsed(text: bytes) -> Element:
    """Root of the document.

    OpenSim writes C++ scopes into tags (`HuntCrossleyForce::ContactParameters`), which XML does not allow: they are
    replaced before and put back after parsing.
    """
    stand_in = b"-scope-of-"
    plain = _SCOPED.sub(rb"\1" + stand_in, text)
    try:
        root: Element = defusedxml.ElementTree.fromstring(plain)
    except ParseError:
        root = defusedxml.ElementTree.fromstring(_without_comments(plain))
    if b"::" in text:
        for element in root.iter():
            element.tag = element.tag.replace(stand_in.decode(), "::")
    return root


def _without_comments(text: bytes) -> bytes:
    """OpenSim lets comments hold what XML does not allow there (`<!-- <!-- -->`, `--`); lines keep their numbers."""
    return _COMMENT.sub(lambda found: b"\n" * found[0].count(b"\n"), text)


def label(element: Element) -> str:
    """`CustomJoint knee_r`: how messages call an element."""
    return f"{element.tag} {element.get('name', '')}".strip()


def text_of(element: Element, child: str, default: str = "") -> str:
    """Text of a child element, stripped; the default where it is absent or empty."""
    found = element.find(child)
    return ((found.text or "") if found is not None else "").strip() or default


def is_true(file: str, element: Element, child: str) -> bool:
    """Flag in a child element; false where it is absent."""
    word = text_of(element, child, "false").lower()
    if word not in ("true", "false"):
        raise InputError(file, f"{label(element)} <{child}>", f"'{word[:40]}' is neither true nor false")
    return word == "true"


def numbers_of(
    file: str, element: Element, child: str, count: int | None, default: tuple[float, ...] | None = None
) -> Float[np.ndarray, " k"]:
    """Finite numbers in a child element, `count` of them unless None; without a default the child must be there."""
    text = text_of(element, child)
    if not text and default is not None:
        return np.array(default, dtype=float)
    try:
        values = np.array([float(word) for word in text.replace(",", " ").split()], dtype=float)
    except ValueError:
        values = np.array([np.nan])
    if not np.all(np.abs(values) <= LARGEST_MEANT) or (count is not None and len(values) != count):
        expected = "finite numbers" if count is None else f"{count} finite number{'s' * (count > 1)}"
        raise InputError(file, f"{label(element)} <{child}>", f"'{text[:60]}' where {expected} are expected")
    return values


def offset(orientation: Float[np.ndarray, " 3"], translation: Float[np.ndarray, " 3"]) -> RigidTransform:
    """Pose from OpenSim's body-fixed x-y-z angles [rad] and translation [m]: R = Rx Ry Rz."""
    return RigidTransform.from_components(translation, Rotation.from_euler("XYZ", orientation))


_OTHER_FRAMES = ("StationDefinedFrame", "OffsetFrame")


class Frames:
    """Bodies of a model and the offset frames fixed to them, by OpenSim's component path.

    Parameters
    ----------
    file, model
        As read by `read_model`.
    """

    def __init__(self, file: str, model: Element) -> None:
        self.file = file
        self.elements: dict[str, Element] = {}
        for path, element in _components(model):
            self.elements.setdefault(path, element)
        self._unread = {e.get("name", ""): f"a {e.tag[:40]}" for e in model.iter() if e.tag in _OTHER_FRAMES}
        if not {"/ground", "/bodyset/ground"} & set(self.elements):
            self.elements["/ground"] = Element("Ground", name="ground")

    def resolve(self, owner: str, socket: str) -> str:
        """Absolute path of the frame that a socket of component `owner` names: absolute, relative or a bare name."""
        path = normpath(join(owner, socket))
        if path in self.elements:
            return path
        name = socket.rsplit("/", 1)[-1]
        same = [known for known in self.elements if known.rsplit("/", 1)[-1] == name]
        bodies = [known for known in same if known.startswith(("/bodyset/", "/ground")) and known.count("/") < 3]
        if len(bodies or same) != 1:
            kind = "ambiguous" if same else self._unread.get(name, "neither a body nor an offset frame")
            what = f"frame '{socket[:80]}' of {owner} is {kind}"
            raise InputError(self.file, "", what, "bodies and PhysicalOffsetFrames are supported")
        return (bodies or same)[0]

    def in_body(self, path: str) -> tuple[str, RigidTransform]:
        """Name of the body that a frame is fixed to, and the frame's pose in it."""
        pose = RigidTransform.identity()
        for _ in range(_DEEPEST):
            element = self.elements[path]
            if element.tag != "PhysicalOffsetFrame":
                return element.get("name", ""), pose
            turn = numbers_of(self.file, element, "orientation", 3, (0.0, 0.0, 0.0))
            shift = numbers_of(self.file, element, "translation", 3, (0.0, 0.0, 0.0))
            pose = offset(turn, shift) * pose
            path = self.resolve(path, socket_of(element, "parent") or "..")
        raise InputError(self.file, path, "offset frames refer to each other in a circle", "correct the model")


def socket_of(element: Element, name: str) -> str:
    """Connectee of a socket; early 4.0 files write `socket_<name>_connectee_name`."""
    return text_of(element, f"socket_{name}") or text_of(element, f"socket_{name}_connectee_name")


def _components(model: Element) -> Iterator[tuple[str, Element]]:
    """Frames of a model with their absolute paths: bodies, offset frames of joints, bushings, bodies, the model."""
    pending = [("", model, 0)]
    while pending:
        owner, element, depth = pending.pop()
        if depth > _DEEPEST:
            continue
        for child in element:
            name = child.get("name", "")
            if child.tag in _SETS:
                pending.append((f"{owner}/{name or child.tag.lower()}", child, depth + 1))
            elif child.tag in ("objects", "components", "frames"):
                pending.append((owner, child, depth + 1))
            elif name and child.tag in ("Body", "Ground", "PhysicalOffsetFrame"):
                yield f"{owner}/{name}", child
                pending.append((f"{owner}/{name}", child, depth + 1))
            elif name:
                pending.append((f"{owner}/{name}", child, depth + 1))
