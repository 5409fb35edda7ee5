"""Tables of two benchmarks: the summary of docs/reference/opensim_models.md, and every model and set-up: `python -m
benchmarks.dynamics.opensim_tables`.

python -m benchmarks.dynamics.opensim_models FOLDER --name opensim_packages
python -m benchmarks.dynamics.opensim_setups FOLDER
"""

from __future__ import annotations

import json
from pathlib import Path
from statistics import median
from typing import Any

RESULTS = Path(__file__).resolve().parents[1] / "results"
Row = dict[str, Any]


def main() -> None:
    """Print them."""
    print("\n\n".join("\n".join(table) for table in (summary(), models(), scaling(), kinematics(), dynamics())))


def summary() -> list[str]:
    """Median and largest difference of each kind, over all models and set-ups that have it."""
    models_read = [row for row in _results("opensim_packages")["models"] if "refused" not in row]
    known = [{**row, **row.get("rewritten", {})} for row in models_read]
    angles = [row for row in known if "angles_off_deg" in row]
    scaled, fitted, forces = (_setups(key) for key in ("scaled_off", "sum_over_opensims", "forces_off_share"))
    rows = [
        _spread("places of bodies [mm]", known, "bodies_apart_mm"),
        _spread("generalised forces, of range", known, "forces_off_share"),
        _spread("scaled masses, inertia, places", known, "scaled_off"),
        _spread("angles of inverse kinematics [deg]", angles, "angles_off_deg"),
        _spread("set-ups of scaling: masses, places", scaled, "scaled_off"),
        _spread("moments of inertia", scaled, "inertia_off"),
        _spread("places of markers [mm]", scaled, "markers_apart_mm"),
        _spread("set-ups of inverse kinematics: angle [deg]", fitted, "angles_off_deg", ".1f"),
        _spread("sum of squares, of OpenSim's", fitted, "sum_over_opensims", ".3f"),
        _spread("off the truth here [deg]", fitted, "off_truth_rms_deg", ".2f"),
        _spread("off the truth, OpenSim [deg]", fitted, "opensim_off_truth_rms_deg", ".2f"),
        _spread("set-ups of inverse dynamics: forces, of range", forces, "forces_off_share"),
        _spread("CPU s of a set-up here", [*scaled, *fitted, *forces], "cpu_s", ".1f"),
        _spread("CPU s of a set-up, OpenSim", [*scaled, *fitted, *forces], "opensim_cpu_s", ".1f"),
    ]
    return _table(("difference", "files", "median", "largest"), rows)


def _spread(title: str, rows: list[Row], key: str, form: str = ".0e") -> list[str]:
    values = [row[key] for row in rows]
    return [title, str(len(values)), f"{median(values):{form}}", f"{max(values):{form}}"]


def models() -> list[str]:
    """Every model: bodies, forces, scaling, angles, frames per CPU second; in brackets as OpenSim writes it again."""
    head = ("model", "coordinates", "bodies, mm", "forces, of range", "scaled", "angles", "frames/s here, OpenSim")
    return _table(head, [_model(row) for row in _results("opensim_packages")["models"]])


def _model(row: Row) -> list[str]:
    name = f"`{Path(row['model']).name}`"
    if "refused" in row:
        return [name, "", "", row["refused"], "", "", ""]
    again = row.get("rewritten", {})

    def both(key: str) -> str:
        told = f"{row[key]:.0e}"
        return f"{told} ({again[key]:.0e})" if key in again and row[key] > 1e-9 else told

    places, forces, size = (both(key) for key in ("bodies_apart_mm", "forces_off_share", "scaled_off"))
    if "angles_off_deg" not in row:
        return [name, str(row["coordinates"]), places, forces, size, f"{row['markers']} markers", ""]
    speed = f"{row['frames_per_second']:.0f}, {row['opensim_frames_per_second']:.0f}"
    return [name, str(row["coordinates"]), places, forces, size, f"{row['angles_off_deg']:.0e}°", speed]


def scaling() -> list[str]:
    """Set-ups of ScaleTool."""
    head = ("set-up", "masses, places", "moments of inertia", "markers, mm", "CPU s here, OpenSim")
    return _table(head, [
        [
            _name(row), f"{row['scaled_off']:.0e}", f"{row['inertia_off']:.0e}", f"{row['markers_apart_mm']:.0e}",
            _time(row),
        ]
        for row in _setups("scaled_off")
    ])  # fmt: skip


def kinematics() -> list[str]:
    """Set-ups of InverseKinematicsTool."""
    head = (
        "set-up",
        "held",
        "largest angle",
        "sum of squares, of OpenSim's",
        "frames larger",
        "off the truth here, OpenSim",
        "CPU s here, OpenSim",
    )
    return _table(head, [
        [
            _name(row), str(len(row["held"].split(", ")) if row["held"] else 0), f"{row['angles_off_deg']:.1f}°",
            f"{row['sum_over_opensims']:.3f}", f"{row['frames_with_larger_sum']} of {row['frames']}",
            f"{row['off_truth_rms_deg']:.2f}°, {row['opensim_off_truth_rms_deg']:.2f}°", _time(row),
        ]
        for row in _setups("sum_over_opensims")
    ])  # fmt: skip


def dynamics() -> list[str]:
    """Set-ups of InverseDynamicsTool."""
    head = (
        "model",
        "set-up",
        "forces, of range",
        "columns beyond 1 %",
        "not read, as a warning says",
        "CPU s here, OpenSim",
    )
    return _table(head, [
        [
            f"`{row['model']}`", row["set-up"], f"{row['forces_off_share']:.0e}",
            str(len(row["forces_beyond_1_percent"])), row.get("forces_not_read", ""), _time(row),
        ]
        for row in _setups("forces_off_share")
    ])  # fmt: skip


def _results(name: str) -> Row:
    found: Row = json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))
    return found


def _setups(key: str) -> list[Row]:
    return [row for row in _results("opensim_setups")["set-ups"] if key in row]


def _name(row: Row) -> str:
    plain = "" if row["model"] == "Model_Pose2Sim_simple.osim" else ", with muscles"
    return f"`{row['set-up']}`{plain}"


def _time(row: Row) -> str:
    return f"{row['cpu_s']:.1f}, {row['opensim_cpu_s']:.1f}"


def _table(head: tuple[str, ...], rows: list[list[str]]) -> list[str]:
    lines = [list(head), ["---"] * len(head), *rows]
    return [f"| {' | '.join(cells)} |" for cells in lines]


if __name__ == "__main__":
    main()
