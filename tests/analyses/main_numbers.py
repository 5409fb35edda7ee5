"""Numbers that results have as attributes, read back from the files that `write` leaves, by the name of the job.

Units are turned into SI by the factors of this page.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

MM, MM2, MPA, DEG = 1e-3, 1e-6, 1e6, np.pi / 180.0
IN_SI = {
    "mm": MM,
    "deg": DEG,
    "MPa": MPA,
    "mm^2": MM2,
    "%": 0.01,
    "1/mmHg": 1.0 / 133.322387415,
    "mm/N": MM,
    "mm/s": MM,
    "deg/s": DEG,
}
Read = Callable[[Path], Any]


def column(file: str, name: str, factor: float = 1.0) -> Read:
    return lambda out: pd.read_csv(out / file)[name].to_numpy(float) * factor


def columns(file: str, form: str, names: str, factor: float = 1.0) -> Read:
    """Columns side by side: "force_{} [N]" of "xyz"."""
    return lambda out: pd.read_csv(out / file)[[form.format(name) for name in names]].to_numpy(float) * factor


def by_column(file: str, form: str, factor: float = 1.0) -> Read:
    """Every column of the form by what stands for the braces: "{}_moment [N m]"."""
    start, end = form.split("{}")

    def read(out: Path) -> dict[str, Any]:
        table = pd.read_csv(out / file).drop(columns="time [s]")
        named = [name for name in table if name.startswith(start) and name.endswith(end)]
        return {name[len(start) : len(name) - len(end)]: table[name].to_numpy(float) * factor for name in named}

    return read


def by_pair(name: str, factor: float = 1.0) -> Read:
    """A column of contacts.csv for each pair."""

    def read(out: Path) -> dict[str, Any]:
        table = pd.read_csv(out / "contacts.csv")
        return {pair: rows[name].to_numpy(float) * factor for pair, rows in table.groupby("pair", sort=False)}

    return read


def by_side(form: str, name: str, factor: float = 1.0, sides: tuple[str, ...] = ("right",)) -> Read:
    """A column, or several in a tuple, of a file for each side or trial."""
    return lambda out: {each: column(form.format(each), name, factor)(out) for each in sides}


def by_rows(file: str, keys: str | list[str], value: str, factor: float | None = None) -> Read:
    """Values by the words of their rows, each in the unit of its row unless a factor is named."""

    def read(out: Path) -> dict[Any, float]:
        table = pd.read_csv(out / file)
        names = table[keys] if isinstance(keys, str) else table[keys].itertuples(index=False, name=None)
        units = [factor] * len(table) if factor is not None else [IN_SI.get(unit, 1.0) for unit in table["unit"]]
        return {name: number * unit for name, number, unit in zip(names, table[value], units, strict=True)}

    return read


def entry(file: str, *keys: str, factor: float = 1.0) -> Read:
    """What stands in a JSON file, numbers times a factor."""

    def read(out: Path) -> Any:
        found = json.loads((out / file).read_text(encoding="utf-8"))
        for key in keys:
            found = found[key]
        return np.asarray(found) * factor

    return read


def entries(file: str, *keys: str, each: tuple[str, ...] = ("value",), factor: float = 1.0) -> Read:
    """Numbers by name in a JSON file: {"name": {"value": 1.0}}; the value itself without `each`."""

    def read(out: Path) -> dict[str, Any]:
        found = json.loads((out / file).read_text(encoding="utf-8"))
        for key in keys:
            found = found[key]
        if not each:
            return {name: one * factor for name, one in found.items()}
        return {name: np.squeeze([one[key] * factor for key in each]) for name, one in found.items()}

    return read


def grid(file: str, name: str, factor: float) -> Read:
    """A column over frames and thresholds."""

    def read(out: Path) -> Any:
        table = pd.read_csv(out / file)
        return table[name].to_numpy(float).reshape(-1, table["threshold [mm]"].nunique()) * factor

    return read


def factors(out: Path) -> dict[tuple[str, ...], float]:
    table = pd.read_csv(out / "factors.csv").set_index(["profile", "task", "hand"])
    return {(*row, phase): table.loc[row, phase] for row in table.index for phase in table.columns}


def markers(out: Path) -> dict[str, Any]:
    lines = (out / "markers.trc").read_text(encoding="utf-8").splitlines()
    names = lines[3].split("\t")[2::3]
    rows = np.array([line.split("\t")[2:] for line in lines[6:] if line.strip()], dtype=float)
    factor = MM if "\tmm\t" in lines[2] else 1.0
    return {name: rows[:, 3 * k : 3 * k + 3] * factor for k, name in enumerate(name for name in names if name)}


def storage(file: Path) -> dict[str, Any]:
    """Columns of a storage file of OpenSim."""
    names, *rows = file.read_text(encoding="utf-8").partition("endheader\n")[2].strip().splitlines()
    return dict(zip(names.split(), np.array([row.split() for row in rows], dtype=float).T, strict=True))


def trials(name: str) -> Read:
    return lambda out: {
        file.stem: pd.read_csv(file)[name].to_numpy(float) for file in sorted((out / "trials").glob("*.csv"))
    }


def channels(out: Path) -> dict[str, dict[str, Any]]:
    tables = {file.stem: pd.read_csv(file).drop(columns="time [s]") for file in sorted((out / "trials").glob("*.csv"))}
    return {
        trial: {name.partition(" [")[0]: values.to_numpy(float) for name, values in table.items()}
        for trial, table in tables.items()
    }


def missed(out: Path) -> dict[str, dict[str, float]]:
    """Root mean square of measured minus simulated, from the curves."""
    table = pd.read_csv(out / "first_run.csv").set_index("trial")
    measured = [name for name in table if " measured [" in name]
    off = {
        name.partition(" measured")[0]: table[name] - table[name.replace("measured", "simulated")] for name in measured
    }
    errors = pd.DataFrame({name: values**2 for name, values in off.items()}).groupby(level=0).mean() ** 0.5
    return {str(trial): row.to_dict() for trial, row in errors.iterrows()}


def reduced(out: Path) -> dict[tuple[str, str], float]:
    """Case by its person, task and hand."""
    table = pd.read_csv(out / "outcomes.csv")
    return {tuple(row[:4]): row[4] for row in table[["profile", "person", "task", "hand", "force [N]"]].to_numpy()}


TIME = column("area.csv", "time [s]")
AREA: dict[str, Read] = {
    "time": lambda out: np.unique(TIME(out)),
    "thresholds": lambda out: np.unique(column("area.csv", "threshold [mm]", MM)(out)),
    "area": grid("area.csv", "area_fixed [mm^2]", MM2),
    "area_moving": grid("area.csv", "area_moving [mm^2]", MM2),
    "min_distance": lambda out: grid("area.csv", "min_distance [mm]", MM)(out)[:, 0],
}
DIAGNOSIS: dict[str, Read] = {
    "probabilities": entries("diagnosis.json", "probabilities", each=()),
    "rmse": entries("diagnosis.json", "gap", each=("rmse_before", "rmse_after")),
    "reduction": entries("diagnosis.json", "gap", each=("reduction",)),
}
WRITTEN: Mapping[str, Mapping[str, Read]] = {
    "area": AREA,
    "pressure": AREA
    | {"force": column("pressure.csv", "force [N]"), "pressure": column("pressure.csv", "peak [MPa]", MPA)},
    "area_pairs": {
        "area": grid("totals.csv", "area_total [mm^2]", MM2),
        "areas": lambda out: {
            name: grid("totals.csv", f"area_{name} [mm^2]", MM2)(out)
            for name in ("medial", "lateral", "patellofemoral")
        },
    },
    "centre_of_pressure": {
        "force": columns("cop.csv", "force_{} [N]", "xyz"),
        "centre_of_pressure": columns("cop.csv", "cop_{} [m]", "xyz"),
        "free_moment": column("cop.csv", "free_moment [N m]"),
    },
    "cohort": {"means": lambda out: {}},
    "diagnose": DIAGNOSIS,
    "discriminability": {
        "smallest": by_rows("detectability.csv", "effect", "smallest", 1.0),
        "separation": by_rows("separability.csv", ["effect", "imitator"], "separation [nats]", 1.0),
    },
    "fit_shape": {
        "radius": entry("fit.json", "radius_mm", factor=MM),
        "point": entry("fit.json", "point_mm", factor=MM),
        "rms": entry("fit.json", "rms_mm", factor=MM),
    },
    "thickness": {
        "along": column("thickness.csv", "along_normal [mm]", MM),
        "nearest": column("thickness.csv", "nearest [mm]", MM),
    },
    "functional_joint": {
        "point": entry("joint.json", "first", "point_mm", factor=MM),
        "rms": entry("joint.json", "apart_rms_mm", factor=MM),
    },
    "gather": {"time": trials("time [s]"), "channels": channels},
    "init_gap_case": {"time": trials("time [s]"), "errors": missed},
    "inject": {
        "amplitudes": entries("planted.json", "parameters"),
        "size": entry("planted.json", "gap_over_floor"),
        "evidence": entry("planted.json", "evidence_at_most_nats"),
        "probabilities": entries("diagnosis/diagnosis.json", "probabilities", each=()),
    },
    "inverse_dynamics": {
        "time": lambda out: storage(out / "id.sto")["time"],
        "moments": lambda out: {name: values for name, values in storage(out / "id.sto").items() if name != "time"},
    },
    "inverse_kinematics": {
        "rms": entry("ik.json", "rms_mm", factor=MM),
        "distances": by_column("markers.csv", "{} [mm]", MM),
        "rms_mm": entry("ik.json", "rms_mm"),
        "markers_mm": lambda out: json.loads((out / "ik.json").read_text())["markers"],
    },
    "knee.settle": {
        "force": lambda out: {
            side: column("settle.csv", f"force_{side} [N]")(out) for side in ("medial", "lateral", "total")
        },
        "pressure": column("settle.csv", "peak [MPa]", MPA),
        "area": column("settle.csv", "contact_area [mm^2]", MM2),
    },
    "load_cells": {
        "force": lambda out: {"cells": by_column("forces.csv", "{} [N]")(out)},
        "peak": lambda out: {"cells": {s: f.max() for s, f in by_column("forces.csv", "{} [N]")(out).items()}},
    },
    "mat": {
        "force": columns("wrench.csv", "f{} [N]", "xyz"),
        "normal_force": column("wrench.csv", "normal [N]"),
        "area": column("wrench.csv", "area [mm^2]", MM2),
    },
    "misalignment.compare": {
        "rmse": by_rows("comparison.csv", ["trial", "channel"], "rmse"),
        "r2": by_rows("comparison.csv", ["trial", "channel"], "r2 [-]", 1.0),
    },
    "misalignment.design": {
        "angle": column("force.csv", "beta [deg]", DEG),
        "force": column("force.csv", "force [N]"),
        "peak": entry("design.json", "offset", "peak_N"),
        "needed_stroke": lambda out: (
            entry("design.json", "needed_stroke", "lower_end_at_most_mm", factor=MM)(out),
            entry("design.json", "needed_stroke", "upper_end_at_least_mm", factor=MM)(out),
        ),
    },
    "misalignment.identify": {"numbers": by_rows("intervals.csv", "number", "value")},
    "misalignment.population": {
        "quantiles": by_rows("quantiles.csv", "share [-]", "peak_force [N]", 1.0),
        "exceeding": entry("population.json", "above_limit", "value"),
    },
    "misalignment.simulate": {
        "angle": by_side("{}.csv", "beta [deg]", DEG, ("locked_1",)),
        "force": by_side("{}.csv", "force [N]", 1.0, ("locked_1",)),
    },
    "modulus": {
        "modulus": entry("modulus.json", "E_star_Pa"),
        "interval": entry("modulus.json", "E_star_ci95_Pa"),
    },
    "prosthesis.calibrate": {
        "time": column("stance.csv", "time [s]"),
        "force": columns("stance.csv", "force_{} [N]", "xyz"),
        "plate_force": columns("stance.csv", "plate_force_{} [N]", "xyz"),
        "parameters": by_rows("numbers.csv", "number", "value"),
    },
    "prosthesis.compare": {
        "rmse": by_rows("errors.csv", ["trial", "quantity"], "rmse"),
        "r2": by_rows("errors.csv", ["trial", "quantity"], "r2 [-]", 1.0),
    },
    "prosthesis.design": {
        "best": by_rows("answers.csv", "outcome", "best fulcrum [mm]", MM),
        "interval": lambda out: {
            row["outcome"]: (row["lower fulcrum [mm]"] * MM, row["upper fulcrum [mm]"] * MM)
            for _, row in pd.read_csv(out / "answers.csv").iterrows()
        },
    },
    "prosthesis.keel": {
        "bending": lambda out: by_rows("keel.csv", "number", "value")(out)["EI, plate on the keel"],
        "series": lambda out: by_rows("keel.csv", "number", "value")(out)["in series"],
    },
    "prosthesis.scale": {
        "masses": by_rows("segments.csv", "segment", "mass [kg]", 1.0),
        "joint_centres": lambda out: {
            row["joint"]: row[["x [mm]", "y [mm]", "z [mm]"]].to_numpy(float) * MM
            for _, row in pd.read_csv(out / "joints.csv").iterrows()
        },
    },
    "prosthesis.simulate": {
        "time": column("stance.csv", "time [s]"),
        "force": columns("stance.csv", "force_{} [N]", "xyz"),
        "ankle_moment": column("stance.csv", "ankle moment [N m]"),
        "stored_energy": column("stance.csv", "stored [J]"),
    },
    "prosthesis.walk": {
        "time": column("walk.csv", "time [s]"),
        "force": columns("walk.csv", "prosthesis force_{} [N]", "xyz"),
        "moments": by_column("walk.csv", "{} moment [N m]"),
    },
    "scale": {
        "rms": entry("scale.json", "static_rms_mm", factor=MM),
        "distances": entries("scale.json", "markers_mm", each=(), factor=MM),
        "scale_factors": entries("scale.json", "factors", each=()),
    },
    "shoulder.compare": {"rmsd": by_rows("comparison.csv", ["channel", "phase"], "rmsd")},
    "shoulder.optimise": {"factors": factors},
    "shoulder.simulate": {
        "time": by_side("{}.csv", "time [s]"),
        "elevation": by_side("{}.csv", "shoulder elevation [deg]", DEG),
        "force": lambda out: {"right": columns("right.csv", "force_{} [N]", "xyz")(out)},
        "support_torque": by_side("{}.csv", "support torque [N m]"),
    },
    "settle_pairs": {
        "force": by_pair("force [N]"),
        "pressure": by_pair("peak [MPa]", MPA),
        "area": by_pair("pressed_area [mm^2]", MM2),
    },
    "shoulder.study": {"rmsd": by_rows("summary.csv", ["channel", "part"], "rmsd")},
    "sit_to_stand.calibrate": {
        "parameters": by_rows("parameters.csv", ["phase", "parameter"], "value"),
        "rmsd": by_rows("errors.csv", ["trial", "quantity"], "rmsd"),
    },
    "sit_to_stand.compare": {"rmsd": by_rows("comparison.csv", ["trial", "predictor", "quantity"], "rmsd")},
    "sit_to_stand.coordinates": {"segments": by_rows("segments.csv", ["segment", "quantity"], "value", 1.0)},
    "sit_to_stand.design": {"chosen": by_rows("chosen.csv", "name", "value")},
    "sit_to_stand.device": {"parameters": by_rows("parameters.csv", "parameter", "value", 1.0)},
    "sit_to_stand.movements": {"starts": by_rows("movements.csv", "movement", "start [s]", 1.0)},
    "sit_to_stand.predict": {"rmsd": by_rows("errors.csv", ["trial", "predictor", "quantity"], "rmsd")},
    "virtual_markers": {"positions": markers},
}
"""By job and attribute."""


def unlike(found: Any, written: Any) -> str:
    """Where a value differs from what is written, by more than its digits; "" where it does not."""
    if isinstance(written, Mapping):
        if list(found) != list(written):
            return f"{list(found)} are not {list(written)}"
        return "; ".join(f"{name}: {one}" for name in written if (one := unlike(found[name], written[name])))
    one, other = np.asarray(found, float), np.asarray(written, float)
    same = one.shape == other.shape and np.allclose(one, other, rtol=1e-6, atol=1e-9, equal_nan=True)
    return "" if same else f"{found} is not {written}"
