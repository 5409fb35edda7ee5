"""OpenSim's set-up files run by its tools and by the commands: `python -m benchmarks.dynamics.opensim_setups FOLDER`.

The folder holds models and set-ups of the packages that docs/how-to/inverse.md names; nothing is fetched, nothing
of them kept. Each of Pose2Sim's set-ups of scaling and inverse kinematics is run as it is but for the names of files,
which Pose2Sim sets, too: its own markers on its own model, a static trial and a motion of the scaled model. Set-ups of
inverse dynamics are written here, with one external force. Trials are synthetic, with noise of the markers.
CPU seconds are those of whole processes, start-up included.

The sum of squares of either answer is that which OpenSim states for its set-up; the motion that markers were made of is
known, and what both are off from it is told, for coordinates that markers determine.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

from benchmarks.dynamics.opensim_models import NOISE, RATE, SEED
from benchmarks.dynamics.opensim_states import states
from benchmarks.one_core import THREADS

HERE = Path(__file__).resolve().parents[1]
FRAMES = 101
LARGER = 1.06
"""Factor of the synthetic subject."""
MODEL, WHOLE = "Model_Pose2Sim_simple.osim", "Model_Pose2Sim_muscles_flex.osim"
DYNAMICS = {"Rajagopal2015.osim": "calcn_r", "gait9dof18musc_20170320.osim": "calcn_r", MODEL: "calcn_r"}
"""And the body that a force acts on."""
ID = """<OpenSimDocument Version="40000"><InverseDynamicsTool name="id"><results_directory>.</results_directory>
<model_file>{model}</model_file><time_range>0 1.5</time_range><forces_to_exclude>{exclude}</forces_to_exclude>
<external_loads_file>loads.xml</external_loads_file><coordinates_file>motion.mot</coordinates_file>
<lowpass_cutoff_frequency_for_coordinates>6</lowpass_cutoff_frequency_for_coordinates>
<output_gen_force_file>theirs.sto</output_gen_force_file></InverseDynamicsTool></OpenSimDocument>"""
TOOLS = {"scale": "ScaleTool", "ik": "InverseKinematicsTool", "id": "InverseDynamicsTool"}
Row = dict[str, Any]


def main() -> None:
    """Run all set-ups, print a line of each, write the JSON after each."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.dynamics.opensim_setups", description=__doc__.splitlines()[0]
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    parser.add_argument(
        "--kinds", nargs="*", help="markers of Pose2Sim, as its set-ups call them; all of them unless told"
    )
    options = parser.parse_args()
    os.environ.update(dict.fromkeys(THREADS, "1"))
    from benchmarks.machine import stamp

    options.out.mkdir(parents=True, exist_ok=True)
    report: dict[str, Any] = {
        **stamp({"casadi", "numpy", "scipy", "opensim"}), "seed": SEED,
        "set-ups": [],
    }  # fmt: skip
    for told in _all(options.folder.resolve(), options.kinds):
        report["set-ups"].append(told)
        print(json.dumps({key: each for key, each in told.items() if not isinstance(each, dict)}), flush=True)
        (options.out / "opensim_setups.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")


def _all(folder: Path, kinds: list[str] | None) -> Any:
    with tempfile.TemporaryDirectory() as scratch:
        for k, setup in enumerate(sorted(folder.rglob("Scaling_Setup_Pose2Sim_*.xml"))):
            kind = setup.stem.removeprefix("Scaling_Setup_Pose2Sim_")
            if kinds is not None and kind not in kinds:
                continue
            for model in (MODEL, WHOLE) if kind == "Halpe26" else (MODEL,):
                place = Path(scratch) / f"{k}{model[:16]}"
                place.mkdir()
                yield {"set-up": setup.name, "model": model, **_scaling(setup, _one(folder, model), kind, place)}
                for other in sorted(folder.rglob(f"IK_Setup_Pose2Sim_*{kind}.xml")):
                    if other.stem.endswith(f"_{kind}") and (place / "theirs.osim").is_file():
                        yield {"set-up": other.name, "model": model, **_kinematics(other, place)}
        for name, body in DYNAMICS.items():
            for exclude in ("Muscles", "ALL"):
                place = Path(scratch) / f"{name}{exclude}"
                place.mkdir()
                yield {"set-up": f"written here, excludes {exclude}", "model": name,
                       **_dynamics(_one(folder, name), body, exclude, place)}  # fmt: skip


def _one(folder: Path, name: str) -> Path:
    return next(iter(sorted(folder.rglob(name))))


def _scaling(setup: Path, model: Path, kind: str, place: Path) -> Row:
    """Markers of the kind on the model, a subject larger by one factor who stands."""
    import numpy as np

    from geocontact.data.multibody.markers import MarkerTrajectories
    from geocontact.dynamics.scaling import scaled
    from geocontact.io.mocap.trc import write_trc
    from geocontact.io.opensim.osim_multibody import read_marker_set

    sets = [each for each in setup.parent.rglob("Markers_*.xml") if each.stem.lower() == f"markers_{kind.lower()}"]
    if not sets:
        return {"not run": f"there is no Markers_{kind}.xml"}
    generic = replace(_model(model), markers=read_marker_set(sets[0], model))
    rng = np.random.default_rng(SEED)
    subject = scaled(generic, {body.name: LARGER * np.ones(3) for body in generic.bodies})
    values = np.tile([c.default for c in generic.coordinates], (FRAMES, 1))
    places = subject.marker_places(subject.coupled(values))
    places = places + NOISE * rng.normal(size=places.shape)
    write_trc(place / "static.trc", MarkerTrajectories(np.arange(FRAMES) / RATE, places, _names(subject)))
    _exact_times(place / "static.trc")
    named = {"model_file": str(model), "marker_set_file": str(sets[0]), "marker_file": "static.trc"}
    _renamed(setup, place / "scale.xml", {**named, "output_model_file": "theirs.osim"})
    told = _both("scale", place)
    if "refused" in told:
        return told
    return told | _models_apart(place / "ours_scale" / "scaled.osim", place / "theirs.osim")


def _kinematics(setup: Path, place: Path) -> Row:
    """A smooth motion of the model that OpenSim scaled."""
    import numpy as np

    from geocontact.data.multibody.markers import MarkerTrajectories
    from geocontact.io.mocap.trc import write_trc

    model = _model(place / "theirs.osim")
    rng = np.random.default_rng(SEED)
    truth = _motion(model, rng)
    places = model.marker_places(truth)
    places = places + NOISE * rng.normal(size=places.shape)
    write_trc(place / "walk.trc", MarkerTrajectories(np.arange(FRAMES) / RATE, places, _names(model)))
    _exact_times(place / "walk.trc")
    named = {"model_file": "theirs.osim", "marker_file": "walk.trc", "output_motion_file": "theirs.mot"}
    _renamed(setup, place / "ik.xml", {**named, "results_directory": "."})
    told = _both("ik", place)
    return told if "refused" in told else told | _angles(place, model, truth)


def _dynamics(model: Path, body: str, exclude: str, place: Path) -> Row:
    """A smooth motion, and a force on a foot as of a step [N, m]."""
    import numpy as np

    from geocontact.io.opensim.external_loads import write_external_loads
    from geocontact.io.opensim.storage_writer import write_storage

    read = _model(model)
    values = _motion(read, np.random.default_rng(SEED))
    turns = np.array([c.kind == "rotational" for c in read.coordinates])
    time_ = np.arange(FRAMES) / RATE
    names = [c.name for c in read.coordinates]
    write_storage(place / "motion.mot", time_, names, np.where(turns, np.degrees(values), values),
                  title="Coordinates", degrees=True)  # fmt: skip
    step = np.sin(np.pi * time_ / time_[-1])[:, None]
    zero = 0.0 * step
    columns = np.hstack([60.0 * step, 700.0 * step, -30.0 * step, 0.1 * step, zero, 0.05 + zero])
    heads = [f"right_force_{each}" for each in ("vx", "vy", "vz", "px", "py", "pz")]
    write_storage(place / "loads.mot", time_, heads, columns, title="Forces", degrees=False)
    write_external_loads(place / "loads.xml", "loads.mot", {"right_force": body})
    (place / "id.xml").write_text(ID.format(model=model, exclude=exclude), encoding="utf-8")
    told = _both("id", place)
    return told if "refused" in told else told | _forces(place / "ours_id" / "id.sto", place / "theirs.sto")


def _model(file: Path) -> Any:
    from geocontact.io.opensim.osim_multibody import read_multibody

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return read_multibody(file)


def _names(model: Any) -> tuple[str, ...]:
    return tuple(marker.name for marker in model.markers)


def _motion(model: Any, rng: Any) -> Any:
    import numpy as np

    one, two = states(model, rng, 2)
    phase = 0.5 - 0.5 * np.cos(np.linspace(0.0, 2.0 * np.pi, FRAMES))[:, None]
    return model.coupled(one + phase * (two - one))


def _renamed(setup: Path, target: Path, files: dict[str, str]) -> None:
    """The same set-up with other files."""
    from defusedxml.ElementTree import parse

    tree = parse(setup)
    for name, text in files.items():
        for element in tree.iter(name):
            element.text = text
    tree.write(target, encoding="utf-8", xml_declaration=True)


def _exact_times(trial: Path) -> None:
    """All digits, as Pose2Sim writes them: its set-ups end at a frame."""
    head, rows = (lines := trial.read_text(encoding="utf-8").splitlines())[:-FRAMES], lines[-FRAMES:]
    cells = [row.split("\t") for row in rows]
    whole = ["\t".join([row[0], repr(k / RATE), *row[2:]]) for k, row in enumerate(cells)]
    trial.write_text("\n".join([*head, *whole]) + "\n", encoding="utf-8")


def _both(tool: str, place: Path) -> Row:
    """CPU and wall seconds of both; what ours says where it refuses."""
    here = HERE.parent
    tell = f"import opensim; opensim.Logger.setLevelString('Off'); opensim.{TOOLS[tool]}('{tool}.xml').run()"
    theirs = _timed([sys.executable, "-c", tell], place)
    call = [sys.executable, str(here / "cli.py"), tool, "--setup", f"{tool}.xml", "--out", f"ours_{tool}"]
    ours = _timed(call, place)
    if ours["code"] or theirs["code"]:
        return {"refused": ours["error"] or "no", "opensim": theirs["error"] or "runs"}
    run = json.loads((place / f"ours_{tool}" / "run.json").read_text(encoding="utf-8"))
    words = "of kinds that are not read do not act here, in OpenSim they do: "
    unread = [w.partition(words)[2] for w in run["warnings"] if words in w]
    told = {"forces_not_read": unread[0]} if unread else {}
    return told | {
        "cpu_s": ours["cpu_s"], "opensim_cpu_s": theirs["cpu_s"],
        "wall_s": ours["wall_s"], "opensim_wall_s": theirs["wall_s"],
    }  # fmt: skip


def _timed(call: list[str], place: Path) -> Row:
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    environment = os.environ | {"PYTHONPATH": str(HERE.parent)}
    run = subprocess.run(call, cwd=place, capture_output=True, text=True, env=environment, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    last = (run.stderr.strip().splitlines() or [""])[-1] if run.returncode else ""
    return {"cpu_s": spent, "wall_s": time.perf_counter() - began, "code": run.returncode, "error": last[:300]}


def _models_apart(ours: Path, theirs: Path) -> Row:
    """Largest relative difference of masses and places [m]; of moments of inertia, which are those of a cylinder in
    OpenSim where a body's factors differ; of markers [mm].
    """
    import numpy as np

    one, two = _model(ours), _model(theirs)
    known, joints = {b.name: b for b in two.bodies}, {j.child: j for j in two.joints}
    off, inertias = [0.0], [0.0]
    for body in one.bodies:
        other = known[body.name]
        off.append(abs(body.mass - other.mass) / max(other.mass, 1e-9))
        inertias.append(
            float(np.abs(body.inertia - other.inertia).max()) / max(float(np.abs(other.inertia).max()), 1e-12)
        )
        off.append(float(np.abs(body.centre - other.centre).max()))
    for joint in one.joints:
        for side in ("parent_offset", "child_offset"):
            pair = (getattr(each, side).translation for each in (joint, joints[joint.child]))
            off.append(float(np.abs(np.subtract(*pair)).max()))
    places = {m.name: m.location for m in two.markers}
    apart = [float(np.linalg.norm(m.location - places[m.name])) for m in one.markers]
    defaults = np.abs(np.subtract(*([c.default for c in model.coordinates] for model in (one, two)))).max()
    return {
        "scaled_off": max(off),
        "inertia_off": max(inertias),
        "default_pose_off": float(defaults),
        "markers": len(apart),
        "markers_apart_mm": 1e3 * max(apart),
    }


def _angles(place: Path, model: Any, truth: Any) -> Row:
    """Two motions from one set-up: their differences, the sums of squares, and what each is off from the truth."""
    import numpy as np

    from geocontact.io.mocap.trc import read_trc
    from geocontact.io.opensim.marker_weights import read_marker_weights
    from geocontact.io.text.tables import read_table

    one, two = (read_table(place / name) for name in ("ours_ik/ik.mot", "theirs.mot"))
    seen, tasks = read_trc(place / "walk.trc"), read_marker_weights(place / "ik.xml")
    frames = np.abs(seen.time[:, None] - two.time).argmin(axis=0)
    answers = [_values(table, model) for table in (one, two)]
    squares = [_squares(model, tasks, seen, frames, values) for values in answers]
    run = json.loads((place / "ours_ik" / "run.json").read_text(encoding="utf-8"))
    held = next((w for w in run["warnings"] if w.startswith("no frame determines")), "")
    known = np.array([c.kind == "rotational" and c.name not in held for c in model.coordinates])
    names = np.array([c.name for c in model.coordinates])[known]
    ours, theirs, true = (np.degrees(each[:, known]) for each in (*answers, truth[frames]))
    off = np.abs(ours - theirs).max(axis=0)
    return {
        "frames": len(two.time),
        "columns_missing": sorted(set(two.channels) - set(one.channels)),
        "times_off_s": float(np.abs(one.time - two.time).max()),
        "held": held.removeprefix("no frame determines ").partition(":")[0],
        "angles_off_deg": float(off.max()),
        "angles_beyond_0.1_deg": {str(n): float(each) for n, each in zip(names, off, strict=True) if each > 0.1},
        "frames_with_larger_sum": int((squares[0] > squares[1] * (1.0 + 1e-6)).sum()),
        "sum_over_opensims": float(squares[0].mean() / squares[1].mean()),
        "off_truth_rms_deg": float(np.sqrt(np.mean((ours - true) ** 2))),
        "opensim_off_truth_rms_deg": float(np.sqrt(np.mean((theirs - true) ** 2))),
    }


def _values(table: Any, model: Any) -> Any:
    """Coordinates in rad and m."""
    import numpy as np

    turned = [c.kind == "rotational" for c in model.coordinates]
    columns = np.array([table.column(c.name) for c in model.coordinates]).T
    return np.where(turned, np.radians(columns), columns)


def _squares(model: Any, tasks: Any, seen: Any, frames: Any, values: Any) -> Any:
    """Weighted mean square of the markers' distances and of coordinates from where they are wanted, by frame."""
    import numpy as np

    names = [m.name for m in model.markers if tasks.markers.get(m.name, 0.0) > 0.0 and m.name in seen.names]
    weights = np.array([tasks.markers[name] for name in names])
    all_of_them = model.marker_places(model.coupled(values))
    at = [[m.name for m in model.markers].index(name) for name in names]
    apart = np.sum((all_of_them[:, at] - seen.of(tuple(names))[frames]) ** 2, axis=2)
    found = apart @ weights / weights.sum()
    for k, coordinate in enumerate(model.coordinates):
        weight, wanted = tasks.coordinates.get(coordinate.name, (0.0, None))
        found = found + weight * (values[:, k] - (coordinate.default if wanted is None else wanted)) ** 2
    return found


def _forces(ours: Path, theirs: Path) -> Row:
    """Largest difference of a column over its range, without the ends, where filters start differently."""
    import numpy as np

    from geocontact.io.text.tables import read_table

    one, two = read_table(ours), read_table(theirs)
    inner = slice(10, -10)
    largest = max(float(np.abs(two.column(name)).max()) for name in two.channels)
    off = {}
    for name in two.channels:
        apart = np.abs(one.column(name) - two.column(name))[inner].max()
        off[name] = float(apart / max(np.ptp(two.column(name)), 1e-3 * largest))
    return {
        "frames": len(two.time),
        "columns_missing": sorted(set(two.channels) - set(one.channels)),
        "columns_in_order": list(two.channels) == list(one.channels),
        "times_off_s": float(np.abs(one.time - two.time).max()),
        "forces_off_share": max(off.values()),
        "forces_beyond_1_percent": {name: each for name, each in off.items() if each > 0.01},
    }


if __name__ == "__main__":
    main()
