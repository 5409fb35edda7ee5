"""A row for every case of a benchmark."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.gap.benchmark.case import Worked
from geocontact.analyses.gap.benchmark.outcome import BenchmarkOutcome
from geocontact.gap_benchmark.harm import harmful, worse_channels
from geocontact.gap_benchmark.score import GAPS, answers, brier, confidently_wrong, reduction_errors


def cases_table(outcome: BenchmarkOutcome) -> pd.DataFrame:
    """A row per case: the truth, what was said of it, and what that scores."""
    return pd.DataFrame([dict(_row(one)) for one in outcome.cases if one.label is not None])


def _row(one: Worked) -> Iterator[tuple[str, object]]:
    label, said = one.label or {}, one.answers["diagnosis"]
    opponent = one.answers["regression_aware"]
    first = label["kind"] in GAPS
    yield from (("case", one.name), ("system", one.lot.system), ("kind", label["kind"]))
    yield "laboratory", one.lot.laboratory
    yield "truth", " + ".join(label["effects"])
    yield "words", label["words"]
    yield "nats", min(label["nats"].values(), default=None)
    yield "imitation_left [-]", label.get("imitation", {}).get("left")
    yield "imitated_by", label.get("imitation", {}).get("by", "")
    yield "verdict", said["verdict"]
    yield "effects", " + ".join(said["effects"])
    yield "ambiguity", " ".join(said["ambiguity"])
    yield "absorbed", " ".join(said["absorbed"])
    top = max(said["probabilities"], key=lambda name: said["probabilities"][name], default="")
    yield from (("most_probable", top), ("top_probability [-]", said["probabilities"].get(top)))
    yield "first_right", answers(said)[:1] == label["effects"] if first else None
    yield "confidently_wrong", confidently_wrong(label, said)
    yield "brier [-]", brier(label, said)
    yield from (("harmful", harmful(label, said)), ("worse_channels", " ".join(worse_channels(label, said))))
    errors = [error for error, _ in reduction_errors(label, said)]
    inside = [held for _, held in reduction_errors(label, said) if held is not None]
    yield "reduction [-]", " ".join(f"{c}={v:.4f}" for c, v in label["reduction"].items() if v is not None)
    yield "reduction_error_mean [-]", mean(errors)
    yield "reduction_error_most [-]", max(errors, default=None)
    yield "channels_inside_ci95", f"{sum(inside)}/{len(inside)}"
    yield from (("cpu [s]", round(one.cpu, 3)), ("wall [s]", round(one.wall, 3)), ("same_again", one.same))
    yield from (("regression_verdict", opponent["verdict"]), ("regression_effects", " + ".join(opponent["effects"])))


def mean(values: Sequence[float]) -> float | None:
    """None where there is nothing."""
    return float(np.mean(values)) if values else None
