"""What a strap of one spring is of one of five pads: `python -m benchmarks.standing.form OUT`, after `standing_nine`.

Along the true motions of the nine trials, without noise and without a search for motions, the four numbers of a strap
are fitted to what phase B knows of the pads: the normal force, and what the strap asks of the exoskeleton's hinges,
each in parts of the noise that the study is told. What comes out is what an interval of the calibration can hold at
best; how it changes from trial to trial (jackknife) is the model's form alone. Everything is synthetic.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]


def main() -> None:
    """Fit, compare, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.standing.form", description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path, help="where benchmarks.standing.nine wrote")
    options = parser.parse_args()
    pin()
    import numpy as np
    from scipy.stats import t as student

    from benchmarks.machine import machine, versions
    from benchmarks.standing.nine import HELD_OUT, PASSIVE, SEED
    from geocontact.io.recordings.spheres import read_contact_intervals

    with np.load(options.out / "truth.npz") as file:
        truth = {key: file[key] for key in file.files}
    whole = fitted(truth, PASSIVE)
    without = [fitted(truth, [name for name in PASSIVE if name != one]) for one in PASSIVE]
    assisted = fitted(truth, HELD_OUT)
    told = read_contact_intervals(options.out / "cal" / "parameters.csv", whole)
    count, rows = len(without), []
    reach = float(student.ppf(0.975, count - 1))
    for name, value in whole.items():
        parts = np.array([each[name] for each in without])
        sd = float(np.sqrt((count - 1) / count * np.sum((parts - parts.mean()) ** 2)))
        low, high = told[name]
        low_also, high_also = low - reach * sd, high + reach * sd
        rows.append({
            "parameter": name, "planted": planted()[name], "interval of the calibration": [low, high],
            "one spring, passive trials": value, "inside": low <= value <= high,
            "sd from trial to trial": sd, "interval with it": [low_also, high_also],
            "planted inside with it": low_also <= planted()[name] <= high_also,
            "one spring, assisted trials": assisted[name],
        })  # fmt: skip
    report = {"seed": SEED, "machine": machine(), "versions": versions({"casadi", "numpy", "scipy"}), "rows": rows}
    report |= {"left of the normal force by one spring, passive [N]": left(truth, PASSIVE, whole)}
    text = json.dumps(report, indent=2) + "\n"
    (HERE / "results" / "standing_form.json").write_text(text, encoding="utf-8")
    print(text)


def planted() -> dict[str, float]:
    """Of the pads, where nothing is pressed in."""
    from geocontact.standing_up.exoskeleton import STRAP_PARAMETERS, STRAP_PLANTED

    return {each.name: each.value(float(p)) for each, p in zip(STRAP_PARAMETERS, STRAP_PLANTED, strict=True)}


def asked_by(law: Any) -> Any:
    """Normal force [N], and what a strap asks of the exoskeleton's three hinges [N m], from q, u and its numbers."""
    from casadi import SX, Function, vertcat

    from geocontact.dynamics.inverse_dynamics import generalised_forces
    from geocontact.dynamics.tree import tree_of
    from geocontact.standing_up.chain import Subject
    from geocontact.standing_up.exoskeleton import two_chains

    tree, p = tree_of(two_chains(Subject())), SX.sym("p", 4)
    strap = law(tree, p)
    hinges = generalised_forces(tree, loads=strap.loads) - generalised_forces(tree)
    still = SX.zeros(*tree.a.shape)
    both = vertcat(strap.normal, hinges[6:9, :])
    from casadi import substitute

    return Function("asked", [tree.q, tree.u, p], [substitute(both, tree.a, still)])


def course_of(truth: Any, names: Sequence[str], law: Any, p: Any) -> Any:
    """Over all times of trials: (4, t)."""
    import numpy as np

    q, u = (np.vstack([truth[f"{name} {what}"][:, :9] for name in names]).T for what in "qu")
    return asked_by(law).map(q.shape[1])(q, u, np.tile(np.asarray(p)[:, None], (1, q.shape[1]))).full()


def fitted(truth: Any, names: Sequence[str]) -> dict[str, float]:
    """Numbers of one spring, in SI, by least squares in parts of the noise that is told."""
    import numpy as np
    from scipy.optimize import least_squares

    from benchmarks.standing.nine import TOLD
    from benchmarks.standing.truth import padded_strap
    from geocontact.standing_up.exoskeleton import STRAP_PARAMETERS, STRAP_PLANTED, thigh_strap

    size = np.array([TOLD["strap"][0], *[TOLD["torque"][0]] * 3])[:, None]
    wanted = course_of(truth, names, padded_strap, STRAP_PLANTED)
    q, u = (np.vstack([truth[f"{name} {what}"][:, :9] for name in names]).T for what in "qu")
    one = asked_by(thigh_strap).map(q.shape[1])

    def off(p: Any) -> Any:
        return ((one(q, u, np.tile(p[:, None], (1, q.shape[1]))).full() - wanted) / size).ravel()

    found = least_squares(off, STRAP_PLANTED).x
    return {each.name: each.value(float(p)) for each, p in zip(STRAP_PARAMETERS, found, strict=True)}


def left(truth: Any, names: Sequence[str], values: dict[str, float]) -> float:
    """Root mean square of the normal force that one spring does not have."""
    import numpy as np

    from benchmarks.standing.truth import padded_strap
    from geocontact.standing_up.exoskeleton import STRAP_PARAMETERS, STRAP_PLANTED, thigh_strap
    from geocontact.standing_up.strap_sites import searched

    p = searched(STRAP_PARAMETERS, [values[each.name] for each in STRAP_PARAMETERS])
    both = [course_of(truth, names, law, of)[0] for law, of in ((padded_strap, STRAP_PLANTED), (thigh_strap, p))]
    return float(np.sqrt(np.mean((both[0] - both[1]) ** 2)))


if __name__ == "__main__":
    main()
