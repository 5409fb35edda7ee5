"""The static figures of a diagnosis, by the name of their files."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.gap.diagnose.curves import HeldOut, resampled
from geocontact.gap.diagnose import Findings
from geocontact.data.gap_cell import BAND, FAST_PHASE
from geocontact.gap.localise.gap_map import load_outputs
from geocontact.view.curves.diagnosis.before_after import SIDE_BY_SIDE, before_after
from geocontact.view.curves.diagnosis.gap_map import gap_map_figure
from geocontact.view.curves.diagnosis.gap_residuals import PHASE, gap_residuals
from geocontact.view.curves.diagnosis.gap_surface import gap_surface_figure
from geocontact.view.curves.diagnosis.ranking import Ranked, ranking_figure
from geocontact.view.curves.quantity import Quantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

GRID = np.linspace(0.0, 1.0, 401)
SURFACE = "gap_surface_"
PRINTED = {"N m": ("N m", 1.0), "N": ("N", 1.0), "m": ("mm", 1e3), "rad": ("°", 180.0 / np.pi)}


def quantity_of(findings: Findings, channel: str) -> Quantity:
    """A channel as it is drawn: lengths in mm, angles in degrees."""
    unit = findings.attribution.problem.system.unit(channel)
    printed, per_si = PRINTED.get(unit, (unit, 1.0))
    return Quantity(channel, printed, per_si)


def axis_units(findings: Findings) -> dict[str, str]:
    """SI unit of each axis of the gap map."""
    system = findings.attribution.problem.system
    units = {"phase": "–", BAND: "Hz", FAST_PHASE: "–"}
    for row in load_outputs(system):
        units["load"] = system.unit(system.outputs[row])
    for name in system.inputs:
        units |= {name: system.unit(name), f"{name}'": f"{system.unit(name)}/s"}
    return units


def ranking(findings: Findings) -> list[Ranked]:
    """Every model that was tried, the base, and the stand-in for anything unknown; the largest gain first."""
    found = findings.attribution
    probabilities = dict(findings.diagnosis.probabilities)
    zero = found.base.judged
    rows = [Ranked("none", "none", 0.0, 0.0, probabilities.get("none", 0.0))]
    unknown = found.remaining["none"]
    rows.append(Ranked("unknown", "unknown", unknown.nats, unknown.calibration, probabilities.get("unknown", 0.0)))
    for one in sorted(found.contenders, key=lambda c: -c.nats):
        gain, calibration = one.nats - zero.nats, one.judged.calibration - zero.calibration
        first = len(one.names) == 1 and not any(row.effects == one.names[0] for row in rows)
        probability = probabilities.get(one.names[0], 0.0) if first else None
        rows.append(Ranked(one.label, " + ".join(one.names), gain, calibration, probability))
    return sorted(rows, key=lambda row: -row.gain)


def gap_figures(findings: Findings, trials: Sequence[HeldOut]) -> dict[str, Figure]:
    """Map, ranking, residuals, cells of each mat, and before and after for each channel where something was named."""
    d = findings.diagnosis
    channels = findings.attribution.problem.system.outputs
    quantities = [quantity_of(findings, name) for name in channels]
    effect = " + ".join(d.effects) or "the most probable candidate"
    base = np.array([resampled(t, t.measured - t.base, GRID) for t in trials])
    named = [resampled(t, t.measured - t.named, GRID) for t in trials if t.named is not None]
    found = {
        "gap_map": gap_map_figure(findings.cells, axis_units(findings)),
        "ranking": ranking_figure(ranking(findings)),
        "gap_residuals": gap_residuals(
            GRID, quantities, base, np.array(named) if named else None,
            {name: g.noise_floor for name, g in d.gap.items()}, {w.channel: w.phase for w in d.where}, effect,
        ),
    }  # fmt: skip
    found |= {f"{SURFACE}{_file_name(one.site, k)}": gap_surface_figure(one) for k, one in enumerate(findings.surface)}
    for c, quantity in enumerate(quantities):
        shown = [t for t in trials if np.isfinite(t.measured[:, c]).any()][:SIDE_BY_SIDE]
        if not named or not shown:
            continue
        measured, before, after = (
            np.array([resampled(t, part, GRID)[:, c] for t, part in zip(shown, parts, strict=True)])
            for parts in ([t.measured for t in shown], [t.base for t in shown], [_named(t) for t in shown])
        )
        if np.isfinite(measured + before + after).any(axis=1).all():
            found[f"before_after_{_file_name(quantity.name, c)}"] = before_after(
                100.0 * GRID, measured, before, after, quantity, effect, range(len(shown)), [t.name for t in shown],
                PHASE,
            )  # fmt: skip
    return found


def _named(trial: HeldOut) -> Float[np.ndarray, "t c"]:
    return trial.base if trial.named is None else trial.named


def _file_name(channel: str, number: int) -> str:
    return channel if re.fullmatch(r"\w{1,60}", channel, re.ASCII) else str(number + 1)
