"""Straps at pelvis, thigh and shank through mats, synthetic: `python -m benchmarks.standing.sites OUT`.

Three passive trials of a finer simulation that begin on a chair, with pads at three sites for straps, recorded as a
laboratory would (`benchmarks.standing.session`): mats in front and behind at each site on the scans of `meshes/`. Then
the commands: inverse kinematics, inverse dynamics, six mats, phases A and B. Parts: pipelines, study (as in the paper:
mats at the pelvis in two trials, at thigh and shank in the third), all (every mat in every trial), C (two assisted
trials predicted with what study found, and with the straps' stiffnesses times 1.4), spread (of the parameters over
trials, and of exact ones). The paper's figures 2 to 7 are drawn beside. Everything is synthetic. Seed 34.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
SEED, TRIALS, HELD_OUT = 34, ("T1", "T2", "T3"), ("P1", "P2")
PERTURBED = 1.4
SHANK_PLANTED, PELVIS_PLANTED = (6.0e3, 1.5e3, 20.0, 0.28), (8.0e3, 4.0e3, 60.0, 0.12)
"""Stiffness of the pads across, along and (of what is calibrated only) in turning, and their place; invented."""
SCANS = {"strap": ("thigh", ""), "shank strap": ("shank", "shank_"), "pelvis strap": ("torso", "pelvis_")}
"""What a site's mats lie on, and what their folders begin with, by the truth's channel."""
KEYS = {"": "strap", "shank_": "strap_shank", "pelvis_": "strap_pelvis"}
CONFIGURATIONS = {
    "study": {"T1": ("pelvis_",), "T2": ("pelvis_",), "T3": ("", "shank_")},
    "all": dict.fromkeys(TRIALS, tuple(KEYS)),
    "C": {"P1": ("pelvis_",), "P2": ("", "shank_")},
}
PAPER = {"pelvis strap": 5.4, "strap": 2.3, "shank strap": 2.2}
"""RMSD [N] of its phase B."""


def main() -> None:
    """Make what is not there yet, run, compare, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.standing.sites", description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("parts", nargs="*", default=["pipelines", *CONFIGURATIONS, "spread"], metavar="PART")
    parser.add_argument("--nodes", type=float, default=30.0)
    options = parser.parse_args()
    pin()
    import geocontact as gc
    from benchmarks.machine import stamp

    warnings.simplefilter("ignore", gc.InputWarning)
    out: Path = options.out
    out.mkdir(parents=True, exist_ok=True)
    file = HERE / "results" / "standing_sites.json"
    report: dict[str, Any] = json.loads(file.read_text("utf-8")) if file.is_file() else {"cpu seconds": {}}
    report |= {"seed": SEED, "paper": PAPER}
    for part in options.parts:
        began, made_by = time.process_time(), stamp({"casadi", "numpy", "scipy"})
        if part == "pipelines":
            report[part] = pipelines(out)
        elif part in CONFIGURATIONS and part != "C":
            report[part] = calibrated(out, part, options.nodes)
        else:
            report[part] = {"C": predicted, "spread": spread}[part](out, options.nodes)
        report[part] |= made_by | {"nodes a second": options.nodes}
        report["cpu seconds"][part] = time.process_time() - began
        file.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
        print(json.dumps(report[part], indent=2), flush=True)


def planted() -> Any:
    """What the truth is searched as."""
    import numpy as np

    from benchmarks.standing.truth import PLANTED
    from geocontact.standing_up.strap_sites import PELVIS_STRAP, SHANK_STRAP, searched

    shank, pelvis = (searched(site.parameters, list(values))
                     for site, values in ((SHANK_STRAP, SHANK_PLANTED), (PELVIS_STRAP, PELVIS_PLANTED)))  # fmt: skip
    return np.r_[PLANTED, shank, pelvis]


def pipelines(out: Path) -> dict[str, Any]:
    """From the laboratory's files to those of a study; how far each is from the truth, over the trials."""
    import numpy as np

    from benchmarks.standing.nine import kinematics, straps, torques, write_studies
    from benchmarks.standing.nine_truth import write_truth
    from benchmarks.standing.session import session_of, write_session
    from geocontact.standing_up.chain import Subject
    from geocontact.standing_up.strap_sites import STRAP_SITES

    subject = Subject()
    if not (out / "truth.npz").is_file():
        write_truth(
            out / "truth.npz", subject, sites=STRAP_SITES, planted=planted(), names=(*TRIALS, *HELD_OUT), seated=True
        )
    with np.load(out / "truth.npz") as file:
        truth = {key: file[key] for key in file.files}
    session = session_of(truth)
    if not (out / "front").is_dir():
        write_session(out, session, subject, SEED)
    used = np.zeros(len(session.time), bool)
    for begin, end in session.spans.values():
        used |= (session.time > begin - 1e-9) & (session.time < end + 1e-9)
    q = kinematics(out, session.time)
    torques(out, subject, q, session.time, ("feet_force=foot", "chair_force=trunk"))
    off, largest = {}, {}
    for channel, (scan, prefix) in SCANS.items():
        true = session.channels[channel][used, 0]
        found = straps(out, session.time, scan, prefix)[used]
        off[channel], largest[channel] = float(np.sqrt(np.mean((found - true) ** 2))), float(np.abs(true).max())
    for name, trials in CONFIGURATIONS.items():
        sitting = ('chair = "chair_force"', "sitting = true")
        mats = {trial: (*sitting, *(_mats(prefix) for prefix in prefixes)) for trial, prefixes in trials.items()}
        write_studies(out, session.spans, mats, {name: tuple(trials)})
    residuals = np.array([truth[key] for key in truth if key.endswith(" residual")])
    return {
        "largest residual of the truth [N, N m]": residuals.max(axis=0).tolist(),
        "certified motions of the truth": int(sum(truth[key] for key in truth if key.endswith(" certified"))),
        "straps by the mats, off [N]": off,
        "largest force [N]": largest,
    }


def _mats(prefix: str) -> str:
    return f'{KEYS[prefix]} = ["{prefix}front/wrench.csv", "{prefix}behind/wrench.csv"]'


def calibrated(out: Path, name: str, nodes: float) -> dict[str, Any]:
    """A and B by the command."""
    import geocontact as gc
    from geocontact.standing_up.trials import seen_in

    found = gc.sit_to_stand.calibrate(out / f"{name}.toml", nodes=nodes, resamples=0)
    found.write(out / name)
    if name == "study":
        figures(out, "B", {t.recorded.name: (t.recorded, t.model) for t in found.trials}, found.given.noise)
        first = found.phases[0]
        seen = {t.name: (t, seen_in(first.model, m, first.found.p, t.time, t.name))
                for t, m in zip(found.given.trials, first.found.motions, strict=True)}  # fmt: skip
        figures(out, "A", seen, found.given.noise)
    errors, certificate = found.errors, found.table("certificate")
    worn = errors[errors["quantity"].str.endswith("strap")]
    columns = ["phase", "parameter", "unit", "value", "lower", "upper", "verdict"]
    return {
        "RMSD of the straps [N]": {
            str(site): dict(zip(own["trial"], own["rmsd"].round(3), strict=True))
            for site, own in worn.groupby("quantity", sort=False)
        },
        "parameters": json.loads(found.table("parameters")[columns].to_json(orient="records")),
        "certified": f"{int((certificate['certified'] == 'yes').sum())} of {len(certificate)}",
        "residual [N, N m]": certificate[["residual [N]", "residual [N m]"]].max().tolist(),
        "sentences": list(found.record.sentences),
        "warnings": list(found.record.warnings),
    }


def figures(out: Path, phase: str, trials: dict[str, tuple[Any, Any]], noise: Any) -> None:
    """Those of a phase, of trials as recorded and by the model."""
    from benchmarks.standing.figures import draw
    from geocontact.analyses.sit_to_stand.trial_tables import channels

    time = {name: seen.time for name, (seen, _) in trials.items()}
    curves = {name: channels(seen, model, noise) for name, (seen, model) in trials.items()}
    draw(out, phase, time, curves, {name: seen.name for name, (seen, _) in trials.items()})


def predicted(out: Path, nodes: float) -> dict[str, Any]:
    """C1 and C2 of both trials, as `geocontact sit-to-stand predict` does it with everything given."""
    import numpy as np

    from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
    from geocontact.analyses.sit_to_stand.trial_tables import errors_table
    from geocontact.dynamics.collocation.solve import SolverOptions, refined, solve
    from geocontact.io.recordings.spheres import read_contact_parameters
    from geocontact.standing_up.chain import Subject
    from geocontact.standing_up.exoskeleton import strapped
    from geocontact.standing_up.phase import judged
    from geocontact.standing_up.phases import phase_c
    from geocontact.standing_up.strap_sites import STRAP_SITES, searched
    from geocontact.standing_up.trial_result import TrialResult
    from geocontact.standing_up.trials import seen_in

    study, model = (
        standing_trials(out / "C.toml", "study"),
        strapped(Subject(), STRAP_SITES, seated=True),
    )
    of = model.parameters
    units, bounds = {each.name: each.unit for each in of}, {each.name: (each.least, each.most) for each in of}
    values = read_contact_parameters(out / "study" / "parameters.csv", units, bounds)
    springs = {name for site in STRAP_SITES for name in site.names[:3]}
    rows, shown = [], {}
    for label, factor in (("C1", 1.0), ("C2", PERTURBED)):
        stiffer = [values[each.name] * (factor if each.name in springs else 1.0) for each in of]
        p = searched(of, stiffer)
        for trial in study.trials:
            phase = phase_c(model, study.subject, trial, study.noise, p)
            mesh = np.linspace(0.0, 1.0, round(nodes * float(trial.time[-1])) + 1)
            options = SolverOptions("radau", 4, 1, 1e-7, 300, 60.0)
            found = refined(phase.control, solve(phase.control, options, meshes=(mesh,)), options, model.turning)
            seen = seen_in(model, found.motions[0], p, trial.time, trial.name)
            (told,) = judged(model.stepper, range(6), model.turning, phase, found, certify=found.solved)
            result = TrialResult(
                recorded=trial, model=seen, points=seen, acceleration=np.zeros_like(seen.q), judged=told
            )
            errors = errors_table([result], study.noise, study.tracks).set_index("quantity")["rmsd"]
            certified = told.certificate is not None and told.certificate.converged
            how = {"ending": found.ending, "cpu seconds": round(found.seconds, 2), "certified": certified}
            rows.append({"trial": trial.name, "phase": label, **how, "RMSD": errors.round(3).to_dict()})
            shown[f"{trial.name} {label}"] = (trial, seen)
    figures(out, "C", shown, study.noise)
    return {"factor of C2": PERTURBED, "rows": rows}


def spread(out: Path, nodes: float) -> dict[str, Any]:
    """Parameters without one trial after the other (jackknife), and those of exact recordings of the same trials.

    Exact recordings leave nothing but the model's form: an interval is honest where it holds what they give.
    """
    from dataclasses import replace

    import numpy as np
    from scipy.stats import t as student

    from geocontact.analyses.sit_to_stand.standing_trials import standing_trials

    study = standing_trials(out / "all.toml", "study")
    with np.load(out / "truth.npz") as file:
        truth = {key: file[key] for key in file.files}
    names = ("q", "u", "force", "centre", "torque", "strap")
    exact = [
        replace(
            trial,
            time=truth[f"{trial.name} time"],
            elsewhere={site: truth[f"{trial.name} {site} strap"] for site in trial.elsewhere},
            **{name: truth[f"{trial.name} {name}"][:, :9] if name in "qu" else truth[f"{trial.name} {name}"]
               for name in names},
        )
        for trial in study.trials
    ]  # fmt: skip

    def found(name: str, trials: list[Any]) -> dict[str, dict[str, float]]:
        kept = out / f"spread_{name}.json"
        if not kept.is_file():
            kept.write_text(json.dumps(both_phases(study, trials, nodes)), encoding="utf-8")
            print(kept.name, flush=True)
        return dict(json.loads(kept.read_text("utf-8")))

    whole, of_exact = found("whole", list(study.trials)), found("exact", exact)
    without = [found(f"without_{one.name}", [t for t in study.trials if t is not one]) for one in study.trials]
    count, rows = len(without), []
    reach = float(student.ppf(0.975, count - 1))
    for key, told in whole.items():
        parts = np.array([each[key]["searched"] for each in without])
        sd = float(np.sqrt((count - 1) / count * np.sum((parts - parts.mean()) ** 2)))
        far = abs(of_exact[key]["searched"] - told["searched"])
        rows.append({
            "parameter": key, "value": told["value"], "by exact recordings": of_exact[key]["value"],
            "sd told": told["sd"], "sd over trials": sd,
            "exact within the told 95 %": bool(far <= 1.96 * told["sd"]),
            "exact within the trials' 95 %": bool(far <= reach * np.hypot(sd, 0.0)),
            "exact within both together": bool(far <= 1.96 * told["sd"] + reach * sd),
        })  # fmt: skip
        print(rows[-1], flush=True)
    return {"Student's factor": reach, "rows": rows}


def both_phases(study: Any, trials: Any, nodes: float) -> dict[str, dict[str, float]]:
    """What A and B find without resamples, by name."""
    from geocontact.dynamics.collocation.solve import SolverOptions
    from geocontact.standing_up.calibrated_phase import PhaseSearch, calibrated_phase
    from geocontact.standing_up.chain import FOOT_PARAMETERS
    from geocontact.standing_up.contact_numbers import held_covariance, prior_covariance
    from geocontact.standing_up.exoskeleton import strapped
    from geocontact.standing_up.phases import phase_a, phase_b

    model = strapped(study.subject, study.sites, seated=study.seated)
    search = PhaseSearch(SolverOptions("radau", 4, 1, 1e-7, 300), nodes)
    tracks = tuple(name for name in study.tracks if name not in ("torque", "strap"))

    def build_a(given: Any, start: Any) -> Any:
        return phase_a(model, study.subject, given, study.noise, free=study.free, tracks=tracks, start=start)

    held = [each.name for each in FOOT_PARAMETERS if each.name not in study.free]
    believed = prior_covariance(model.parameters, held)
    first = calibrated_phase("A", model, trials, study.noise, build_a, search, held=believed)
    feet, free = first.found.p[: len(FOOT_PARAMETERS)], [name for site in study.sites for name in site.names]

    def build_b(given: Any, start: Any) -> Any:
        return phase_b(model, study.subject, given, study.noise, feet, free=free, tracks=study.tracks)

    known = held_covariance(first.numbers, first.phase.parameters)
    second, found = calibrated_phase("B", model, trials, study.noise, build_b, search, held=known), {}
    for phase in (first, second):
        if not phase.found.solved:
            raise ArithmeticError(f"phase {phase.name}: {phase.found.ending}")
        for of, number in zip(phase.phase.parameters, phase.numbers.numbers, strict=True):
            if number.verdict in ("known", "prior-dominated"):
                found[number.name] = {"value": number.value, "searched": of.searched(number.value), "sd": number.after}
    return found


if __name__ == "__main__":
    main()
