"""The static figures of a diagnosis, by the name of their files."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.gap.diagnose.curves import resampled
from geocontact.data.gap.cell import BAND, FAST_PHASE
from geocontact.data.gap.held_out import HeldOut
from geocontact.gap.diagnose import Findings
from geocontact.gap.localise.gap_map import load_outputs
from geocontact.view.curves.diagnosis.before_after import SIDE_BY_SIDE, before_after
from geocontact.view.curves.diagnosis.gap_map import gap_map_figure
from geocontact.view.curves.diagnosis.gap_residuals import PHASE, gap_residuals
from geocontact.view.curves.diagnosis.gap_surface import gap_surface_figure
from geocontact.view.curves.diagnosis.ranking import ranking_figure
from geocontact.view.curves.diagnosis.reductions import reductions_figure
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


def map_figure(findings: Findings) -> Figure:
    """Where the gap is."""
    return gap_map_figure(findings.cells, axis_units(findings))


def gap_figures(findings: Findings) -> dict[str, Figure]:
    """Map, errors, ranking, residuals, cells of each mat, and curves of each channel where something was named."""
    found = {
        "gap_map": map_figure(findings),
        "reductions": _reductions(findings),
        "ranking": ranking_figure(findings.ranking),
        "gap_residuals": _residuals(findings),
    }
    found |= {f"{SURFACE}{_file_name(one.site, k)}": gap_surface_figure(one) for k, one in enumerate(findings.surface)}
    for c, name in enumerate(findings.attribution.problem.system.outputs):
        drawn = _before_after(findings, c)
        found |= {} if drawn is None else {f"before_after_{_file_name(name, c)}": drawn}
    return found


def _reductions(findings: Findings) -> Figure:
    d = findings.diagnosis
    effect = effect_words(findings) if any(t.named is not None for t in findings.held_out) else ""
    return reductions_figure(d.gap, [quantity_of(findings, name) for name in d.gap], effect)


def _residuals(findings: Findings) -> Figure:
    d, trials = findings.diagnosis, findings.held_out
    channels = findings.attribution.problem.system.outputs
    base = np.array([resampled(t, t.measured - t.base, GRID) for t in trials])
    named = [resampled(t, t.measured - t.named, GRID) for t in trials if t.named is not None]
    return gap_residuals(
        GRID,
        [quantity_of(findings, name) for name in channels],
        base,
        np.array(named) if named else None,
        {name: g.noise_floor for name, g in d.gap.items()},
        {w.channel: w.phase for w in d.where},
        effect_words(findings),
    )


def _before_after(findings: Findings, c: int) -> Figure | None:
    """One channel on the first held-out trials that have it; None where nothing is named, or gaps hide a phase."""
    trials = findings.held_out
    shown = [t for t in trials if np.isfinite(t.measured[:, c]).any()][:SIDE_BY_SIDE]
    if all(t.named is None for t in trials) or not shown:
        return None
    measured, before, after = (
        np.array([resampled(t, part, GRID)[:, c] for t, part in zip(shown, parts, strict=True)])
        for parts in ([t.measured for t in shown], [t.base for t in shown], [_named(t) for t in shown])
    )
    if not np.isfinite(measured + before + after).any(axis=1).all():
        return None
    quantity = quantity_of(findings, findings.attribution.problem.system.outputs[c])
    names, effect = [t.name for t in shown], effect_words(findings)
    return before_after(100.0 * GRID, measured, before, after, quantity, effect, range(len(shown)), names, PHASE)


def effect_words(findings: Findings) -> str:
    """What the curves are drawn with."""
    return " + ".join(findings.diagnosis.effects) or "the most probable candidate"


def _named(trial: HeldOut) -> Float[np.ndarray, "t c"]:
    return trial.base if trial.named is None else trial.named


def _file_name(channel: str, number: int) -> str:
    return channel if re.fullmatch(r"\w{1,60}", channel, re.ASCII) else str(number + 1)
