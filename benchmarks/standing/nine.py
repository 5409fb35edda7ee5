"""The study of the paper, synthetic, beside the paper's tables: `python -m benchmarks.standing.nine OUT`.

Nine trials of a finer simulation (`benchmarks.standing.nine_truth`) recorded as a laboratory would
(`benchmarks.standing.session`), then the commands: inverse kinematics, inverse dynamics of the rigidly coupled chain,
both mats, phases A and B on the three passive trials, C1 on the six assisted ones, and C2 with the strap's stiffnesses
times 1.4. Parts: pipelines, cal, C1, C2; those that are there are kept. Everything is synthetic. Seed 34.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
MESHES = HERE.parent / "meshes"
SEED = 34
PASSIVE, HELD_OUT = ("T1", "T2", "T3"), ("P1", "P2", "P3", "P4", "P5", "P6")
PERTURBED, SPRINGS = 1.4, ("strap normal", "strap tangential", "strap turning")
LONGEST = 40.0
"""CPU time of a search [s]."""
TOLD = {"length": (3.0, "mm"), "angle": (1.0, "deg"), "rate": (0.1, "rad/s"), "force": (2.0, "N"),
        "centre": (1.0, "mm"), "torque": (5.0, "N m"), "strap": (1.0, "N")}  # fmt: skip
"""What the study is told of one sample's noise."""
ANGLES = ("ankle", "knee", "hip", "exo_ankle", "exo_knee", "exo_hip")


def main() -> None:
    """Make what is not there yet, run, compare, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.standing.nine", description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("parts", nargs="*", default=["pipelines", "cal", "C1", "C2"], metavar="PART")
    parser.add_argument("--nodes", type=float, default=30.0)
    options = parser.parse_args()
    pin()
    import geocontact as gc
    from benchmarks.machine import stamp

    warnings.simplefilter("ignore", gc.InputWarning)
    out: Path = options.out
    out.mkdir(parents=True, exist_ok=True)
    file = HERE / "results" / "standing_nine.json"
    report: dict[str, Any] = json.loads(file.read_text("utf-8")) if file.is_file() else {"cpu seconds": {}}
    report["seed"] = SEED
    for part in options.parts:
        began, made_by = time.process_time(), stamp({"casadi", "numpy", "scipy"})

        def keep(told: dict[str, Any], part: str = part, made_by: dict[str, Any] = made_by) -> None:
            report[part] = told | made_by
            file.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")

        if part == "pipelines":
            keep(pipelines(out))
        elif part == "cal":
            calibrate(out, options.nodes)
            keep(written(out / "cal"))
        else:
            keep(predict(out, options.nodes, {"C1": 1.0, "C2": PERTURBED}[part], keep))
        report["cpu seconds"][part] = time.process_time() - began
        keep(report[part])
    print(json.dumps(report, indent=2))


def pipelines(out: Path) -> dict[str, Any]:
    """From the laboratory's files to those of a study; how far each is from the truth, over the trials."""
    import numpy as np

    from benchmarks.standing.nine_truth import write_truth
    from benchmarks.standing.session import session_of, write_session
    from geocontact.standing_up.chain import Subject

    subject = Subject()
    if not (out / "truth.npz").is_file():
        write_truth(out / "truth.npz", subject)
    with np.load(out / "truth.npz") as file:
        truth = {key: file[key] for key in file.files}
    residuals = np.array([truth[key] for key in truth if key.endswith(" residual")])
    session = session_of(truth)
    if not (out / "front").is_dir():
        write_session(out, session, subject, SEED)
    used = np.zeros(len(session.time), bool)
    for begin, end in session.spans.values():
        used |= (session.time > begin - 1e-9) & (session.time < end + 1e-9)

    def off(of: np.ndarray, what: np.ndarray) -> list[float]:
        return np.sqrt(np.mean((of - what)[used] ** 2, axis=0)).tolist()

    q = kinematics(out, session.time)
    torque = torques(out, subject, q, session.time)
    strap = straps(out, session.time)
    write_studies(out, session.spans)
    true = session.channels
    return {
        "largest residual of the truth [N, N m]": residuals.max(axis=0).tolist(),
        "certified motions of the truth": int(sum(truth[key] for key in truth if key.endswith(" certified"))),
        "angles, ankle knee hip [deg]": np.degrees(off(q[:, 3:6], true["q"][:, 3:6])).tolist(),
        "foot [mm, mm, deg]": [
            *(1e3 * np.array(off(q[:, :2], true["q"][:, :2]))),
            np.degrees(off(q, true["q"][:, :9])[2]),
        ],
        "torques of person and exoskeleton [N m]": off(torque, true["torque"]),
        "strap by the mats [N]": off(strap[:, None], true["strap"])[0],
        "one SD over the trials": spread(truth),
    }


def spread(truth: Mapping[str, Any]) -> dict[str, float]:
    """Largest standard deviation over the six assisted trials, over parts of the movement, as in the paper."""
    import numpy as np

    part, found = np.linspace(0.0, 1.0, 101), {}
    factors = {"q": 180.0 / np.pi, "u": 180.0 / np.pi, "force": 1.0, "centre": 1e3, "torque": 1.0, "strap": 1.0}
    for what, factor in factors.items():
        rows = []
        for name in HELD_OUT:
            own = truth[f"{name} {what}"].reshape(len(truth[f"{name} time"]), -1)
            own = own[:, 3:9] if what in ("q", "u") else own
            rows.append([np.interp(part, np.linspace(0.0, 1.0, len(own)), column) for column in own.T])
        found[what] = factor * float(np.std(rows, axis=0, ddof=1).max())
    return found


def kinematics(out: Path, clock: Any) -> Any:
    """Nine coordinates [m, rad]: six by inverse kinematics, the exoskeleton's by encoders; coordinates.sto."""
    import numpy as np

    import geocontact as gc
    from geocontact.io.opensim.storage_writer import write_storage
    from geocontact.io.text.tables import read_table
    from geocontact.standing_up.chain import COORDINATES
    from geocontact.standing_up.exoskeleton import EXO_JOINTS

    found = gc.inverse_kinematics(out / "markers.trc", model=out / "model.osim").poses
    own = np.column_stack([found.values[:, found.names.index(name)] for name in COORDINATES])
    table = read_table(out / "encoders.sto")
    worn = np.radians(np.column_stack([table.needed(name) for name in EXO_JOINTS]))
    q = np.hstack([own, worn])
    names = (*COORDINATES, *EXO_JOINTS)
    shown = np.hstack([q[:, :2], np.degrees(q[:, 2:])])
    write_storage(out / "coordinates.sto", clock, names, shown, title="synthetic", degrees=True)
    return q


def torques(out: Path, subject: Any, q: Any, clock: Any, plate: tuple[str, ...] = ("feet_force=foot",)) -> Any:
    """Of person and exoskeleton [N m]: inverse dynamics of both less the motors' torque less friction; torques.sto."""
    import numpy as np
    from scipy.signal import butter, filtfilt

    import geocontact as gc
    from geocontact.io.opensim.storage_writer import write_storage
    from geocontact.io.text.tables import read_table
    from geocontact.standing_up.exoskeleton import EXO_JOINTS
    from geocontact.standing_up.exoskeleton_torque import human_torque

    device = unloaded(subject)
    table = read_table(out / "motors.sto")
    motors = np.column_stack([table.needed(name) for name in EXO_JOINTS])
    low = butter(2, 6.0 / (0.5 / (clock[1] - clock[0])))
    rates = np.gradient(filtfilt(*low, q[:, 6:], axis=0), clock, axis=0)
    worn = device.torque(filtfilt(*low, motors, axis=0), rates)
    forces = gc.inverse_dynamics(
        out / "coordinates.sto", model=out / "model.osim", plates=out / "plates.mot", plate=plate
    ).table("forces")
    both = np.column_stack([forces[f"{name}_moment [N m]"] for name in ("ankle", "knee", "hip")])
    both = np.column_stack([np.interp(clock, forces["time [s]"], column) for column in both.T])
    found = np.hstack([human_torque(both, worn), worn])
    names = ("ankle", "knee", "hip", *EXO_JOINTS)
    write_storage(out / "torques.sto", clock, names, found, title="synthetic", degrees=False)
    return found


def unloaded(subject: Any) -> Any:
    """The exoskeleton's dynamic parameters from half a minute in which it moves by itself."""
    import numpy as np

    from benchmarks.standing.nine_truth import unloaded_motors
    from benchmarks.standing.session import NOISES
    from geocontact.standing_up.exoskeleton_torque import identified

    q, u, a, motors = unloaded_motors(subject)
    noise = NOISES["motor"] * np.random.default_rng(SEED).normal(size=motors.shape)
    return identified(subject, q, u, a, motors + noise)


def straps(out: Path, clock: Any, scan: str = "thigh", prefix: str = "") -> Any:
    """Force of one site's strap [N] by both mats on a scan; wrench.csv of each."""
    import numpy as np

    import geocontact as gc

    total = np.zeros(len(clock))
    for name in (f"{prefix}front", f"{prefix}behind"):
        found = gc.mat(
            out / name / "mat.csv",
            surface=MESHES / f"{scan}.stl",
            unit="mm",
            landmarks=out / name / "landmarks.csv",
            layout=out / name / "layout.toml",
        ).table("wrench")
        found.to_csv(out / name / "wrench.csv", index=False)
        total += np.interp(clock, found["time [s]"], found["fx [N]"])
    return total


MATS_OF_THE_THIGH = ('strap = ["front/wrench.csv", "behind/wrench.csv"]',)


def write_studies(
    out: Path,
    spans: Mapping[str, tuple[float, float]],
    mats: Mapping[str, tuple[str, ...]] | None = None,
    studies: Mapping[str, tuple[str, ...]] | None = None,
) -> None:
    """calibration.toml and prediction.toml, or `studies` by name; `mats` are the lines of trials with other ones."""
    head = ['mass = { value = 70, unit = "kg" }', 'height = { value = 1.75, unit = "m" }', "exoskeleton = true"]
    head += ['tracks = ["coordinates", "force", "centre", "torque", "strap"]', "", "[noise]"]
    head += [f'{key} = {{ value = {value}, unit = "{unit}" }}' for key, (value, unit) in TOLD.items()]
    files = [
        'coordinates = "coordinates.sto"',
        'plates = "plates.mot"',
        'feet = "feet_force"',
        'torques = "torques.sto"',
    ]
    for study, names in (studies or {"calibration": PASSIVE, "prediction": HELD_OUT}).items():
        lines = list(head)
        for name in names:
            begin, end = spans[name]
            lines += [
                "",
                "[[trials]]",
                f'name = "{name}"',
                *files,
                *(mats or {}).get(name, MATS_OF_THE_THIGH),
                f"start = {begin:.6g}",
                f"end = {end:.6g}",
            ]
        (out / f"{study}.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def calibrate(out: Path, nodes: float) -> None:
    """A and B; parameters for C2 beside them."""
    import geocontact as gc

    found = gc.sit_to_stand.calibrate(out / "calibration.toml", nodes=nodes, resamples=0)
    found.write(out / "cal")


GIVEN = {
    "all given": ("force", "centre", "torque"),
    "without ground reaction": ("torque",),
    "without torques": ("force", "centre"),
}
ONCE = "without torques"
"""Not asked again with stiffer straps: its search is the longest."""


def predict(out: Path, nodes: float, factor: float, keep: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """C1, and C2 with stiffer straps, as `geocontact sit-to-stand predict` does it; CPU time of each search limited.

    `keep` is told of the rows as soon as there is one more.
    """
    import numpy as np

    from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
    from geocontact.dynamics.collocation.solve import SolverOptions, refined, solve
    from geocontact.io.recordings.spheres import read_contact_parameters
    from geocontact.standing_up.exoskeleton import WORN_PARAMETERS, with_exoskeleton
    from geocontact.standing_up.phase import judged
    from geocontact.standing_up.phases import phase_c
    from geocontact.standing_up.strap_sites import searched
    from geocontact.standing_up.trials import seen_in
    from geocontact.standing_up.trivial_trials import mean_trial

    study, known = (standing_trials(out / f"{name}.toml", "study")
                    for name in ("prediction", "calibration"))  # fmt: skip
    units = {each.name: each.unit for each in WORN_PARAMETERS}
    bounds = {each.name: (each.least, each.most) for each in WORN_PARAMETERS}
    values = read_contact_parameters(out / "cal" / "parameters.csv", units, bounds)
    stiffer = {name: value * (factor if name in SPRINGS else 1.0) for name, value in values.items()}
    p = searched(WORN_PARAMETERS, [stiffer[each.name] for each in WORN_PARAMETERS])
    model, rows = with_exoskeleton(study.subject), []
    for trial in study.trials:
        for name, tracks in GIVEN.items():
            if name == ONCE and factor != 1.0:
                continue
            phase = phase_c(model, study.subject, trial, study.noise, p, tracks=tracks)
            options = SolverOptions("radau", 4, 1, 1e-7, 300, LONGEST)
            mesh = np.linspace(0.0, 1.0, round(nodes * float(trial.time[-1])) + 1)
            found = refined(phase.control, solve(phase.control, options, meshes=(mesh,)), options, model.turning)
            seen = seen_in(model, found.motions[0], p, trial.time, trial.name)
            (told,) = judged(model.stepper, range(6), model.turning, phase, found, certify=found.solved)
            passed = told.certificate is not None and told.certificate.converged
            how = {"ending": found.ending, "iterations": found.iterations, "cpu seconds": round(found.seconds, 2)}
            how |= {"certified": passed, "residual [N]": round(float(told.force.max()), 3)}
            rows.append({"trial": trial.name, "predictor": name} | how | off_from(trial, seen))
            print(rows[-1], flush=True)
            keep({"factor": factor, "rows": rows})
        mean = off_from(trial, mean_trial(known.trials, trial.time))
        rows.append({"trial": trial.name, "predictor": "mean of the calibration"} | mean)
    return {"factor": factor, "rows": rows}


def off_from(trial: Any, seen: Any) -> dict[str, Any]:
    """RMSD of each channel; angles of the six hinges."""
    import numpy as np

    def rms(of: Any) -> Any:
        return np.round(np.sqrt(np.mean(of**2, axis=0)), 3)

    return {
        "angles [deg]": np.round(np.degrees(rms(seen.q - trial.q))[3:], 2).tolist(),
        "GRF [N]": rms(seen.force - trial.force).tolist(),
        "CoP [mm]": float(rms(1e3 * (seen.centre - trial.centre))),
        "torques [N m]": rms(seen.torque - trial.torque).tolist(),
        "strap [N]": float(rms(seen.strap - trial.strap)),
    }


def written(folder: Path) -> dict[str, Any]:
    """What a calibration wrote."""
    import pandas as pd

    errors, certificates = (pd.read_csv(folder / f"{table}.csv") for table in ("errors", "certificate"))
    record = json.loads((folder / "run.json").read_text("utf-8"))
    columns = ["phase", "parameter", "unit", "value", "lower", "upper", "verdict"]
    parameters = pd.read_csv(folder / "parameters.csv")[columns]
    return {
        "RMSD": table_of(errors.assign(predictor="calibrated")),
        "certified": f"{int((certificates['certified'] == 'yes').sum())} of {len(certificates)}",
        "largest residual [N, N m]": certificates[["residual [N]", "residual [N m]"]].max().tolist(),
        "results": record["results"],
        "warnings": record["warnings"],
        "parameters": json.loads(parameters.to_json(orient="records")),
    }


def table_of(errors: Any) -> dict[str, dict[str, dict[str, float]]]:
    """Rows of the paper's tables by predictor and trial: angles as their mean, forces by themselves."""
    found: dict[str, dict[str, dict[str, float]]] = {}
    for (predictor, trial), own in errors.groupby(["predictor", "trial"], sort=False):
        by = own.set_index("quantity")["rmsd"]
        row = {"angles [deg]": float(by[[name for name in ANGLES if name in by]].mean())}
        row |= {f"{name} [N]": float(by[name]) for name in ("force_x", "force_y", "strap") if name in by}
        row |= {"centre [mm]": float(by["centre"])} if "centre" in by else {}
        moments = [name for name in by.index if name.endswith(" torque")]
        row |= {"torques [N m]": float(by[moments].mean())} if moments else {}
        found.setdefault(predictor, {})[trial] = {name: round(value, 3) for name, value in row.items()}
    return found


if __name__ == "__main__":
    main()
