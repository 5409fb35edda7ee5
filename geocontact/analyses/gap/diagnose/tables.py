"""Tables of a diagnosis, by the name of their files."""

from __future__ import annotations

import pandas as pd

from geocontact.analyses.gap.diagnose.figures import axis_units
from geocontact.gap.diagnose import Findings


def diagnosis_tables(findings: Findings) -> dict[str, pd.DataFrame]:
    """`gap_map`, `ranking`, `held_out`; `trials` where something is named, `surface` where there are cells of a mat."""
    found = {
        "gap_map": gap_map_table(findings),
        "ranking": ranking_table(findings),
        "held_out": held_out_table(findings),
    }
    found |= {"trials": trials_table(findings)} if findings.trials else {}
    return found | ({"surface": surface_table(findings)} if findings.surface else {})


def gap_map_table(findings: Findings) -> pd.DataFrame:
    """A row per cell; `low` and `high` in the unit of the axis, `gap` in that of the channel, SI."""
    units, system = axis_units(findings), findings.attribution.problem.system
    return pd.DataFrame(
        {
            "channel": [c.channel for c in findings.cells],
            "axis": [c.axis for c in findings.cells],
            "low": [c.low for c in findings.cells],
            "high": [c.high for c in findings.cells],
            "axis_unit": [units.get(c.axis, "-").replace("–", "-") for c in findings.cells],
            "gap": [c.gap for c in findings.cells],
            "gap_unit": [system.unit(c.channel) for c in findings.cells],
            "share [-]": [c.share for c in findings.cells],
            "share_low [-]": [c.ci95[0] for c in findings.cells],
            "share_high [-]": [c.ci95[1] for c in findings.cells],
            "floor [-]": [c.floor for c in findings.cells],
            "p_value [-]": [c.p_value for c in findings.cells],
        }
    )


def ranking_table(findings: Findings) -> pd.DataFrame:
    """A row per model that was tried, the largest gain first."""
    rows = findings.ranking
    return pd.DataFrame(
        {
            "model": [one.label for one in rows],
            "answer": [one.effects for one in rows],
            "gain [nats]": [one.gain for one in rows],
            "gain_calibration [nats]": [one.calibration for one in rows],
            "probability [-]": [one.probability for one in rows],
        }
    )


def trials_table(findings: Findings) -> pd.DataFrame:
    """A row per trial: how much better it is predicted from all others with what was named."""
    return pd.DataFrame(
        {
            "trial": [one.trial for one in findings.trials],
            "held_out": [one.held_out for one in findings.trials],
            "gain_left_out [nats]": [one.nats for one in findings.trials],
        }
    )


def surface_table(findings: Findings) -> pd.DataFrame:
    """A row per cell of a mat: where it lies in the scan's frame, its part in the load and in the channel's gap."""
    parts = [
        pd.DataFrame(
            {
                "site": one.site,
                "channel": one.channel,
                "id": one.ids,
                **{f"{axis} [m]": one.place[:, k] for k, axis in enumerate("xyz")},
                "load_share [-]": one.load,
                "gap_share [-]": one.gap,
                "holds_most": [name in one.holding for name in one.ids],
            }
        )
        for one in findings.surface
    ]
    return pd.concat(parts, ignore_index=True)


def held_out_table(findings: Findings) -> pd.DataFrame:
    """A row per sample of the held-out trials: measured, base model, and with what was named."""
    system = findings.attribution.problem.system
    parts = []
    for trial in findings.held_out:
        columns: dict[str, object] = {"trial": trial.name, "time [s]": trial.time}
        for c, name in enumerate(system.outputs):
            unit = system.unit(name)
            columns[f"{name} [{unit}]"] = trial.measured[:, c]
            columns[f"{name}_base [{unit}]"] = trial.base[:, c]
            if trial.named is not None:
                columns[f"{name}_with_effects [{unit}]"] = trial.named[:, c]
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)
