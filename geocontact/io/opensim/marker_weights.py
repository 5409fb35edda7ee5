"""Weights of inverse kinematics from OpenSim's setup files: `IKTaskSet` in a tool's setup or by itself."""

from __future__ import annotations

from os import PathLike, fspath
from os.path import realpath
from pathlib import Path
from xml.etree.ElementTree import Element

from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTasks
from geocontact.io.opensim.osim_xml import is_true, label, numbers_of, read_document, text_of

FROM_FILE = "from_file"


def read_marker_weights(path: str | PathLike[str]) -> MarkerTasks:
    """Markers and coordinates with their weights; a task without a weight, or that does not apply, counts nothing.

    A coordinate is wanted at the model's default, at the task's own value, or near a recording that the tool's set-up
    names elsewhere. Where the set is named by its file (`<IKTaskSet file="tasks.xml"/>`), that file is read.
    """
    file = fspath(tasks_file(path))
    root = read_document(file)
    markers = {e.get("name", ""): _weight(file, e) for e in root.iter("IKMarkerTask")}
    weighed = [(e, _weight(file, e)) for e in root.iter("IKCoordinateTask")]
    held = [(e, weight, text_of(e, "value_type", "default_value")) for e, weight in weighed if weight > 0.0]
    followed = {e.get("name", ""): weight for e, weight, kind in held if kind == FROM_FILE}
    coordinates = {e.get("name", ""): (weight, _wanted(file, e, kind)) for e, weight, kind in held if kind != FROM_FILE}
    if not markers and not weighed:
        raise InputError(
            file, "", "holds no IKMarkerTask", "give OpenSim's setup of inverse kinematics or of scaling that has some"
        )
    return MarkerTasks(markers, coordinates, followed)


def tasks_file(path: str | PathLike[str]) -> Path:
    """The file that holds the tasks: the one given, or the one that its task set names, from the folder it is in."""
    file = Path(fspath(path))
    passed = {realpath(file)}
    while named := next(
        (e.get("file", "").strip() for e in read_document(file).iter("IKTaskSet") if e.get("file")), ""
    ):
        further = file.parent / named.replace("\\", "/")
        if not further.is_file():
            what = f"names '{named[:80]}', which is not there"
            raise InputError(file, "<IKTaskSet file=…>", what, "put that file there, or give it instead of this one")
        if realpath(further) in passed:
            raise InputError(
                file, "<IKTaskSet file=…>", f"leads back to '{named[:80]}'", "give the file with the tasks"
            )
        passed.add(realpath(further))
        file = further
    return file


def _weight(file: str, task: Element) -> float:
    if task.find("apply") is not None and not is_true(file, task, "apply"):
        return 0.0
    weight = float(numbers_of(file, task, "weight", 1, (0.0,))[0])
    if weight < 0.0:
        raise InputError(file, f"{label(task)} <weight>", f"{weight:g} is negative", "weights are 0 or more")
    return weight


def _wanted(file: str, task: Element, kind: str) -> float | None:
    if kind == "default_value":
        return None
    if kind == "manual_value":
        return float(numbers_of(file, task, "value", 1)[0])
    what = f"'{kind[:40]}' is not supported"
    raise InputError(file, f"{label(task)} <value_type>", what, f"default_value, manual_value or {FROM_FILE}")
