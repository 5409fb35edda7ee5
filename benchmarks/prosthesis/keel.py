"""Keel of the variable-stiffness foot: `python -m benchmarks.prosthesis.keel [--rounds 5] [--out FOLDER]`.

Compression against the study's stiffnesses and what it identifies; eight hinges against the elastica; the keel without
inertia against the one with it along a synthetic stance, and the CPU seconds of one core, medians; what torsion gives.
Writes a JSON and three figures. Nothing but the study's stiffnesses and lengths is measured.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
COUNTS = (2, 4, 8, 16, 32, 64, 128)
FORCES = (400.0, 800.0)
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6)
REFERENCE = 1e-8
FINER = (1, 2, 4, 8)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.prosthesis.keel", description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    options.out.mkdir(parents=True, exist_ok=True)
    report = {
        "machine": machine(),
        "versions": versions({"casadi", "numba", "numpy", "scipy"}),
        "compression": compression_table(),
        "elastica": convergence(),
        "without and with inertia": stances(options.rounds),
        "spheres": soles(options.rounds),
        "torsion": torsion(),
    }
    (options.out / "prosthesis_keel.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    figures(report, options.out)
    print(json.dumps(report, indent=2))


def compression_table() -> dict[str, Any]:
    """Both ends' numbers, how far rounding moves them, what is told apart, and simulated tests over the range."""
    import numpy as np

    from geocontact.below_knee_prosthesis.keel.compression import (
        TRAVEL,
        Compressed,
        pressed_sole,
        pressed_tip,
        rounded,
        told_apart,
    )
    from geocontact.below_knee_prosthesis.keel.keel import tip_compliance
    from geocontact.below_knee_prosthesis.keel.sections import SUPPORTS
    from geocontact.below_knee_prosthesis.keel.vsf import SETTINGS, compression, vsf_foot, vsf_keel

    low, high = Compressed(0.066, SETTINGS["low"]), Compressed(0.151, SETTINGS["high"])
    at, gone = np.linspace(low.fulcrum, high.fulcrum, 35), np.array([TRAVEL])
    found: dict[str, Any] = {}
    for support in SUPPORTS:
        fit, keel, foot = compression(support), vsf_keel(support), vsf_foot(support)
        corners = rounded(low, high, keel.length, support, 500.0)
        beam = [fit.stiffness(each) for each in at]
        tip = [pressed_tip(keel, each, fit.series, gone)[0] / TRAVEL for each in at]
        sole = [pressed_sole(foot.keel, each, foot.sole, foot.law, gone)[0] / TRAVEL for each in at]
        ends = [tip_compliance(each.fulcrum, keel.length, 1.0, support) for each in (low, high)]
        medium = [each.fulcrum(SETTINGS["medium"], 0.066, 0.151) for each in (fit, *corners)]
        found[support] = {
            "ratio of the beam alone": ends[0] / ends[1],
            "EI [N m2]": [fit.bending, min(c.bending for c in corners), max(c.bending for c in corners)],
            "series [N/m]": [fit.series, min(c.series for c in corners), max(c.series for c in corners)],
            "medium [m]": [medium[0], min(medium), max(medium)],
            "condition": {
                "EI, series": told_apart(at, fit, share=False).condition,
                "and the end": told_apart(at, fit, share=True).condition,
                "and the plate's place": told_apart(at, fit, share=True, place=True).condition,
            },
            "fulcrum [m]": at.tolist(),
            "beam [N/m]": beam,
            "plate on the tip [N/m]": tip,
            "plate on the sole [N/m]": sole,
            "worst on the tip": float(np.abs(np.divide(tip, beam) - 1.0).max()),
            "worst on the sole": float(np.abs(np.divide(sole, beam) - 1.0).max()),
            "fitted on the sole": {"EI [N m2]": foot.keel.bending, "forefoot [N/m]": float(foot.law.stiffness[-1])},
        }
    return found


def convergence() -> dict[str, Any]:
    """Force of a plate at the elastica's tip, and the largest distance of a hinge from the elastica."""
    import numpy as np
    from scipy.spatial.transform import RigidTransform

    from geocontact.below_knee_prosthesis.keel.keel import elastica
    from geocontact.below_knee_prosthesis.keel.quasi_static import QuasiStaticKeel
    from geocontact.below_knee_prosthesis.keel.sole import KeelSole
    from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_keel
    from geocontact.geometry.shapes import HalfSpace
    from geocontact.loads.sphere_set import SoleLaw, SphereSet

    law, radius = SoleLaw(np.array([1e9]), np.zeros(1), 1.0, 1.0, np.zeros(1), np.zeros(1), 1.0), np.array([1e-9])
    found: dict[str, Any] = {}
    for setting in ("low", "medium", "high"):
        fulcrum = fulcrum_of(setting)
        for force in FORCES:
            bent, rows = elastica(vsf_keel(), fulcrum, force), []
            for count in COUNTS:
                keel = vsf_keel(joints=count)
                tip = SphereSet(np.array([[keel.length, 0.0, 0.0]]), radius, ("tip",))
                pose = RigidTransform.from_translation([[0.0, -bent.y[-1] - force / 1e9, 0.0]])
                one = QuasiStaticKeel(keel, fulcrum, KeelSole(tip, (count,)), law)
                moved = one.solve(pose, HalfSpace(), gravity=(0.0, 0.0, 0.0))
                turn = np.cumsum(moved.angles[0])
                hinges = np.cumsum(np.append(0.0, keel.pitch * np.sin(turn)))[:-1]
                ahead = keel.places > fulcrum
                along = keel.places[0] + np.cumsum(np.append(0.0, keel.pitch * np.cos(turn)))[:-1]
                off = np.abs(hinges - np.interp(along, bent.x, bent.y))[ahead]
                rows.append((abs(moved.force[0, 1] / force - 1.0), float(off.max(initial=0.0))))
            forces, shapes = np.transpose(rows)
            found[f"{setting}, {force:g} N"] = {
                "tip [m]": float(bent.y[-1]),
                "turn [rad]": float(bent.turn[-1]),
                "joints": list(COUNTS),
                "force": forces.tolist(),
                "place [m]": shapes.tolist(),
                "order": float(-np.polyfit(np.log(COUNTS[-3:]), np.log(forces[-3:]), 1)[0]),
            }
    return found


def stances(rounds: int) -> dict[str, Any]:
    """Along a synthetic stance at low, medium and high: what leaving the inertia out, and the rates as well, costs."""
    from benchmarks.prosthesis.keel_stance import LEVEL
    from geocontact.below_knee_prosthesis.keel.dynamic import dynamic_keel
    from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot

    foot = vsf_foot()
    even = replace(foot, law=replace(foot.law, static=foot.law.kinetic))
    started = time.process_time()
    one = dynamic_keel(even.keel, even.sole, even.law, LEVEL)
    built = time.process_time() - started
    both = dynamic_keel(foot.keel, foot.sole, foot.law, LEVEL)
    found: dict[str, Any] = {"making the equations and their step; the compiler's time is not in it [s]": built}
    for setting in ("low", "medium", "high"):
        found[setting] = at_setting(setting, (foot, both), (even, one), rounds)
    return found


def at_setting(setting: str, usual: tuple[Any, Any], even: tuple[Any, Any], rounds: int) -> dict[str, Any]:
    """Of the usual foot and the one with one coefficient of friction, each with its tree."""
    from benchmarks.prosthesis.keel_stance import LEVEL, finer, stance
    from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of

    fulcrum = fulcrum_of(setting)
    still, coarse = even[0].at(fulcrum), stance(even[0], fulcrum)
    dense = finer(coarse, 5)
    exact = dense.rate[::5]
    start = still.solve(coarse.poses, LEVEL, rate=exact, time=coarse.time).angles[0]

    def simulated(foot: Any, model: Any, tolerance: float) -> tuple[Any, int]:
        moved = model.simulate(fulcrum, coarse.time, coarse.poses, start, tolerance=tolerance)
        return foot.at(fulcrum).at(moved.q, moved.u, coarse.poses, LEVEL, exact), moved.steps

    truth, falling = simulated(*even, REFERENCE)[0], simulated(*usual, REFERENCE)[0]
    runs = {
        "elastic": lambda: still.solve(coarse.poses, LEVEL),
        "200 Hz": lambda: still.solve(coarse.poses, LEVEL, rate=exact, time=coarse.time),
        "1000 Hz": lambda: still.solve(dense.poses, LEVEL, rate=dense.rate, time=dense.time),
    }
    told: dict[str, Any] = {n: {**off(run(), truth), "CPU [ms]": 1e3 * seconds(run, rounds)} for n, run in runs.items()}
    told["static friction left out, with inertia"] = off(truth, falling)
    for tolerance in TOLERANCES:
        motion, steps = simulated(*even, tolerance)
        taken = seconds(
            partial(even[1].simulate, fulcrum, coarse.time, coarse.poses, start, tolerance=tolerance), rounds
        )
        told[f"with inertia, {tolerance:g}"] = {**off(motion, truth), "steps": steps, "CPU [ms]": 1e3 * taken}
    return told


def off(motion: Any, reference: Any) -> dict[str, float]:
    """Of the forces, their centre and the angles, at the reference's times."""
    import numpy as np

    from benchmarks.prosthesis.keel_stance import WEIGHT
    from geocontact.loads.centre_of_pressure import centre_of_pressure

    step = (len(motion.angles) - 1) // (len(reference.angles) - 1)
    force = motion.force[::step] - reference.force
    centres = [centre_of_pressure(each.loads, gate=0.05 * WEIGHT).centre[:, 0] for each in (motion, reference)]
    centre = centres[0][::step] - centres[1]
    return {
        "force rms [N]": float(np.sqrt(np.mean(np.sum(force**2, axis=1)))),
        "force worst [N]": float(np.linalg.norm(force, axis=1).max()),
        "upwards rms [% BW]": float(100.0 * np.sqrt(np.mean(force[:, 1] ** 2)) / WEIGHT),
        "centre rms [mm]": float(1e3 * np.sqrt(np.nanmean(centre**2))),
        "angle worst [deg]": float(np.degrees(np.abs(motion.angles[::step] - reference.angles).max())),
    }


def soles(rounds: int) -> dict[str, Any]:
    """More rows of spheres, each sole under the same load: its centre beside that of eight times as many rows."""
    import numpy as np

    from benchmarks.prosthesis.keel_stance import LEVEL, WEIGHT, stance
    from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
    from geocontact.loads.centre_of_pressure import centre_of_pressure

    fulcrum, found, centre = fulcrum_of("medium"), {}, {}
    for finer in FINER:
        foot = vsf_foot(finer=finer)
        one, still = stance(foot, fulcrum), foot.at(fulcrum)
        run = partial(still.solve, one.poses, LEVEL)
        centre[finer] = centre_of_pressure(run().loads, gate=0.05 * WEIGHT).centre[:, 0] - one.poses.translation[:, 0]
        found[finer] = {"spheres": len(foot.sole.spheres), "CPU, elastic [ms]": 1e3 * seconds(run, rounds)}
    for finer, each in found.items():
        away = centre[finer] - centre[FINER[-1]]
        each["centre rms [mm]"] = float(1e3 * np.sqrt(np.nanmean(away**2)))
        each["centre worst [mm]"] = float(1e3 * np.nanmax(np.abs(away)))
    return {str(finer): each for finer, each in found.items()}


def torsion() -> dict[str, Any]:
    """A forefoot rolled by 3 degrees under 800 N, without and with torsion: its centre across, twist and height."""
    from dataclasses import replace

    import numpy as np
    from scipy.spatial.transform import RigidTransform, Rotation

    from benchmarks.prosthesis.keel_stance import LEVEL, heights
    from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
    from geocontact.loads.centre_of_pressure import centre_of_pressure

    turn, found = Rotation.from_euler("zx", np.radians([[-20.0, 3.0]])), {}
    for setting in ("low", "medium", "high"):
        for twisting in (False, True):
            foot = vsf_foot()
            one = replace(foot, keel=replace(foot.keel, twists=twisting)).at(fulcrum_of(setting))
            height = heights(one, turn, np.array([800.0]))
            moved = one.solve(RigidTransform.from_components(height[:, None] * [0.0, 1.0, 0.0], turn), LEVEL)
            found[f"{setting}, {'with' if twisting else 'without'}"] = {
                "force [N]": float(moved.force[0, 1]),
                "height [mm]": 1e3 * float(height[0]),
                "centre across [mm]": float(1e3 * centre_of_pressure(moved.loads, gate=1.0).centre[0, 2]),
                "twist [deg]": float(np.degrees(moved.angles[0, 0])) if twisting else 0.0,
            }
    return found


def seconds(run: Callable[[], Any], rounds: int) -> float:
    """CPU time, median."""
    import numpy as np

    run()
    taken = []
    for _ in range(rounds):
        started = time.process_time()
        run()
        taken.append(time.process_time() - started)
    return float(np.median(taken))


def figures(report: dict[str, Any], out: Path) -> None:
    """Compression, convergence, stance."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(figsize=(6.0, 4.0), layout="constrained")
    for support, colour in (("pinned", "tab:blue"), ("clamped", "tab:orange")):
        one = report["compression"][support]
        at = [1e3 * each for each in one["fulcrum [m]"]]
        for name, style in (("beam [N/m]", "-"), ("plate on the tip [N/m]", "--"), ("plate on the sole [N/m]", ":")):
            axes.plot(at, [1e-3 * each for each in one[name]], style, color=colour, label=f"{support}, {name[:-6]}")
    axes.plot([66.0, 151.0], [10.0, 32.0], "ko", label="measured")
    axes.axhline(19.0, color="0.7", label="measured, fulcrum not told")
    axes.set(xlabel="fulcrum [mm]", ylabel="stiffness in compression [N/mm]")
    axes.legend(fontsize="small")
    figure.savefig(out / "prosthesis_keel_compression.svg")

    figure, axes = plt.subplots(figsize=(6.0, 4.0), layout="constrained")
    for name, one in report["elastica"].items():
        axes.loglog(one["joints"], one["force"], "o-", label=f"{name} (order {one['order']:.2f})")
    axes.axvline(8, color="0.7")
    axes.set(xlabel="joints", ylabel="force at the elastica's tip, relative error")
    axes.legend(fontsize="small")
    figure.savefig(out / "prosthesis_keel_elastica.svg")

    figure, axes = plt.subplots(figsize=(6.0, 4.0), layout="constrained")
    for setting, mark in (("low", "o"), ("medium", "s"), ("high", "^")):
        rows = report["without and with inertia"][setting]
        for name, one in rows.items():
            if "CPU [ms]" in one:
                colour = "tab:orange" if name.startswith("with inertia") else "tab:blue"
                axes.loglog(one["CPU [ms]"], one["force rms [N]"], mark, color=colour)
    axes.loglog([], [], "ko", label="low (o), medium (square), high (triangle)")
    axes.loglog([], [], "s", color="tab:blue", label="without inertia: elastic, 200 Hz, 1000 Hz")
    axes.loglog([], [], "s", color="tab:orange", label="with inertia, tolerances from 1e-3 to 1e-6")
    axes.set(xlabel="CPU time of a stance of 0.7 s [ms]", ylabel="force beside inertia at 1e-8, rms [N]")
    axes.legend(fontsize="small")
    figure.savefig(out / "prosthesis_keel_stance.svg")


if __name__ == "__main__":
    main()
