"""Where the time of a predicted trial goes, synthetic: `python -m benchmarks.standing.predict`.

The shipped trial that was not used, by every predictor of `geocontact sit-to-stand predict` with its usual options: CPU
seconds of the search, in it those of the first mesh and of the functions' construction, and of the certificate; and
whether a search that starts on the first predictor's answer is shorter.
"""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

SAMPLES = Path(__file__).resolve().parents[2] / "meshes"


def main() -> None:
    """Measure, print, write."""
    pin()
    from benchmarks.machine import write_results

    rows = measured()
    print(json.dumps(rows, indent=2))
    write_results("standing_predict", {"seed": 34}, rows, {"casadi", "scipy"})


def measured() -> list[dict[str, Any]]:
    """A row for each predictor, cold, and from the first one's answer."""
    import numpy as np

    from geocontact.analyses.sit_to_stand.predict.predictions import TOLERANCE
    from geocontact.analyses.sit_to_stand.search_options import StandingSearchOptions
    from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
    from geocontact.dynamics.collocation.blocks import sparse_program
    from geocontact.dynamics.collocation.motion import scheme
    from geocontact.dynamics.collocation.solve import SolverOptions, refined, rough, solve
    from geocontact.dynamics.collocation.transcription import Transcription, scales_from
    from geocontact.standing_up.chain import EVERY_PLANTED
    from geocontact.standing_up.exoskeleton import STRAP_PLANTED, strapped
    from geocontact.standing_up.phase import judged
    from geocontact.standing_up.phases import phase_c
    from geocontact.standing_up.prediction import GIVEN

    study = standing_trials(SAMPLES / "standing_up_held_out" / "study.toml", "study")
    model, trial, p = strapped(study.subject, study.sites), study.trials[0], np.r_[EVERY_PLANTED, STRAP_PLANTED]
    o = StandingSearchOptions()
    mesh = np.linspace(0.0, 1.0, round(o.nodes * float(trial.time[-1])) + 1)
    options = SolverOptions("radau", o.degree, 1, TOLERANCE, o.iterations, o.time_limit)
    rows: list[dict[str, Any]] = []
    first = None
    for name, tracks in GIVEN.items():
        phase = phase_c(model, study.subject, trial, study.noise, p, tracks=tracks)
        began = time.process_time()
        on = Transcription(phase.control, scheme("radau", o.degree), (mesh,), scales_from(phase.control))
        sparse_program(on.blocks(), on.size)
        built = time.process_time() - began
        coarse = solve(phase.control, rough(options), meshes=(mesh,))
        found = refined(phase.control, coarse, options, model.turning)
        began = time.process_time()
        (seen,) = judged(model.stepper, range(6), model.turning, phase, found)
        certified = seen.certificate is not None and seen.certificate.converged
        row = {"predictor": name, "iterations": found.iterations, "search [s]": found.seconds}
        row |= {"of it the first mesh [s]": coarse.seconds}
        row |= {"of it building [s]": built, "certificate [s]": time.process_time() - began, "certified": certified}
        row["objective"] = found.objective
        if first is not None:
            warm = solve(phase.control, rough(options), meshes=(mesh,), warm=first)
            warm = refined(phase.control, warm, options, model.turning)
            row["from the first one's answer"] = {
                "iterations": warm.iterations, "search [s]": warm.seconds, "objective": warm.objective
            }  # fmt: skip
        first = first or found
        rows.append(row)
        print(row, flush=True)
    return rows


if __name__ == "__main__":
    main()
