"""OpenSim models beside OpenSim: `python -m benchmarks.dynamics.opensim_models [FOLDER ...]`.

Every .osim file below the folders (the project's own meshes, a synthetic whole body and the real data unless named) is
read by both. At random
states within the coordinates' ranges: places and turns of all bodies, generalised forces; the model scaled by factors
of its own for each body, with another mass; inverse kinematics of its virtual markers with noise, angles and frames per
CPU second of one core. OpenSim rounds numbers of files of version 3 to six digits when it reads them: such files are
compared as they are, and once more as OpenSim writes them again (`rewritten`). Where the third turn of a joint
depends on a coordinate of the others, OpenSim's forces by velocity are not those of its mass matrix: `lagrange` has
how far both are off Lagrange's equations. Models with ball, free or scapulothoracic joints are compared at rest, and
without the forces of those joints: their speeds are angular velocities in OpenSim and rates of the coordinates here. A
model that is refused here stands in the table with the line that says why. Motions are synthetic, models are as found.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.dynamics.full_body import write_full_body
from benchmarks.dynamics.opensim_states import closed, lagrange, states
from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
STATES, FRAMES, RATE, NOISE, SEED = 8, 180, 60.0, 2e-3, 3636
"""Random states; frames of the virtual trial, its rate [Hz], noise of its markers [m]."""
SOFT = 20.0
"""Weight of constraints where OpenSim does not converge with exact ones."""
FEWEST = 8
"""Markers of a model that inverse kinematics is tried with."""
LAGRANGE = 1e-5
"""Difference of forces, of range, above which Lagrange's equations are asked."""


def main() -> None:
    """Measure, print the table, write the JSON."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.dynamics.opensim_models", description=__doc__.splitlines()[0]
    )
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    parser.add_argument("--name", default="opensim_models", help="of the JSON, without ending")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import stamp
    from tests.elsewhere import another_process

    rows = []
    with tempfile.TemporaryDirectory() as place:
        for name, file in _models(options.folders, Path(place)):
            with another_process() as call:  # of each model: OpenSim may end it
                rows.append({"model": name, **compared(file, call)})
            print(_line(rows[-1]), flush=True)
    if not rows:
        parser.error("no .osim file in these folders")
    report = {
        **stamp({"casadi", "numpy", "scipy", "opensim"}),
        "seed": SEED,
        "models": rows,
    }
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / f"{options.name}.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")


def _models(folders: list[Path], scratch: Path) -> Iterator[tuple[str, Path]]:
    if not folders:
        yield "benchmarks/full_body (synthetic)", write_full_body(scratch / "full_body.osim")
    data = Path(os.environ.get("GEOCONTACT_DATA", HERE.parent.parent / "shared" / "data"))
    for folder in folders or [HERE.parent / "meshes", data]:
        for file in sorted(folder.rglob("*.osim")):
            yield file.relative_to(folder.parent).as_posix(), file


def compared(file: Path, call: Any) -> dict[str, Any]:
    """Differences to OpenSim, or why there are none."""
    import numpy as np

    from geocontact.data.errors import InputError
    from geocontact.dynamics.tree import tree_of
    from geocontact.io.opensim.osim_multibody import read_multibody

    try:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            tree = tree_of(read_multibody(file))
    except InputError as error:
        return {"refused": str(error).replace(str(file), file.name)}
    found: dict[str, Any] = {
        "bodies": len(tree.model.bodies),
        "coordinates": len(tree.names),
        "markers": len(tree.model.markers),
        "warnings": sorted({str(each.message).replace(str(file), file.name) for each in said}),
    }
    rng = np.random.default_rng(SEED)
    try:
        found |= _at_states(file, tree, call, rng)
        if len(tree.model.markers) >= FEWEST:
            found |= _markers(file, tree, call, rng)
        if _is_old(file):
            found |= {"rewritten": _rewritten(file, call)}
    except (
        RuntimeError,
        ValueError,
        IndexError,
        KeyError,
    ) as error:  # of either program; a process that ended, too: it belongs into the table
        found["failed"] = " ".join(f"{type(error).__name__}: {error}".split())[:200].replace(str(file), file.name)
    return found


def _at_states(file: Path, tree: Any, call: Any, rng: Any) -> dict[str, Any]:
    found = _kinematics(file, tree, call, states(tree.model, rng, STATES))
    found |= _dynamics(file, tree, call, states(tree.model, rng, STATES), rng)
    return found | _scaling(file, tree.model, call, rng)


def _is_old(file: Path) -> bool:
    from geocontact.io.opensim.osim_xml import read_document

    return read_document(file).get("Version", "0") < "40000"


def _rewritten(file: Path, call: Any) -> dict[str, Any]:
    """The same comparison of the file that OpenSim writes again."""
    import numpy as np

    from geocontact.dynamics.tree import tree_of
    from geocontact.io.opensim.osim_multibody import read_multibody
    from tests import opensim_oracle

    with tempfile.TemporaryDirectory() as place, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        again = Path(place) / file.name
        call(opensim_oracle.converted, file, again)
        found = _at_states(again, tree_of(read_multibody(again)), call, np.random.default_rng(SEED))
    return {key: found[key] for key in ("bodies_apart_mm", "forces_off_share", "scaled_off")}


def _kinematics(file: Path, tree: Any, call: Any, q: Any) -> dict[str, Any]:
    import numpy as np
    from scipy.spatial.transform import Rotation

    from tests import opensim_oracle

    names = [body.name for body in tree.model.bodies if body.mass > 0.0]
    theirs = call(opensim_oracle.poses, file, tree.names, q, [(name, "ground") for name in names])
    ours = tree.model.poses(q)
    apart = max(np.linalg.norm(ours[n].translation - theirs[:, k, :3, 3], axis=1).max() for k, n in enumerate(names))
    turns = max(
        (ours[n].rotation.inv() * Rotation.from_matrix(theirs[:, k, :3, :3])).magnitude().max()
        for k, n in enumerate(names)
    )
    return {"bodies_apart_mm": 1e3 * float(apart), "bodies_turned_deg": float(np.degrees(turns))}


def _dynamics(file: Path, tree: Any, call: Any, q: Any, rng: Any) -> dict[str, Any]:
    """Largest difference of a coordinate's force over the range of that force, and which coordinates are beyond 1 %."""
    import casadi
    import numpy as np

    from geocontact.dynamics.inverse_dynamics import generalised_forces
    from tests import opensim_oracle

    turning = _turning(file)
    moving = np.array([not c.locked for c in tree.model.coordinates]) & (not turning)
    u, a = (np.where(moving, rng.normal(size=q.shape), 0.0) for _ in range(2))
    run = casadi.Function("id", [tree.q, tree.u, tree.a], [generalised_forces(tree)]).map(len(q))
    ours = np.array(run(q.T, u.T, a.T)).T
    theirs = call(opensim_oracle.inverse_dynamics, file, tree.names, q, u, a)
    off = np.abs(ours - theirs).max(axis=0) / np.maximum(np.ptp(theirs, axis=0), 1e-3 * np.abs(theirs).max())
    shares = {name: float(share) for name, share in zip(tree.names, off, strict=True) if name not in turning}
    found = {"lagrange": lagrange(file, tree, call, q, u)} if max(shares.values()) > LAGRANGE and not turning else {}
    return found | {
        "forces_at_rest": bool(turning),
        "forces_off_share": max(shares.values()),
        "forces_beyond_1_percent": [name for name, share in shares.items() if share > 0.01],
        "forces_not_compared": sorted(turning),
    }


def _turning(file: Path) -> set[str]:
    """Coordinates of joints whose speeds are angular velocities in OpenSim, and rates of the coordinates here."""
    from geocontact.io.opensim.osim_xml import read_model

    kinds = {"BallJoint", "FreeJoint", "ScapulothoracicJoint"}
    joints = [element for element in read_model(file).iter() if element.tag in kinds]
    return {each.get("name", "") for joint in joints for each in joint.iter("Coordinate")}


def _scaling(file: Path, model: Any, call: Any, rng: Any) -> dict[str, Any]:
    """One factor a body, another mass."""
    import numpy as np

    from geocontact.dynamics.scaling import scaled
    from geocontact.io.opensim.osim_multibody import read_multibody
    from tests import opensim_oracle

    total = sum(body.mass for body in model.bodies)
    by = {b.name: rng.uniform(0.9, 1.15) * np.ones(3) for b in model.bodies if b.mass > 0.0}
    mass = 1.1 * total
    with tempfile.TemporaryDirectory() as place:
        out = Path(place) / "theirs.osim"
        call(opensim_oracle.scaled, file, out, {name: tuple(each) for name, each in by.items()}, mass)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            theirs = read_multibody(out)
    ours = scaled(model, by, mass)
    known = {body.name: body for body in theirs.bodies}
    off = [0.0]
    for body in ours.bodies:
        if body.mass > 0.0:
            other = known[body.name]
            off.append(abs(body.mass - other.mass) / other.mass)
            size = max(float(np.abs(other.inertia).max()), 1e-12)
            off.append(float(np.abs(body.inertia - other.inertia).max()) / size)
            off.append(float(np.abs(body.centre - other.centre).max()))
    joints = {joint.child: joint for joint in theirs.joints}
    for joint in ours.joints:
        if joint.child in joints:
            for side in ("parent_offset", "child_offset"):
                one, two = (getattr(each, side).translation for each in (joint, joints[joint.child]))
                off.append(float(np.abs(one - two).max()))
    places = {m.name: m.location for m in theirs.markers}
    off += [float(np.abs(m.location - places[m.name]).max()) for m in ours.markers if m.name in places]
    return {"scaled_off": max(off)}


def _markers(file: Path, tree: Any, call: Any, rng: Any) -> dict[str, Any]:
    """Inverse kinematics of a smooth motion with noise of the markers, from the same file."""
    import numpy as np

    from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
    from geocontact.dynamics.inverse_kinematics import inverse_kinematics
    from geocontact.io.mocap.trc import read_trc, write_trc

    one, two = states(tree.model, rng, 2)
    phase = 0.5 - 0.5 * np.cos(np.linspace(0.0, 2.0 * np.pi, FRAMES))[:, None]
    values = closed(tree.model, tree.model.coupled(one + phase * (two - one)))
    names = tuple(m.name for m in tree.model.markers)
    places = tree.model.marker_places(values) + NOISE * rng.normal(size=(FRAMES, len(names), 3))
    tasks = MarkerTasks(dict.fromkeys(names, 1.0))
    with tempfile.TemporaryDirectory() as place:
        trial = Path(place) / "trial.trc"
        write_trc(trial, MarkerTrajectories(np.arange(FRAMES) / RATE, places, names))
        seen = read_trc(trial)
        inverse_kinematics(tree, seen.between(0.0, 0.05), tasks)
        began = time.process_time()
        found = inverse_kinematics(tree, seen, tasks)
        ours = time.process_time() - began
        asked = file, trial, dict(tasks.markers), {}, list(seen.time[:-1]), list(tree.names)
        weight, theirs, angles = _solved(call, asked)
    told = found.determined.all(axis=0)
    turned = told & np.array([c.kind == "rotational" for c in tree.model.coordinates])
    off = np.degrees(np.abs(found.values[:-1] - angles)[:, turned]).max(axis=0, initial=0.0)
    rms = [_rms_mm(tree.model, values, seen.positions[:-1]) for values in (found.values[:-1], angles)]
    return {
        "marker_rms_mm": rms[0],
        "opensim_marker_rms_mm": rms[1],
        "opensim_constraint_weight": weight,
        "angles_off_deg": float(off.max(initial=0.0)),
        "angles_beyond_0.1_deg": [n for n, each in zip(np.array(tree.names)[turned], off, strict=True) if each > 0.1],
        "not_determined": [name for name, each in zip(tree.names, told, strict=True) if not each],
        "frames_per_second": FRAMES / ours,
        "opensim_frames_per_second": FRAMES / theirs,
        "steps_a_frame": float(found.steps.mean()),
    }


def _solved(call: Any, asked: tuple[Any, ...]) -> tuple[float | str, float, Any]:
    """OpenSim's answer to 1e-9: weight of constraints, CPU seconds, coordinates.

    Where it finds none with exact constraints, their weight is the 20 of many published set-ups.
    """
    from tests import opensim_oracle

    try:
        return "exact", *call(opensim_oracle.inverse_kinematics, *asked, 1e-9)
    except RuntimeError:
        return SOFT, *call(opensim_oracle.inverse_kinematics, *asked, 1e-9, SOFT)


def _rms_mm(model: Any, values: Any, places: Any) -> float:
    """Of the distances of markers from where they were seen."""
    import numpy as np

    off = model.marker_places(model.coupled(values)) - places
    return 1e3 * float(np.sqrt(np.mean(np.sum(off**2, axis=2))))


def _line(row: dict[str, Any]) -> str:
    if "refused" in row:
        return f"{row['model']}: refused: {row['refused']}"
    keys = ("bodies_apart_mm", "bodies_turned_deg", "forces_off_share", "scaled_off",
            "angles_off_deg", "frames_per_second", "opensim_frames_per_second")  # fmt: skip
    told = ", ".join(f"{key} {row[key]:.3g}" for key in keys if key in row)
    return f"{row['model']}: {row['coordinates']} coordinates: {told}{'; ' + row['failed'] if 'failed' in row else ''}"


if __name__ == "__main__":
    main()
