"""Set-up files with which OpenSim's own tools do what an analysis did here; `tool_setup` reads them back.

Files are named by their whole paths or relative to the set-up's folder; "" is none.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.markers import MarkerTasks
from geocontact.io.opensim.marker_weights import FROM_FILE

Ends = tuple[float, float]
NONE = "Unassigned"
NOT_TRACKED = "Muscles", "Actuators"
"""Kinds of a model's forces, by OpenSim's own words for them: they never act in inverse dynamics here."""


def write_ik_setup(
    path: Path, model: str, markers: str, follow: str, tasks: MarkerTasks, span: Ends, *, out: str
) -> None:
    """Inverse kinematics of a .trc file between two times [s].

    Parameters
    ----------
    model, markers
        .osim and .trc file.
    follow
        Recording that tasks of the kind from_file keep coordinates near.
    out
        Name of the motion that OpenSim writes.
    """
    root, tool = _tool("InverseKinematicsTool", path)
    _texts(tool, model_file=model, marker_file=markers, coordinate_file=follow or NONE)
    _texts(tool, time_range=_span(span), output_motion_file=out)
    _tasks(tool, tasks)
    _write(root, path)


def write_id_setup(
    path: Path,
    model: str,
    coordinates: str,
    loads: str,
    span: Ends,
    *,
    cutoff: float,
    exclude: Sequence[str],
    out: str,
) -> None:
    """Inverse dynamics of a .mot file between two times [s].

    Parameters
    ----------
    loads
        External loads (.xml).
    cutoff
        Of the low-pass of the coordinates [Hz]; 0 for none.
    exclude
        Passive forces of the model that are left out, by name or by group.
    out
        Name of the file of forces that OpenSim writes.
    """
    root, tool = _tool("InverseDynamicsTool", path)
    _texts(
        tool,
        results_directory=".",
        model_file=model,
        time_range=_span(span),
        forces_to_exclude=" ".join((*NOT_TRACKED, *exclude)),
        external_loads_file=loads or NONE,
        coordinates_file=coordinates,
        lowpass_cutoff_frequency_for_coordinates=f"{cutoff if cutoff > 0.0 else -1.0:.12g}",
        output_gen_force_file=out,
    )
    _write(root, path)


def write_scale_setup(
    path: Path,
    model: str,
    marker_set: str,
    markers: str,
    factors: Mapping[str, Float[np.ndarray, " 3"]],
    tasks: MarkerTasks,
    span: Ends,
    *,
    mass: float | None,
    by_volume: bool,
    place: bool,
    out: str,
    measured: Sequence[str] = (),
) -> None:
    """Scaling by these factors along the axes of each body, then the static pose of a .trc file.

    Parameters
    ----------
    marker_set
        Markers in place of the model's (.xml).
    mass
        Of all bodies together [kg], shared as in the model; None to leave them.
    by_volume
        Whether bodies become heavier as their volume grows before that.
    place
        Whether markers move to where they were seen.
    out
        Name of the model that OpenSim writes.
    measured
        Bodies and pairs of markers, femur_r:y=R.Hip/R.Knee, by which OpenSim measures the factors itself, in place of
        these numbers.
    """
    root, tool = _tool("ScaleTool", path)
    _texts(tool, mass="-1" if mass is None else f"{mass:.12g}")
    maker, scaler, placer = (SubElement(tool, name) for name in ("GenericModelMaker", "ModelScaler", "MarkerPlacer"))
    _texts(maker, model_file=model, marker_set_file=marker_set or NONE)
    _texts(scaler, apply="true", scaling_order="measurements" if measured else "manualScale")
    if measured:
        _measurements(scaler, measured)
    else:
        sizes = SubElement(SubElement(scaler, "ScaleSet"), "objects")
        for body, by in factors.items():
            numbers = " ".join(f"{each:.17g}" for each in by)
            _texts(SubElement(sizes, "Scale"), scales=numbers, segment=body, apply="true")
    _texts(
        scaler,
        marker_file=markers,
        time_range=_span(span),
        preserve_mass_distribution=str(not by_volume).lower(),
        output_model_file=out if not place else "",
    )
    _texts(placer, apply=str(place).lower())
    _tasks(placer, tasks)
    _texts(placer, marker_file=markers, time_range=_span(span), output_model_file=out, max_marker_movement="-1")
    _write(root, path)


def _measurements(scaler: Element, measured: Sequence[str]) -> None:
    """A measurement for each text."""
    found = SubElement(SubElement(scaler, "MeasurementSet"), "objects")
    for text in measured:
        bodies, _, pairs = text.partition("=")
        each = SubElement(found, "Measurement", name=bodies.replace(",", "_").replace(":", "_"))
        _texts(each, apply="true")
        ends = SubElement(SubElement(each, "MarkerPairSet"), "objects")
        for pair in pairs.split(","):
            _texts(SubElement(ends, "MarkerPair"), markers=pair.replace("/", " "))
        scaled = SubElement(SubElement(each, "BodyScaleSet"), "objects")
        for body in bodies.split(","):
            name, _, axes = body.partition(":")
            _texts(SubElement(scaled, "BodyScale", name=name), axes=" ".join(axes.upper() or "XYZ"))


def _tool(name: str, path: Path) -> tuple[Element, Element]:
    root = Element("OpenSimDocument", Version="40000")
    return root, SubElement(root, name, name=path.stem)


def _tasks(owner: Element, tasks: MarkerTasks) -> None:
    objects = SubElement(SubElement(owner, "IKTaskSet"), "objects")
    for name, weight in tasks.markers.items():
        _texts(SubElement(objects, "IKMarkerTask", name=name), apply="true", weight=f"{weight:.12g}")
    for name, (weight, wanted) in tasks.coordinates.items():
        task = SubElement(objects, "IKCoordinateTask", name=name)
        _texts(task, apply="true", weight=f"{weight:.12g}")
        _texts(task, value_type="default_value" if wanted is None else "manual_value")
        if wanted is not None:
            _texts(task, value=f"{wanted:.17g}")
    for name, weight in tasks.from_file.items():
        _texts(SubElement(objects, "IKCoordinateTask", name=name), apply="true", weight=f"{weight:.12g}")
        _texts(objects[-1], value_type=FROM_FILE)


def _texts(owner: Element, **texts: str) -> None:
    for name, text in texts.items():
        SubElement(owner, name).text = text


def _span(span: Ends) -> str:
    return f"{span[0]:.12g} {span[1]:.12g}"


def _write(root: Element, path: Path) -> None:
    indent(root, "\t")
    ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
