"""OpenSim's set-up files of its tools: what they ask for, as inputs and options of the same analyses here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from geocontact.data.errors import InputError
from geocontact.io.opensim.marker_weights import read_marker_weights
from geocontact.io.opensim.osim_forces import ALL, MUSCLES
from geocontact.io.opensim.osim_xml import is_true, label, numbers_of, read_document, read_model, text_of
from geocontact.io.text.tables import listed

UNASSIGNED = ("", "unassigned")


@dataclass(frozen=True)
class ToolSetup:
    """What a set-up asks for.

    Parameters
    ----------
    recording
        File of coordinates or markers.
    options
        Name and value of each, as they are typed; a name may be there several times.
    unheeded
        What is asked for and not done here.
    """

    recording: Path
    options: tuple[tuple[str, str], ...]
    unheeded: tuple[str, ...] = ()


def read_tool_setup(path: str | PathLike[str], tool: str) -> ToolSetup:
    """Set-up of `InverseKinematicsTool`, `InverseDynamicsTool` or `ScaleTool`; its paths are relative to its folder."""
    file = fspath(path)
    root = read_document(path, "OpenSim set-up")
    element = root if root.tag == tool else root.find(tool)
    if element is None:
        raise InputError(file, "", f"holds no <{tool}>", f"give the set-up of OpenSim's {tool}")
    return _TOOLS[tool](file, element)


def _inverse_dynamics(file: str, tool: Element) -> ToolSetup:
    options = [*_files(file, tool, {"model_file": "model", "external_loads_file": "loads"}), *_time(file, tool)]
    cutoff = float(numbers_of(file, tool, "lowpass_cutoff_frequency_for_coordinates", 1, (-1.0,))[0])
    options.append(("cutoff", str(max(cutoff, 0.0))))
    left_out = text_of(tool, "forces_to_exclude").split()
    options += [("exclude", word) for word in left_out]
    unheeded = tuple(
        name for name in ("joints_to_report_body_forces", "states_file", "speeds_file") if _assigned(tool, name)
    )
    unheeded += _at_rest(dict(options).get("model", ""), left_out)
    return ToolSetup(_needed(file, tool, "coordinates_file"), tuple(options), unheeded)


def _at_rest(model: str, left_out: list[str]) -> tuple[str, ...]:
    """Muscles that OpenSim's tool lets act without control: where a set-up does not say otherwise, all of them."""
    if {MUSCLES, ALL} & {word.lower() for word in left_out} or not model or not Path(model).is_file():
        return ()
    count = sum("Muscle" in e.tag for e in read_model(model).findall("ForceSet/objects/*"))
    return (f"passive force of {count} muscles, which forces_to_exclude does not leave out,",) if count else ()


def _inverse_kinematics(file: str, tool: Element) -> ToolSetup:
    options = [*_files(file, tool, {"model_file": "model"}), ("tasks", _tasks(file, tool)), *_time(file, tool)]
    if read_marker_weights(dict(options)["tasks"]).from_file:  # else OpenSim does not look at the file either
        options += _files(file, tool, {"coordinate_file": "follow"})
    return ToolSetup(_needed(file, tool, "marker_file"), tuple(options), _soft(tool, dict(options).get("model", "")))


def _soft(tool: Element, model: str) -> tuple[str, ...]:
    """A weight of constraints, where the model has some: they are exact here."""
    weight = text_of(tool, "constraint_weight", "Infinity")
    if weight.lower().startswith("inf") or not model or not Path(model).is_file():
        return ()
    held = read_model(model).findall("ConstraintSet/objects/*")
    return (f"constraint_weight {weight[:20]}: constraints are exact,",) if held else ()


def _scale(file: str, tool: Element) -> ToolSetup:
    """Marker sets, measurements and factors by hand, mass, and the static pose."""
    maker, scaler, placer = (_part(file, tool, name) for name in ("GenericModelMaker", "ModelScaler", "MarkerPlacer"))
    files = {"model_file": "model", "marker_set_file": "marker-set"}
    options = _files(file, maker, files)
    scales = scaler.find("apply") is None or is_true(file, scaler, "apply")
    mass = float(numbers_of(file, tool, "mass", 1, (-1.0,))[0])
    if scales and mass > 0.0:
        options.append(("mass", str(mass)))
    wanted = _sizes(file, scaler) if scales else []
    sizes, lost = _of_bodies(wanted, dict(options).get("model", ""))
    if scales and not wanted and (order := text_of(scaler, "scaling_order")):
        lost = (f"scaling_order {order[:40]}, of which the set-up has nothing, so that no body is scaled,",)
    options += [("scale", text) for text in sizes]
    places = placer.find("apply") is None or is_true(file, placer, "apply")
    recording = _needed(file, placer if places or _assigned(placer, "marker_file") else scaler, "marker_file")
    tasks = _tasks(file, placer)
    if places or any(read_document(tasks).iter("IKMarkerTask")):  # else there is nothing that a pose could follow
        options.append(("tasks", tasks))
    options += _time(file, placer)
    if any(name == "scale" and "/" in text for name, text in options):
        options += _measuring(file, scaler, placer, recording)
    if scales and not is_true(file, scaler, "preserve_mass_distribution"):
        options.append(("mass-by-volume", ""))
    if not places:
        options.append(("keep-markers", ""))
    return ToolSetup(recording, tuple(options), lost)


def _of_bodies(sizes: list[str], model: str) -> tuple[list[str], tuple[str, ...]]:
    """Those of bodies that the model has, and what is said of the others, which OpenSim passes over."""
    if not sizes or not model or not Path(model).is_file():
        return sizes, ()  # the command says so
    known = {e.get("name", "") for e in read_model(model).findall("BodySet/objects/Body")}
    lost = dict.fromkeys(body for text in sizes if (body := text.partition(":")[0]) not in known)
    kept = [text for text in sizes if text.partition(":")[0] not in lost]
    return kept, (f"size of {listed(tuple(lost))}, which the model does not have,",) if lost else ()


def _measuring(file: str, scaler: Element, placer: Element, recording: Path) -> list[tuple[str, str]]:
    """Trial and times of the sizes of bodies, where they are not those of the static pose."""
    own = _needed(file, scaler, "marker_file") if _assigned(scaler, "marker_file") else recording
    times = _time(file, scaler)
    if own == recording and times == _time(file, placer):
        return []
    return [("sizes", str(own)), *(("sizes-time", span) for _, span in times)]


def _sizes(file: str, scaler: Element) -> list[str]:
    """Measurements and factors by hand in the order that is asked for, without an order none, as OpenSim has it; the
    last one of an axis counts.
    """
    told: dict[tuple[str, str], str] = {}
    for kind in text_of(scaler, "scaling_order").split():
        for body, axes, size in (_by_hand if kind == "manualScale" else _measured)(file, scaler):
            told.update({(body, axis): size for axis in axes})
    alike: dict[tuple[str, str], str] = {}
    for (body, axis), size in told.items():
        alike[body, size] = alike.get((body, size), "") + axis
    return [f"{body}:{axes}={size}" for (body, size), axes in alike.items()]


def _measured(file: str, scaler: Element) -> list[tuple[str, str, str]]:
    found = []
    for measure in _set_of(file, scaler, "MeasurementSet").findall("objects/Measurement"):
        if measure.find("apply") is not None and not is_true(file, measure, "apply"):
            continue
        pairs = [text_of(pair, "markers").split() for pair in measure.findall("MarkerPairSet/objects/MarkerPair")]
        if not pairs or any(len(pair) != 2 for pair in pairs):
            raise InputError(file, label(measure), "is not made of pairs of markers", "correct the set-up")
        size = ",".join("/".join(pair) for pair in pairs)
        bodies = measure.findall("BodyScaleSet/objects/BodyScale")
        found += [(body.get("name", ""), "".join(text_of(body, "axes").lower().split()), size) for body in bodies]
    return found


def _by_hand(file: str, scaler: Element) -> list[tuple[str, str, str]]:
    found = []
    for scale in _set_of(file, scaler, "ScaleSet").findall("objects/Scale"):
        if scale.find("apply") is not None and not is_true(file, scale, "apply"):
            continue
        factors = numbers_of(file, scale, "scales", 3)
        found += [(text_of(scale, "segment"), axis, f"{by:.17g}") for axis, by in zip("xyz", factors, strict=True)]
    return found


def _set_of(file: str, owner: Element, name: str) -> Element:
    """A set in the set-up itself, or in the file that it names; empty where there is neither."""
    found = owner.find(name)
    if found is None:
        return Element(name)
    if not (named := found.get("file", "")):
        return found
    other = Path(file).parent / named
    root = read_document(other, f"OpenSim {name}")
    inside = root if root.tag == name else root.find(name)
    if inside is None:
        raise InputError(str(other), "", f"holds no <{name}>", f"give the {name} that {Path(file).name} names")
    return inside


def _part(file: str, tool: Element, name: str) -> Element:
    element = tool.find(name)
    if element is None:
        raise InputError(file, label(tool), f"holds no <{name}>", "complete the set-up")
    return element


def _tasks(file: str, owner: Element) -> str:
    """The set-up itself, or the file that its task set stands in."""
    tasks = owner.find("IKTaskSet")
    named = "" if tasks is None else tasks.get("file", "")
    return str(Path(file).parent / named) if named else file


def _assigned(owner: Element, child: str) -> str:
    text = text_of(owner, child)
    return "" if text.lower() in UNASSIGNED else text


def _files(file: str, owner: Element, names: dict[str, str]) -> list[tuple[str, str]]:
    return [
        (option, str(Path(file).parent / text)) for child, option in names.items() if (text := _assigned(owner, child))
    ]


def _needed(file: str, owner: Element, child: str) -> Path:
    text = _assigned(owner, child)
    if not text:
        raise InputError(file, f"{label(owner)} <{child}>", "names no file", "complete the set-up")
    return Path(file).parent / text


def _time(file: str, owner: Element) -> list[tuple[str, str]]:
    """None where the whole recording is meant: no range, or one without ends."""
    text = text_of(owner, "time_range")
    words = text.lower().replace("infinity", "inf").split()
    try:
        ends = np.array([float(word) for word in words])
    except ValueError:
        ends = np.array([np.nan])
    if not words or (len(ends) == 2 and (np.isinf(ends).all() or (ends == -1.0).all())):
        return []
    if len(ends) != 2 or not np.isfinite(ends).all():
        what = f"'{text[:40]}' where a first and a last time are expected"
        raise InputError(file, f"{label(owner)} <time_range>", what, "write 0.4 1.6")
    return [("time", ":".join(str(float(end)) for end in ends))]


_TOOLS: dict[str, Callable[[str, Element], ToolSetup]] = {
    "InverseDynamicsTool": _inverse_dynamics,
    "InverseKinematicsTool": _inverse_kinematics,
    "ScaleTool": _scale,
}
