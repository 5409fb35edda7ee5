"""Figures on the pages are those of the results in the repository."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.dynamics import opensim_tables
from benchmarks.robustness import growth
from geocontact.analyses.catalogue import ENTRIES

ROOT = Path(__file__).resolve().parents[2]
MINUS = "\N{MINUS SIGN}"
LEAST_COVERAGE = 0.88  # of the elbow's intervals of 95 %: 60 to 200 runs tell them to 3 %


def results(name: str) -> Any:
    """JSON of a benchmark."""
    return json.loads((ROOT / "benchmarks" / "results" / f"{name}.json").read_text(encoding="utf-8"))


def rows(page: str) -> list[list[str]]:
    """Cells of every row of every table of a page, indented ones too."""
    lines = (ROOT / "docs" / page).read_text(encoding="utf-8").splitlines()
    return [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines if "|" in line]


def row(page: str, *begin: str) -> list[str]:
    """What follows in the one row that begins so."""
    (found,) = [cells[len(begin) :] for cells in rows(page) if tuple(cells[: len(begin)]) == begin]
    return found


def near(text: str, value: float, scale: float = 1.0) -> bool:
    """Whether a printed number is this one, to its last digit."""
    plain = text.replace(MINUS, "-").replace("%", "").replace("+", "").strip()
    last = 10.0 ** -len(plain.partition(".")[2])
    return abs(float(plain) - scale * value) <= 0.51 * last


def test_coverage_of_the_modulus() -> None:
    page, told = "theory/elastic_identification.md", results("modulus")
    for one in told["coverage"]:
        cells = row(page, str(one["frames"]), f"{one['tau_s']:.2f}")
        assert one["runs"] == 2000
        assert near(cells[0], one["profile likelihood"]) and near(cells[1], one["block bootstrap"]), cells
        assert 0.93 <= one["profile likelihood"] <= 0.97 and 0.93 <= one["block bootstrap"] <= 0.97
    for one in told["coverage_with_more_free"]:
        cells = row(page, one["free"], f"{one['tau_s']:.2f}")
        assert near(cells[0], one["E*"]) and near(cells[1], one[one["free"]]), cells
    assert max(told["noise_free_largest_relative_error"].values()) < 1e-3


def test_the_shoulder_s_study() -> None:
    for one in results("shoulder_study")["rows"]:
        if one["paper"] is not None or one["figure"] == "force, lower: MAE [N]":
            cells = row("theory/shoulder_exoskeleton.md", one["figure"])
            assert near(cells[1], one["ours"]), cells
            assert one["paper"] is None or float(cells[0]) == one["paper"]


def test_the_shoulder_s_planted_effects() -> None:
    for kind, one in results("shoulder_gap")["answers"].items():
        said, _, exo, force, seconds = row("theory/shoulder_exoskeleton.md", kind)
        assert said.startswith(one["verdict"]) and all(name.replace("_", " ") in said for name in one["named"])
        for cell, channel in ((exo, "exo"), (force, "force")):
            assert cell == "-" or near(cell.split("%")[0], one["reduction"][channel][0], 100.0), cell
        assert near(seconds, one["seconds"])


def test_the_shoulder_s_effects_inside_the_full_model() -> None:
    told = results("shoulder_refit")
    for way, label in (("held", "in the plane"), ("free", "free")):
        for kind, one in told[way].items():
            term, _, exo, force = row("theory/shoulder_exoskeleton.md", f"{label}: {kind}")
            after = one[term.partition(":")[0]]
            for cell, name in ((exo, "exo_deg"), (force, "force_N")):
                before_it, after_it = cell.split(" → ")
                assert near(before_it, one["before"][name]) and near(after_it, after[name]), cell


def test_the_prosthetic_foot_s_planted_effects() -> None:
    page, told = "theory/prosthesis_gap.md", results("prosthesis_gap")
    for kind, one in told["answers"].items():
        said, likely, _, force, centre, full, full_centre, seconds = row(page, kind)
        assert said.startswith(one["verdict"]) and all(name.replace("_", " ") in said for name in one["named"])
        assert near(likely, max(one["probabilities"].values())) and near(seconds, one["seconds"])
        for cell, channel in ((force, "force_y"), (centre, "cop_x")):
            assert cell == "-" or near(cell.split("%")[0], one["gap"][channel]["reduction"], 100.0), cell
        for cells, name, scale in ((full, "force_N", 1.0), (full_centre, "centre_m", 1e3)):
            for cell, when in zip(cells.split(" → "), ("before", "after"), strict=True):
                assert near(cell, one["full_model"][when][name], scale), cells
    for kind, off in told["left_out"].items():
        assert all(near(cell, each) for cell, each in zip(row(page, kind), off.values(), strict=True))


def test_the_prosthetic_foot_s_steps_and_soles() -> None:
    page, told = "theory/prosthesis_stance.md", results("prosthesis_stance")["figures"]
    for label in ("1e-3", "3e-4", "1e-4", "1e-5"):
        own = [one for one in told if one["tolerance"] == float(label)]
        assert len(own) == 6
        steps, seconds, rms, most = row(page, label)
        for cell, name in ((steps, "steps"), (seconds, "per_second")):
            ends = [pick(one[name] for one in own) for pick in (min, max)]
            assert all(near(part, end) for part, end in zip(cell.split(" … "), ends, strict=True)), cell
        assert near(rms, max(one["rms"] for one in own), 100.0) and near(most, max(one["most"] for one in own), 100.0)
    for one in results("prosthesis_soles")["figures"]["soles"][:3]:
        _, centre, resultant, first, rise, steps, _ = row(page, str(one["spheres"]))
        assert near(centre.split()[0], one["centre"], 100.0) and near(resultant.split()[0], one["resultant"], 100.0)
        assert near(first.removesuffix("BW"), one["first"], 100.0) and near(rise.removesuffix("BW"), one["rise"])
        assert int(steps) == one["steps"]


def test_foam_beside_spheres() -> None:
    page, told = "theory/prosthesis_stance.md", results("prosthesis_foam")["figures"]
    text = " ".join((ROOT / "docs" / page).read_text(encoding="utf-8").split())
    ends = {}
    for sole in ("foam of 4 mm", "48 spheres"):
        for name in ("force_rms_bw", "centre_rms_share"):
            values = [100.0 * one[sole][name] for one in told.values()]
            ends[sole, name] = f"{min(values):.0f} to {max(values):.0f} %"
    assert f"columns of 4 mm are {ends['foam of 4 mm', 'force_rms_bw']} BW and 1 % of the foot off" in text
    assert ends["foam of 4 mm", "centre_rms_share"] == "1 to 1 %"
    spheres = [ends["48 spheres", name] for name in ("force_rms_bw", "centre_rms_share")]
    assert f"48 spheres {spheres[0]} and {spheres[1]}" in text


def test_the_real_ankle_s_loops_and_the_intact_foot() -> None:
    for kind in ("none", "viscous", "hysteresis", "friction"):
        one, cells = results("desr_hysteresis")["figures"][f"pinned; {kind}"], row("theory/prosthesis_keel.md", kind)
        for cell, name in zip(cells, ("fitted_N_m", "predicted_N_m", "work_off_J"), strict=True):
            assert near(cell.split()[0], one[name]), cell
    names = ("vertical rmse", "vertical plain rmse", "centre rmse", "centre r2", "centre plain rmse")
    for recording, steps in results("prosthesis_intact")["figures"].items():
        for step, one in steps.items():
            if not one["calibrated"]:
                cells = row("theory/prosthesis_both_sides.md", recording, step)
                assert len(cells) == len(names) + 3, "and what brings it nearer"
                for cell, name in zip(cells, names, strict=False):
                    assert near(cell, one[name], 1.0 if name == "centre r2" else 100.0), (recording, step, name)


def test_one_trial_or_one_of_each_setting() -> None:
    page, told = "theory/prosthesis_calibration.md", results("prosthesis_calibration")["figures"]["P1"]
    rows_of = {
        "nothing": ("usual", ""),
        "medium_1": ("medium_1", ""),
        "one of each setting": ("one of each setting", ""),
    }
    rows_of |= {"no model: mean of the others": ("usual", "mean_"), "no model: another setting": ("usual", "another_")}
    for label, (key, kind) in rows_of.items():
        for setting, cell in zip(("low", "medium", "high"), row(page, label), strict=True):
            own = [one for name, one in told[key]["trials"].items() if name.startswith(setting)]
            means = [np.mean([one[curve][f"{kind}rmse"] for one in own]) for curve in ("resultant", "cop_ground")]
            assert all(near(part, float(mean), 100.0) for part, mean in zip(cell.split(", "), means, strict=True)), cell
    assert f"took {told['seconds']:.0f} CPU" in (ROOT / "docs" / page).read_text(encoding="utf-8")


def test_effects_refitted_over_the_whole_stance() -> None:
    for kind, one in results("prosthesis_whole_refit")["figures"].items():
        *_, force, centre = row("theory/prosthesis_gap.md", f"whole: {kind}", *row_of_planted(one))
        for cell, name in ((force, "resultant"), (centre, "cop_ground")):
            told, found, exact = cell.replace("→", " ").replace("(", " ").replace(")", "").split()
            for part, which in ((told, "told"), (found, "found"), (exact, "planted")):
                assert near(part, one["held_out"][which][name], 100.0), (kind, cell)


def row_of_planted(one: dict[str, Any]) -> tuple[str, str, str]:
    """Planted, told and found as the page has them: mm of a length, shares with two digits."""
    length = one["planted"] < 0.1
    values = [one[name] for name in ("planted", "told", "found")]
    return tuple(f"{1e3 * value:.0f} mm" if length else f"{value:.2f}" for value in values)  # type: ignore[return-value]


def test_the_strap_s_planted_effects() -> None:
    page, told = "theory/sit_to_stand_gap.md", results("standing_gap")
    for kind, one in told["answers"].items():
        held_out, said, likely, _, error, full, seconds = row(page, kind)
        assert said.startswith(one["verdict"]) and all(name.replace("_", " ") in said for name in one["named"])
        assert near(likely, max(one["probabilities"].values())) and near(seconds, one["seconds"]["diagnosis"])
        assert error == "-" or near(error.split("%")[0], one["gap"]["thigh_force"]["reduction"], 100.0), error
        term = next(iter(one["full_model"].values()))
        assert int(held_out) == len(term["before"]["solved"]) - 1
        for cell, when in zip(full.split(" → "), ("before", "after"), strict=False):
            assert near(cell, term[when]["mat_N"]), full
    for kind, off in told["left_out"].items():
        cell, said = row(page, kind)
        assert near(cell, off["off_N"]) and said.startswith(off.get("verdict", "-"))


def test_the_shoulder_s_cuff() -> None:
    page, told = "theory/shoulder_exoskeleton.md", results("shoulder_cuff")
    for one in told["trial"]:
        cells = row(page, f"{100 * one['level']:.0f} % {one['cuff']}")
        names = ("elevation_deg", "supporting_N", "most_at_lowering_N", "shear_N", "couple_N_m", "peak_Pa")
        for cell, name in zip(cells, names, strict=False):
            assert cell == "none" or near(cell.split()[0].rstrip("°"), one[name], 1e-3 if name == "peak_Pa" else 1.0)
        assert one["off_at_most_N"] < 0.25
    for one in told["at rest"]:
        pose = f"{one['medial_mm']:.0f}, {one['raising_mm']:.0f} mm, {one['tilt_rad']:.2f} rad"
        cells = dict(zip(("round", "mesh"), row(page, pose)[:2], strict=True))
        for arm, cell in cells.items():
            assert all(
                near(n, f) for n, f in zip(cell.removesuffix(" N").split(", "), one[arm]["force_N"][1:], strict=True)
            )


def test_the_shoulder_s_support() -> None:
    page, told = "theory/shoulder_support.md", results("shoulder_support")
    for setting, one in told["simulated"].items():
        name = setting.replace("%", " %")
        alone, left, plan, exact, taken, pushed, force, rate, wrong = row(page, name)
        for cell, key in (
            (alone, "plan without simulation"),
            (left, "of which is left"),
            (plan, "planned"),
            (exact, "simulated"),
            (taken, "taken away"),
            (wrong, "wrong phase, mean"),
        ):
            assert near(cell, one[key], 100.0), (setting, key, cell)
        assert near(force.split()[0], one["force"]) and near(rate.split()[0], one["rate"])
        assert (pushed == "never") == (one["pushed_up"] == 0.0)
        assert pushed == "never" or near(pushed.split("%")[0], one["pushed_up"], 100.0)
        times = one["share taken away and excess above the reserve [N m]"]
        if setting.startswith("reserve"):
            best, kept = times["times 1.0"]
            assert kept <= 0.0101, "a limit is kept to 0.01 N m"
            others = [each for name, each in times.items() if name != "times 1.0"]
            assert all(share < best or over > 0.05 for share, over in others), "no multiple is better"
    for key, (ours, paper) in told["profiles"]["factors"].items():
        task, hand, phase = key.split()
        *factors, printed = row(page, f"{task}, {hand}")
        k = ("lift", "screw-in", "lower").index(phase)
        assert near(factors[k], ours) and float(printed.split(", ")[k]) == paper
    for name, label in HELD_OUT.items():
        for cell, one in zip(row(page, label), told["profiles"][name].values(), strict=True):
            share, (pushed, sure) = one["reduction"], one["pushed_up"]
            assert cell.startswith(f"{share:.0%}".replace("%", " %"))
            assert ("never" in cell) == (pushed == 0.0) and f"{sure:.1%}".replace("%", " %") in cell, (label, cell)


HELD_OUT = {
    "held out, certainty 95%": "certainty 95 %, by arm weight",
    "held out, reserve 20%": "reserve 20 %, by arm weight",
    "held out, reserve 20%, same factors": "reserve 20 %, same factors",
    "table 3": "table 3",
}
"""Persons held out by what their profile keeps, and the row of the page."""


def test_force_beside_a_refined_mesh() -> None:
    for one in results("pressure")["refinement"]["rows"]:
        cells = row("how-to/pressure.md", f"1e{len(str(one['faces_asked'])) - 1}", one["facets"])
        assert all(near(cell, off, 100.0) for cell, off in zip(cells, one["off_worst_frame"].values(), strict=True))
        if one["facets"] == "smooth":
            assert max(map(abs, one["off_worst_frame"].values())) < 0.01


def test_time_and_error_of_cylinder_fits() -> None:
    ours = [one for one in results("fit")["rows"] if one["fitter"] == "geocontact"]
    assert len(ours) == 9
    for one in ours:
        kind = {"inside": "inside the wall", "another face": "on another face"}.get(one["outliers"], one["outliers"])
        cells = row("theory/fitting.md", f"{one['arc_deg']:.0f}°", kind)
        assert near(cells[0], one["largest_error_m"], 1e3) and near(cells[1], one["seconds"]), (cells, one)
        if one["arc_deg"] == 120.0:
            assert one["largest_error_m"] < 2e-5 and one["seconds"] < 0.7


BOTH = "geocontact, map + clip of both bodies"
FRAMES = "geocontact, all that `area` finds, gap and depth included"
PEERS = {
    "**geocontact, map + clipped area**": "geocontact, map + clip",
    "geocontact, map + refined area with certified bounds": "geocontact, map + refined area with bounds",
    "warp (CPU), bounded to 4 mm + longest edge (area right)": "warp (CPU), bounded to 4 mm + longest edge",
    "warp (CPU), bounded to 4 mm (area 4.5 % wrong)": "warp (CPU), bounded to 4 mm",
    "fcpw, bounded to 4 mm + longest edge": "fcpw, bounded to 4 mm + longest edge",
    "warp (CPU), not bounded *": "warp (CPU), naive",
    "fcpw, not bounded *": "fcpw, naive",
    "libigl AABB *": "libigl AABB",
    "open3d RaycastingScene *": "open3d RaycastingScene",
    "fcl *": "fcl, sphere of no radius",
    "VTK cell locator *": "VTK static cell locator",
    "VTK implicit distance *": "VTK implicit distance",
    "trimesh.closest_point * (600 vertices)": "trimesh.closest_point",
}


def test_speed_beside_other_libraries() -> None:
    report = results("peers-knee")
    told = {one["engine"]: one for one in report["rows"]}
    for label, engine in PEERS.items():
        seconds, ratio, aim, error = row("reference/speed.md", label)
        one = told[engine]
        assert near(seconds, float(np.median(one["cpu_s"]))) and near(ratio, one["ratio_to_ours"]), label
        assert aim == ("" if one["goal"] is None else f"{one['goal']:g}"), label
        assert error == ("reference" if engine == "libigl AABB" else f"{1e3 * one['max_distance_error_m']:.0e}"), label
        assert (one["frames_done"] < report["poses"]) == (" *" in label), label
    loaded = report["peak_memory_MB"][""]
    above = {name: report["peak_memory_MB"][name] - loaded for name in report["peak_memory_MB"]}
    text = (ROOT / "docs/reference/speed.md").read_text(encoding="utf-8")
    assert f"{above['geocontact, map + clip']:.0f} MB above the loaded pair" in " ".join(text.split())
    assert "4.5 % wrong" in text and round(1e3 * told["warp (CPU), bounded to 4 mm"]["relative_area_error"]) == 45


def test_speed_of_the_whole_command() -> None:
    told = results("peers-knee")["whole_command"]
    both, frames = (
        float(np.median(next(one["cpu_s"] for one in told["rows"] if one["engine"] == name))) for name in (BOTH, FRAMES)
    )
    parts = {name: float(np.median(seconds)) for name, seconds in told["parts_cpu_s"].items()}
    parts |= {"**whole command**": float(np.median(told["cpu_s"])), "its frames": frames}
    for label, *cells in rows("reference/speed.md"):
        for name, seconds in parts.items():
            if name != "frames" and label.startswith(name) and len(cells) == 3:
                assert near(cells[0], seconds) and near(cells[1], seconds / both), label
    took = {one["engine"]: float(np.median(one["cpu_s"])) for one in told["rows"]}
    text = " ".join((ROOT / "docs/reference/speed.md").read_text(encoding="utf-8").split())
    libigl, whole = took["libigl AABB"], float(np.median(told["cpu_s"]))
    assert f"libigl took {libigl:.2f} s" in text and f"{libigl / whole:.1f} times as long as the whole command" in text
    fcpw, warp = (took[f"{name}, bounded to 4 mm + longest edge"] for name in ("fcpw", "warp (CPU)"))
    assert f"took {fcpw:.2f} and {warp:.2f} s" in text


def test_start_of_commands() -> None:
    told = results("start")["figures"]
    text = " ".join((ROOT / "docs/reference/speed.md").read_text(encoding="utf-8").split())
    least, most = (choose(told["commands"], key=lambda each: told["commands"][each]["cpu_s"]) for choose in (min, max))
    took, alone = ([f"{told['commands'][each][key]:.2f}" for each in (least, most)] for key in ("cpu_s", "floor_s"))
    assert f"take {took[0]} (`{least}`) to {took[1]} CPU s (`{most}`)" in text
    assert f"heavy packages alone {alone[0]} and {alone[1]}" in text
    missed = any(each["cpu_s"] > told["aim_s"] for each in told["commands"].values())
    assert (f"the aim of {told['aim_s']:g} s is missed" in text) == missed


def test_a_frame_of_a_long_run() -> None:
    told = results("long_run")
    text = " ".join((ROOT / "docs/reference/speed.md").read_text(encoding="utf-8").split())
    figures, aim = told["figures"], told["figures"]["aim_ms_a_frame"]
    assert told["asked"]["frames"] >= 300 and len(figures["ms_a_frame"]) >= 3
    assert f"A frame of a long run takes {figures['least_ms_a_frame']:.0f} CPU ms" in text
    assert (f"the aim of {aim:.0f} ms is missed" in text) == (figures["least_ms_a_frame"] > aim)
    beside = results("long_run_peers")
    libigl, open3d, warp = (
        next(row for name, row in beside["figures"]["rows"].items() if name.startswith(peer))
        for peer in ("libigl", "open3d", "warp")
    )
    both = [f"{each['ratio_to_map_and_clip']:.0f}" for each in (libigl, open3d)]
    assert f"1001 frames of the pair above (`--peers`): libigl and open3d take {both[0]} and {both[1]} times" in text
    assert beside["asked"]["frames"] == 1001 and warp["met"] and not libigl["met"] and not open3d["met"]
    assert f"{libigl['ratio']:.1f} and {open3d['ratio']:.1f} times all that `area` finds" in text
    assert f"bounded warp {warp['ratio']:.1f} times" in text
    most = max(row["largest_area_difference_percent"] for row in beside["figures"]["rows"].values())
    assert f"areas agree to {most:.2f} %" in text


def test_memory_of_large_meshes() -> None:
    told = results("large_meshes")["figures"]
    text = " ".join((ROOT / "docs/reference/speed.md").read_text(encoding="utf-8").split())
    assert f"{told['faces']:,}".replace(",", " ") + " faces each" in text
    assert f"takes {told['peak_MB'] / 1e3:.1f} GB and {told['cpu_s']:.0f} CPU seconds" in text
    worst = max(abs(told[f"relative_error_{body}"]) for body in ("moving", "fixed"))
    assert f"off by {worst:.0e} at most" in text
    each = told["held"]["bytes_each_face"]
    assert each["all"] == pytest.approx(sum(size for name, size in each.items() if name != "all"), abs=0.2)
    said = f"{each['all']:.0f} bytes a face, {each['BoxTree.leaves']:.0f} of them triangles in the leaves of the trees"
    assert f"{said}, {2e-9 * told['faces'] * each['all']:.2f} GB in all" in text
    (program,) = (one["runs"][0]["peak_mb"] for one in results("growth")["figures"] if one["command"] == "area")
    assert f"the program takes {1e-3 * program:.2f} GB" in text


def test_accuracy_against_closed_forms() -> None:
    told = {(one["case"], one["rule"]): one for one in results("accuracy")["rows"] if one["surface"] == "moving"}
    pairs = {"ball over plane": "sphere on plane", "ball over ball": "sphere on sphere", "ball in cup": "sphere in cup"}
    for label, case in pairs.items():
        error, order, extrapolated, *crude = row("reference/accuracy.md", label)
        refined = told[case, "refined"]
        assert refined["faces"][-1] == 81920
        assert near(error, refined["relative_error"][-1], 100.0) and near(order, refined["order"]), label
        assert near(extrapolated, refined["richardson"], 100.0), label
        for cell, rule in zip(crude, ("all-vertices", "any-vertex", "centroid"), strict=True):
            assert near(cell, told[case, rule]["relative_error"][-1], 100.0), (label, rule)


def test_congruence_of_balls_and_of_two_people() -> None:
    """Within a percent of 1/r1 ± 1/r2 where a vertex is known exactly; what noise makes of it stands there as it is."""
    told = results("congruence")
    for name in {one["case"] for one in told["known"]}:
        for noise in (0.0, 0.05):
            own = [one for one in told["known"] if (one["case"], one["noise_mm"]) == (name, noise)]
            true, *shown = row("theory/contact_area.md", name, f"{noise:g}")
            assert near(true, own[0]["true_per_mm"])
            assert all(near(text, one["index_per_mm"]) for text, one in zip(shown, own, strict=True)), shown
            if not noise:
                r = {one["radius_mm"]: one["index_per_mm"] for one in own}
                assert abs(r[2.0] - own[0]["true_per_mm"]) < 0.01 * own[0]["true_per_mm"] + 2e-5
    keys = (*(f"relative_curvature_{end}_per_mm" for end in ("min", "max")), "index_per_mm")
    text = " ".join((ROOT / "docs/reference/real_implants.md").read_text(encoding="utf-8").split())
    for one in told["ankles"]:
        who = f"{one['person']}, {one['frames']} frames"
        cells = row("reference/real_implants.md", who, f"{one['radius_mm']:g} mm")
        words = re.search(rf"{one['person']}: area (.*?) mm², least distance (.*?) mm, .*? index (.*?\))", text)
        assert words, one["person"]
        alike = zip(words.groups(), ("area_mm2", "least_distance_mm", "share"), strict=True)
        for cell, key in [*zip(cells, keys, strict=True), *alike]:
            shown = cell.replace("(", "").replace(")", "").replace("…", "").split()
            assert all(near(part, value) for part, value in zip(shown, one[key], strict=True)), cell


def test_what_was_withheld_from_the_knee() -> None:
    names = {"tx_1mm": "1 mm in tx", "ty_1mm": "1 mm in ty", "tz_1mm": "1 mm in tz", "crosstalk": "6 % of PM in AM"}
    cases = results("knee_chain")["runs"]["sample, truth coarse, seed 1"]["cases"]
    for name, words in names.items():
        one = cases[name]
        cells = next(each[1:] for each in rows("how-to/knee_chain.md") if each[0] == words)
        assert cells[0].startswith(one["effects"][0])
        for printed, told in zip(cells[4].split(), one["reduction"].values(), strict=True):
            assert near(printed, told[0]), (cells, told)
        for printed, true in zip(cells[5].split(), one["true_reduction"].values(), strict=True):
            assert near(printed, true), (cells, true)


def test_mats() -> None:
    page, told = "how-to/mat.md", results("mats")
    for label, key in (
        ("tree and neighbours", "tree and neighbours [s]"),
        ("laying the mat", "laying [s]"),
        ("mapping cells and faces", "mapping [s]"),
        ("wrench of all frames", "wrench of all frames [s]"),
        ("largest memory of the process", "memory at most [MB]"),
    ):
        assert near(row(page, label)[0].rpartition(" ")[0], told["speed"][key])
    whole = "the whole command: reading, filter, dead cells, projection beside, tables, figure, page"
    for label, key in ((whole, "seconds"), ("largest memory of the command", "memory at most [MB]")):
        assert near(row(page, label)[0].rpartition(" ")[0], told["command"][key])
    scan = told["registration"]["scan 1 mm and 2 deg off"]
    exact, off = told["registration"]["landmarks exact, largest"], told["registration"]["1 mm and 2 deg off"]
    for label, key in (
        ("force", "force [%]"),
        ("moment, over force × 0.1 m", "moment [% of force x 0.1 m]"),
        ("centre of pressure", "centre [mm]"),
    ):
        shown = [cell.rpartition(" ")[0] for cell in row(page, label)]
        values = (exact[key], off[key]["mean"], off[key]["95 %"], scan[key]["mean"], scan[key]["95 %"])
        assert all(near(text, value) for text, value in zip(shown, values, strict=True))


def test_gaps_of_real_recordings() -> None:
    """Every row of the page's tables; rows of one name are told apart by the section they stand in."""
    units = {"force_medial": 1.0, "force_lateral": 1.0, "force_x": 1.0, "force_y": 1.0, "cop_x": 1e3}
    text = (ROOT / "docs" / "reference" / "gap_real_data.md").read_text(encoding="utf-8")
    sections = {"knee": "## Knee", "overground": "### Overground", "treadmill": "### Treadmill"}
    for subject, variants in results("real_gaps")["cases"].items():
        part = text.partition(sections[subject])[2].partition("\n## " if subject == "knee" else "\n##")[0]
        shown = [[cell.strip() for cell in line.strip("|").split("|")] for line in part.splitlines() if "|" in line]
        for name, said in variants.items():
            (cells,) = [each[1:] for each in shown if each[0] == name]
            assert cells[0] == said["verdict"] and near(cells[1], said["probabilities"].get("unknown", 0.0))
            words = " ".join(part.split())
            assert all(f"row names `{effect}`" in words for effect in said["effects"])
            for k, (channel, gap) in enumerate(said["gap"].items()):
                errors = zip(cells[2 + k].split(", "), (gap["rmse_before"], gap["noise_floor"]), strict=True)
                assert all(near(text, value, units[channel]) for text, value in errors), (name, channel)
                assert said["effects"] or gap["reduction"] == 0.0
                if said["effects"]:
                    taken = re.search(rf"(\S+) \((\S+) … (\S+)\) (?:of the error )?of {channel}", words)
                    assert taken and all(map(near, taken.groups(), (gap["reduction"], *gap["ci95"]))), (name, channel)
    belt = results("real_gaps")["cases"]["treadmill"]["as stated"]["made"]["belt_m_per_s"]
    assert f"the belt runs at {belt:.2f} m/s" in text


def test_detectability_and_the_next_experiment() -> None:
    page = "reference/gap_benchmark.md"
    for name, hits, count in (
        ("gap_detectability", "right", "statements"),
        ("gap_next_experiment", "raised", "proposals"),
    ):
        told = results(name)
        one, cells = told["all"], row(page, f"all, {name}")
        assert [each[0] for each in rows(page) if each[0].endswith(name)] == [f"all, {name}"], "by system: the results"
        share, _, interval = cells[0].partition(" [")
        assert share == f"{one[hits]} of {one[count]}", cells
        ends = interval.strip("]% ").split(",")
        assert all(near(text, end, 100.0) for text, end in zip(ends, one["interval"], strict=True)), cells
        assert cells[1] == str(one["cases"])
        assert cells[2:] == (seen(told["rows"]) if name == "gap_detectability" else unproposed(told["rows"]))
        versions = {run["version"] for run in told["runs"]}
        assert len(versions) == 1, "figures of several versions are added up"


def test_the_promise_of_the_next_experiment_is_kept() -> None:
    text = " ".join((ROOT / "docs" / "reference/gap_benchmark.md").read_text(encoding="utf-8").split())
    told = results("gap_next_experiment_closed")["all"]
    said = (
        f"{told['proposals']} proposals promised {told['promised']:.0%}, in {told['kept']:.0%} of {told['repetitions']}"
    )
    assert said.replace("%", " %") in text
    assert abs(told["kept"] - told["promised"]) <= 0.1


def seen(own: list[dict[str, Any]]) -> list[str]:
    """How many of how many simulations were seen, at each amplitude."""
    at = [[each["seen"] for each in own if each["times"] == times] for times in (0.5, 1.0, 1.5)]
    return [f"{sum(some)} of {len(some)}" for some in at]


def unproposed(own: list[dict[str, Any]]) -> list[str]:
    """Cases with one answer left or none, and cases with several for which nothing is proposed."""
    without = [len(each["in_question"]) > 1 for each in own if "raised" not in each]
    return [str(without.count(False)), str(without.count(True))]


def test_time_and_coverage_of_the_elbow() -> None:
    page, told = "theory/elbow_misalignment.md", results("elbow")
    for one in told["fit"]:
        cells = row(page, one["numbers"], one["bins"])
        assert int(cells[0]) == one["means"] and near(cells[1], one["milliseconds"]) and one["milliseconds"] < 5.0
        assert near(cells[2], one["milliseconds_whole"])
    for one in told["coverage"]:
        cells = row(page, one["case"])
        assert int(cells[0]) == one["runs"]
        for cell, kind in zip(cells[1:], ("profile likelihood", "wild bootstrap"), strict=True):
            shown = dict(part.split() for part in cell.split(", "))
            assert set(shown) == set(one[kind]) and all(near(shown[n], one[kind][n]) for n in shown), cells
    free = told["scale free"]
    runs, by_profile, by_parts, signs = row(page, free["case"])
    assert int(runs) == free["runs"] and near(signs, free["sign of x not told"])
    for cell, kind in ((by_profile, "profile likelihood"), (by_parts, "one of its parts")):
        shown = dict(part.split() for part in cell.split(", "))
        assert set(shown) == set(free[kind]) and all(near(shown[n], free[kind][n]) for n in shown)
        assert min(free[kind].values()) >= LEAST_COVERAGE
    for one in told["scale by the free joint"]:
        cells = row(page, f"{one['donning_sd_mm']:.0f}", str(one["runs"]))
        keys = ("profile likelihood", "median width", "sd of k", "sd of k by the slope of the locked force")
        assert all(near(cell, one[key]) for cell, key in zip(cells, keys, strict=True))
    assert told["scale by the free joint"][0]["profile likelihood"] >= LEAST_COVERAGE
    known, prior, _ = told["coverage"]
    for one in (known, prior):
        assert min(*one["profile likelihood"].values(), *one["wild bootstrap"].values()) >= LEAST_COVERAGE


def test_largest_forces_of_a_population() -> None:
    page, told = "how-to/elbow_design.md", results("elbow_population")
    for one in told["convergence"]:
        cells = row(page, f"{one['step_deg']:.0f}°")
        keys = ("largest_error_N", "rms_error_N", "grid_only_largest_error_N", "grid_only_rms_error_N")
        assert cells == [f"{one[key]:.1e}" for key in keys]
    for one in told["drawing"]:
        cells = row(page, str(one["people"]))
        assert cells == [f"{one[key]:.2f}" for key in ("quantile_N", "lower_N", "upper_N")]
    text, speed = (ROOT / "docs" / page).read_text(encoding="utf-8"), told["speed"]
    assert f"{speed['samples_per_second'] / 1e6:.2f} million people per second" in text
    assert (
        f"without refinement {speed['numpy_samples_per_second'] / 1e6:.2f} million, ratio {speed['ratio']:.1f}" in text
    )
    assert f"{speed['samples_per_second_at_8_deg'] / 1e6:.2f} million, ratio {speed['ratio_at_8_deg']:.1f} to" in text
    assert speed["samples_per_second"] > 2e5, "a million people in seconds"
    assert told["convergence"][0]["largest_error_N"] < told["convergence"][-1]["grid_only_largest_error_N"]


def test_published_models_beside_opensim() -> None:
    """The table as the JSON has it; each model within its bound or refused, but for what the page says."""
    lines = (ROOT / "docs" / "reference" / "opensim_models.md").read_text(encoding="utf-8").splitlines()
    assert set(opensim_tables.summary()) <= set(lines)
    fits = [one for one in results("opensim_setups")["set-ups"] if "sum_over_opensims" in one]
    larger, frames = (sum(one[key] for one in fits) for key in ("frames_with_larger_sum", "frames"))
    assert f"({larger} of {frames} frames)" in " ".join(" ".join(lines).split())
    for one in results("opensim_packages")["models"]:
        exact = {**one, **one.get("rewritten", {})}
        assert "failed" not in one and exact["scaled_off"] < 1e-6 and exact["bodies_apart_mm"] < 0.01
        assert exact["forces_off_share"] < 0.01 and one.get("angles_off_deg", 0.0) < 0.1
        assert exact["forces_off_share"] < 1e-9 or one["lagrange"]["ours"] < 1e-12
    for one in results("opensim_setups")["set-ups"]:
        assert "refused" not in one and one.get("scaled_off", 0.0) < 1e-6 and one.get("sum_over_opensims", 0.0) < 1.0
        assert one.get("forces_off_share", 0.0) < 0.01 or "forces_not_read" in one


def test_bodies_on_joints_beside_their_peers() -> None:
    page, told = "theory/multibody.md", results("multibody")
    fast, versions = told["inverse kinematics"], told["versions"]
    ours, theirs = (float(np.median(fast[key])) for key in ("frames_per_second", "opensim_frames_per_second"))
    assert ours > 1000.0 and fast["angle_difference_rms_deg"] < 0.1
    assert near(row(page, "geocontact")[0], ours)
    cells = row(page, f"OpenSim {versions['opensim']}, its solver at the tool's accuracy")
    assert near(cells[0], theirs) and near(cells[1], ours / theirs)
    for peer, package in (("MuJoCo", "mujoco"), ("Pinocchio", "pin")):
        off = told["inverse dynamics"][f"largest_difference_to_{peer.lower()}"]
        assert row(page, f"{peer} {versions[package]}") == [f"{off:.1e}"] and off < 1e-12
    for one in told["forward dynamics"]:
        cells = row(page, f"{one['tolerance']:.0e}")
        assert cells[0] == f"{one['steps']} ({one['refused']})" and cells[1] == f"{one['error_mm']:.1e}"
        speeds = [one["times_real_time"][name] for name in ("machine code", "CasADi")]
        assert all(near(cell, speed) for cell, speed in zip(cells[2:], speeds, strict=True))
    errors = [one["error_mm"] for one in told["forward dynamics"]]
    assert errors == sorted(errors, reverse=True)


BENCHMARK = {
    "false alarms": "false_alarms",
    "right effect first, where visible": "first_right",
    "truth in a set of ≤ 3, where visible": "in_small_set",
    "visible, called no gap": "missed",
    "confidently wrong": "confidently_wrong",
    "both of two found": "both_found",
    "at least one of two in question": "one_of_two",
    "outside the table, called unknown": "unknown_called",
    "absorbed recognised": "absorbed_recognised",
    "true reduction inside ci95": "coverage",
}
README = {
    "ranked first in {} |": "first_right",
    "The effect is named in {},": "named_right",
    "confidently wrong in {}:": "confidently_wrong",
    "both of two effects in {};": "both_found",
    "does not know? | {}; it mostly called the others": "unknown_called",
    "| {} inside their intervals": "coverage",
}
"""A figure a row of its table, and what stands below it."""


def share(one: dict[str, Any]) -> str:
    """Hits of a count, as the tables print it."""
    return f"{one['hits']}/{one['count']}"


def with_interval(one: dict[str, Any]) -> str:
    """The same with the exact interval in per cent."""
    low, high = one["ci95"]
    return f"{share(one)} [{100 * low:.1f}, {100 * high:.1f}]"


def test_the_benchmark_of_the_diagnosis() -> None:
    """One table: pooled with intervals, every system, the regression; enough cases."""
    page, told = "reference/gap_benchmark.md", results("gap_benchmark")
    figures, systems = told["figures"], ("pooled", "elbow", "foot", "shoulder", "knee", "sit_to_stand")
    for label, key in BENCHMARK.items():
        begin = [label, told["bars"].get(key, "")]
        ((pooled, *cells),) = [each[2:] for each in rows(page) if each[:2] == begin and len(each) == 10]
        assert pooled == with_interval(figures["pooled"]["diagnosis"][key]), label
        assert cells[:5] == [share(figures[each]["diagnosis"][key]) for each in systems[1:]], label
        if key != "one_of_two":
            whose = ("regression", "regression_aware")
            assert cells[5:] == [share(figures["pooled"][who][key]) for who in whose], label
    for cell, system in zip(row(page, "error of reduction, mean")[1:], systems, strict=False):
        assert near(cell, figures[system]["diagnosis"]["reduction_error"])
    for cell, system in zip(row(page, "mean error of stated probabilities")[1:], systems, strict=False):
        assert near(cell, figures[system]["diagnosis"]["calibration_error"])
    for cell, system in zip(row(page, "seconds of one core, mean (most)")[1:], systems, strict=False):
        assert near(cell.partition(" ")[0], told["cpu_seconds"][system]["mean"])
    for system in systems[1:]:
        assert figures[system]["diagnosis"]["false_alarms"]["count"] >= 100
        assert figures[system]["diagnosis"]["first_right"]["count"] >= 60
    assert told["seed"] == 20261145 and "seed 20261145" in (ROOT / "docs" / page).read_text(encoding="utf-8")


LABORATORIES = {
    "false alarms": "false_alarms",
    "– with p ≥ 0.9": "sure_alarms",
    "effects of 5 % and more: named, or their class": "large_named",
    "– named wrongly": "large_wrong",
    "effects of 1 to 5 %: named or detected": "small_detected",
    "pairs of 5 % and more: both": "pair_both",
    "– one right": "pair_one",
    "– no wrong name": "pair_no_wrong",
    "outside the table, 5 % and more: unknown or partly explained": "strange_unknown",
    "outside the table or nothing missing: something named": "strange_wrong",
    "shares of effects inside ci95, where named right": "budget_inside",
    "budgets that close to 1 ± 0.02": "budget_closed",
    "effects ahead by 3 nats, of these first": "first_ahead",
    "right effect first, all visible": "first_right",
    "called no gap, all visible": "missed",
    "confidently wrong, all cases": "confidently_wrong",
    "reductions inside ci95": "coverage",
}
BESIDE = ("false_alarms", "large_named", "large_wrong", "pair_both", "coverage")
"""Figures of the run at home and of the regressions, in the order of the page."""
LABORATORY_NUMBERS = {
    "mean error of a reduction": "reduction_error",
    "CPU seconds per case, median": "seconds_median",
    "– most": "seconds_most",
}


def test_kinds_of_laboratories() -> None:
    """Two runs on fresh kinds and the table of the README; those of few or of all cases stand without an interval.

    By-system figures of a few cases each are in the result file only.
    """
    name = "reference/gap_benchmark.md"
    page = " ".join((ROOT / "docs" / name).read_text(encoding="utf-8").split())
    runs = [results(f"gap_laboratories_fresh_{k}") for k in (5, 6)]
    tables = {each[0]: each[2:] for each in rows(name) if len(each) == 4}
    for run, place in zip(runs, (0, 1), strict=True):
        shares, numbers = run["figures"]["all"]["shares"], run["figures"]["all"]["numbers"]
        for label, key in LABORATORIES.items():
            bare = not place or shares[key]["count"] < 10 or shares[key]["hits"] == shares[key]["count"]
            assert tables[label][place] == (share if bare else with_interval)(shares[key]), label
        for label, key in LABORATORY_NUMBERS.items():
            assert tables[label][place] == f"{numbers[key]:.3g}", label
        assert f"seed {run['asked']['seed']}, commit {run['commit']} (" in page
    home = results("gap_laboratories_home_5")
    own = [share(home["figures"]["all"]["shares"][key]) for key in BESIDE]
    begin = f"(seed {home['asked']['seed']}, commit {home['commit']}, `gap_laboratories_home_5.json`): "
    words = "false alarms {}, named {}, wrongly {}, both {}, reductions {}; no better."
    assert begin + words.format(*own) in page
    beside = results("gap_laboratories_fresh_6_regression")
    assert beside["asked"] == run["asked"]
    pairs = [
        [share(beside["figures"][who]["shares"][key]) for who in ("regression", "regression_aware")]
        for key in (*BESIDE, "pair_one")
    ]
    assert "; ".join(", ".join(pair) for pair in pairs[:-1]) + "." in page
    assert f"more often: {', '.join(pairs[-1])}." in page
    readme = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    for words, key in README.items():
        assert words.format(f"{shares[key]['hits']} of {shares[key]['count']}") in readme, words
    alarms = shares["false_alarms"]
    assert f"| {alarms['count'] - alarms['hits']} of {alarms['count']} cases without an effect |" in readme
    assert f"{run['figures']['all']['cases']} simulated cases of five systems" in readme
    assert f"(version {run['commit']})" in readme


def test_every_case_of_the_benchmark_is_kept() -> None:
    """What is counted in the file of cases is what the figures say."""
    file = ROOT / "benchmarks" / "results" / "gap_benchmark_cases.csv"
    every = list(csv.DictReader(file.read_text(encoding="utf-8").splitlines()))
    told = results("gap_benchmark")["figures"]["pooled"]["diagnosis"]
    alarms = [one["verdict"] != "no_gap" for one in every if one["kind"] == "none"]
    assert (sum(alarms), len(alarms)) == (told["false_alarms"]["hits"], told["false_alarms"]["count"])
    wrong = [one["confidently_wrong"] == "True" for one in every]
    assert (sum(wrong), len(wrong)) == (told["confidently_wrong"]["hits"], told["confidently_wrong"]["count"])


def test_what_is_attainable() -> None:
    """Of cases and answers of one run of the diagnosis, which the page names."""
    told, systems = results("gap_attainable"), ("elbow", "foot", "shoulder", "knee", "sit_to_stand")
    page = (ROOT / "docs" / "reference/gap_benchmark.md").read_text(encoding="utf-8")
    assert f"benchmarks.gap.attainable --seed {told['seed']} " in page and f"seed {told['seed']}, commit" in page
    shares = [told["all"], *(told["systems"][system] for system in systems)]
    cells = row("reference/gap_benchmark.md", "attainable for who knows the noise")
    assert cells == [f"{100.0 * s['attainable']:.0f} %" for s in shares]
    rows = {"ahead": "own candidate ahead", "hardly": "within 3 nats of the best other", "behind": "another ahead"}
    for key, label in rows.items():
        whole = label + (" by 3 nats or more" if key != "hardly" else "")
        assert row("reference/gap_benchmark.md", whole) == [f"{s[key]['hits']}/{s[key]['count']}" for s in shares]
        first = f"{label.split()[0] if key == 'hardly' else key}, and ranked first"
        assert row("reference/gap_benchmark.md", first) == [f"{s[key]['ranked_first']}/{s[key]['of']}" for s in shares]
    left = [one["own"] / one["base"] for one in told["rows"]]
    assert round(100.0 * float(np.median(left))) == 4 and round(100.0 * float(np.quantile(left, 0.9))) == 13


def test_the_nine_trials_of_standing_up() -> None:
    told, page = results("standing_nine"), "theory/sit_to_stand.md"
    kinds = (
        ("C1", "all given", "C1, all given"),
        ("C1", "without ground reaction", "without ground reaction"),
        ("C1", "without torques", "without torques"),
        ("C2", "all given", "C2, all given"),
        ("C1", "mean of the calibration", "mean of the calibration"),
    )
    for phase, predictor, label in kinds:
        ours = [one for one in told[phase]["rows"] if one["predictor"] == predictor]
        (cells,) = [row[1:] for row in rows(page) if row[0] == label and len(row) == 7]
        for cell, one in zip(cells, ours, strict=True):
            strap, angle = cell.replace("°", "").replace(" N", "").split(", ")
            assert near(strap, one["strap [N]"]) and near(angle, max(one["angles [deg]"][:3])), (label, cell)
            assert one.get("certified", True), (label, one["trial"])
    assert max(told["pipelines"]["largest residual of the truth [N, N m]"]) < 1.0


def test_damaged_files_and_faults() -> None:
    page, damaged, faults = "reference/durability.md", results("mutated_files")["figures"], results("faults")["figures"]
    assert damaged["files"] >= 10_000 and damaged["bad"] == 0
    words = ("refused", "warned", "read", "unchanged")
    readers = damaged["readers"].values()  # counts of each reader are in the file of results only
    assert sum(sum(counts.values()) for counts in readers) == damaged["files"]
    assert row(page, "all") == [str(each) for each in (damaged["files"], *map(damaged["outcomes"].get, words), 0)]
    _, _, alike = (ROOT / "docs" / page).read_text(encoding="utf-8").partition("the same tables, with: ")
    names = " ".join(alike.partition(".\n")[0].split()).split("; ")
    assert set(names) == {name for name, found in faults.items() if found["code"] == 0}
    for name, found in faults.items():
        assert found["right"] and (name in names or row(page, name)[0] == str(found["code"]))


def test_the_plan_of_a_large_study() -> None:
    """Every row of the simulation that the page has, and what a trial costs."""
    page, told = "reference/large_study.md", results("cohort_plan")
    figures, trials = told["figures"], told["asked"]["trials"]
    trial, study = figures["trial"], figures["study"]
    measured = {
        f"`area`, the shipped knee, {trial['frames']} frames": (trial["cpu_seconds"], 1 / 3600.0),
        "`gap diagnose`, mean of the 1000 benchmark cases": (figures["diagnosis_cpu_seconds"], 1 / 3600.0),
        "results of `area` on disk, pages among them": (trial["bytes"] / 1e6, 1e-3),
        "of these, tables": (trial["bytes_of_tables"] / 1e3, 1e-6),
        "the study's own process, first run": (study["first_ms"], 1e-3 / 60.0),
        "the same, when all is there already": (study["again_ms"], 1e-3 / 60.0),
        "its memory": (study["memory_bytes"] / 1e3, 1e-6),
    }
    for label, (value, scale) in measured.items():
        one, every = (cell.partition(" ")[0] for cell in row(page, label))
        assert near(one, value) and near(every, value, scale * trials), label
    simulated = [cells for cells in rows(page) if len(cells) == 7 and cells[0] in ("area", "gap diagnose")]
    assert [cells[1] for cells in simulated] == ["usual", "rough"] * 2 and trials == 100_000
    for analysis, scenario, hours, used, lost, *counts in simulated:
        own = figures[f"{analysis}, {scenario}, 64"]
        for cell, key in ((hours, "hours"), (lost, "lost_cpu_hours")):
            assert all(map(near, cell.replace("(", "").replace(")", "").replace("… ", "").split(), own[key])), cell
        assert near(used, own["share"][0], 100.0)
        keys = ("set_aside", "set_aside_innocent")
        assert all(near(cell, own[key][0]) for cell, key in zip(counts, keys, strict=True)), counts
    assert max(figures[key]["set_aside_innocent"][0] for key in figures if ", " in key) < 1.0


def test_speed_of_a_diagnosis() -> None:
    """Of the version measured last; what was before it stands in its own file of results."""
    now = results("gap_speed")["figures"]
    cases = now["cases_cpu_s"]
    for system in {name.rpartition("_")[0] for name in cases}:
        cells = [cell.split(", ") for cell in row("reference/speed.md", f"`{system}`")]
        for cell, part in zip(cells, ("all", "search for noise", "simulations"), strict=True):
            told = [cases[f"{system}_{number}"][part] for number in ("01", "02")]
            assert all(map(near, cell, told)) and len(cell) == 2, (system, part)
    took = [own["all"] for own in cases.values()]
    assert len(took) == 10 and max(took) == now["most_cpu_s"]
    assert abs(np.median(took) - now["median_cpu_s"]) < 0.005
    text = " ".join((ROOT / "docs/reference/speed.md").read_text(encoding="utf-8").split())
    assert f"median is {now['median_cpu_s']:.2f} s" in text and f"the most {now['most_cpu_s']:.2f} s" in text


def test_growth_of_a_diagnosis() -> None:
    """What the page has of movements recorded quicker and longer, and the slopes of logarithms derived again."""
    text = " ".join((ROOT / "docs/reference/speed.md").read_text(encoding="utf-8").split())
    took: dict[str, str] = {}
    slopes = {}
    for own in results("gap_growth")["figures"]:
        n, seconds, peak = np.array([(run["n"], run["cpu_s"], run["peak_mb"]) for run in own["runs"]]).T
        name = f"{own['system']} {own['growth']}"
        assert list(n) == ([2_000, 100_000] if own["system"] == "foot" else [2_000, 10_000, 100_000])
        x, y = np.log(n), np.log(seconds)
        slopes[name] = ((x - x.mean()) @ (y - y.mean())) / ((x - x.mean()) @ (x - x.mean()))
        assert own["cpu_slope"] == pytest.approx(slopes[name], abs=1e-9)
        assert seconds[-1] < 1.5 * seconds[0] and peak.max() < (2_500.0 if own["system"] == "foot" else 1_000.0)
        took[name] = ", ".join(f"{each:.0f}" for each in seconds)
    said = (
        "Elbow trials of 2000, 10000, 100000 samples take {} s recorded quicker; {} s longer, slopes {:.2f}, {:.2f}. "
        "Foot trials of 2000, 100000 samples take {} s"
    )
    elbow = took["elbow finer"], took["elbow longer"], slopes["elbow finer"], slopes["elbow longer"]
    assert said.format(*elbow, took["foot longer"]) in text


def test_growth_of_commands() -> None:
    """The table as the JSON has it, its slopes derived again; what passes in parts grows little; no page above 2 MB."""
    found = {one["command"]: one for one in results("growth")["figures"]}
    text = (ROOT / "docs/reference/speed.md").read_text(encoding="utf-8")
    assert set(growth.lines(list(found.values()))) <= set(text.splitlines())
    nodes = {"sit-to-stand predict", "sit-to-stand calibrate"}  # whose iterations differ from size to size
    for name, one in found.items():
        runs = one["runs"]
        n, cpu, peak = np.array([[run[key] for key in ("n", "cpu_s", "peak_mb")] for run in runs]).T
        assert len(runs) == 4 and all(run["page_mb"] < 2.0 for run in runs), name
        if one["cpu_slope"] is not None:
            line = np.polyfit(np.log(n[1:] - n[0]), np.log(cpu[1:] - cpu[0]), 1)
            assert abs(one["cpu_slope"] - line[0]) < 1e-9, name
            assert line[0] < 1.2 or name in nodes, name
        assert (one["memory_slope"] is not None) == bool((peak[1:] > peak[0]).all()), name
        if one["memory_slope"] is not None:
            x = np.log(n[1:] - n[0]) - np.log(n[1:] - n[0]).mean()
            assert abs(one["memory_slope"] - x @ np.log(peak[1:] - peak[0]) / (x @ x)) < 1e-9, name
        x = np.log(n) - np.log(n).mean()
        in_parts = name in ("mat", "mat, 16 cells", "cop", "loadcells")
        assert not in_parts or x @ np.log(peak) / (x @ x) < 0.1, name
        assert one["memory_kb_each"] == pytest.approx((peak[-1] - peak[0]) / (n[-1] - n[0]) * 1e3, abs=1e-3), name
    assert {*found} == {*growth.COMMANDS}
    (section,) = re.findall(r"^## Growth\n(.*?)^## ", text, re.DOTALL | re.MULTILINE)
    (others,) = re.findall(r"other commands of (.*?) were not measured", " ".join(section.split()))
    rooms = re.findall(r"`([^`]+)`", others)
    left = {each.command for each in ENTRIES if each.command} - {*found, "gap diagnose"}
    assert {each if each in rooms else each.partition(" ")[0] for each in left} == {*rooms}
    assert f"curves take {found['mat, 16 cells']['memory_kb_each']:.1f} kB a frame" in " ".join(text.split())
    for name in ("loadcells", "cop", "markers"):
        assert f"{found[name]['memory_kb_each']:.1f} kB a row of `{name}`" in " ".join(text.split()), name


def test_kills_and_scaling_of_studies() -> None:
    page = (ROOT / "docs/how-to/cohort.md").read_text(encoding="utf-8")
    told, scaling = results("cohort_kills")["figures"], results("cohort_scaling")["figures"]
    assert told["with_other_tables"] == told["processes_left_running"] == 0
    assert f"Of {sum(told['kills'].values())} kills at random moments" in page and sum(told["kills"].values()) >= 50
    for name, words in (("waiting", "500 trials that wait"), ("areas", "60 contact areas")):
        found = re.search(rf"{words}[^/]*?1/(\d\.\d\d)", page)
        assert found and near(found[1], scaling[name]["speed_up"])


def test_areas_again_and_again() -> None:
    told = results("repeated")
    assert near(row("reference/speed.md", "**repeated**")[0], told["median_cpu_s"]["repeated"])
    assert told["median_cpu_s"]["repeated"] < 0.1 and told["largest_relative_error"] < 1e-9


def test_knees_at_rest() -> None:
    """The table's rows are those of the results, in the same order."""
    begin = {"sample knee, medium": "medium", "sample knee, coarse": "coarse", "DM": "DM", "JW": "JW"}
    for one in results("equilibrium")["rows"]:
        free = "adduction" if one["free"] == ["adduction"] else "all"
        cells = row("how-to/knee_settle.md", f"{begin[one['case']]}, {one['piece_mm']:g} mm, {free}")
        assert cells[0] == (str(one["at_rest"]) if one["at_rest"] == one["frames"] else f"{one['at_rest']} of 5")
        assert near(cells[1], one["cpu_s_per_frame"]) and near(cells[2], one["newton_steps_per_frame"]), cells


def test_movements_that_are_fast_for_their_sampling() -> None:
    now = results("oscillator")["figures"]

    def answers(one: dict[str, Any]) -> str:
        return ", ".join(" + ".join(each["effects"]) or each["verdict"] for each in one["answers"].values())

    for kind, one in now.items():
        cells = row("reference/gap_benchmark.md", kind, one["effect"] or "\N{EN DASH}")
        assert cells == [answers(one)], kind


def test_real_drives_whose_effect_is_known() -> None:
    """Friction that is withheld is named, with it in the base nothing is; figures as the page has them."""
    page, drive, damper = "reference/gap_real_data.md", results("emps"), results("friction_damper")

    def answer(one: dict[str, Any]) -> str:
        (name,) = one["effects"] or [one["verdict"]]
        return f"`{name}`, {one['probabilities'].get(name, one['probabilities']['none']):.2f}"

    without, within = drive["friction withheld"], drive["friction in the base"]
    assert without["effects"] == ["dry_friction"] and within["verdict"] == "no_gap"
    limit = without["limits"]["dry_friction.stroke.limit"]
    told = [answer(without), f"{limit:.1f} N", "{:.2f} \N{RIGHTWARDS ARROW} {:.2f} N".format(*without["rmse"]["force"])]
    assert row(page, "friction withheld") == told
    assert row(page, "friction in the base") == [
        answer(within),
        f"{within['limits']['F_c']:.1f} N",
        f"{within['rmse']['force'][0]:.2f} N",
    ]
    for cycles, words in ((2, "of two cycles"), (1, "of one cycle")):
        for base, key in (("withheld", "dry_friction.stroke.limit"), ("in the base", "F_c")):
            one = damper[f"{cycles} a trial, friction {base}"]
            cells = row(page, words, f"friction {base}")
            assert cells[0] == answer(one) and near(cells[1].split()[0], one["parameters"][key]["value"], 1e-3)
            assert near(cells[2].split()[0], one["gap"]["force"]["before"])


def test_from_a_clone_to_the_first_result() -> None:
    told = results("first_result")["figures"]
    page = (ROOT / "docs/reference/speed.md").read_text(encoding="utf-8")
    assert told["page"] and told["demo_s"] <= told["aim_s"] == 90.0
    assert f"It takes {told['demo_s']:.0f} s on two shared cores" in page


def test_what_the_checks_cost() -> None:
    """The page is made from the file; the aim is a share of a command's CPU time in the median."""
    told = results("checks_cost")["figures"]
    shares = sorted(row["share"] for row in told["commands"].values() if len(row) > 2)
    assert len(shares) >= 15 and told["most"] == shares[-1]
    assert shares[len(shares) // 2] <= told["aim"] == 0.03
    page = (ROOT / "docs/reference/trial_checks.md").read_text(encoding="utf-8")
    assert f"took {told['median']:.1%} of a command's CPU time" in page.replace("\n", " ")
