"""Wrong inputs on commands that two rounds had left out, silent then: each is heard of; right ones are not."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.profiles import read as read_optimise
from geocontact.analyses.sit_to_stand.compare.options import StandingCompareOptions
from geocontact.analyses.sit_to_stand.design.designs import read as read_design
from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.analyses.sit_to_stand.predict.predictions import read as read_compare
from geocontact.trial_checks.recorded import TrialInputs
from geocontact.trial_checks.table import MOVED_CHECKS
from tests.analyses.findings.heard import Finding, Lines, as_lines, as_parameters, heard, heard_reading, typed
from tests.analyses.findings.test_inputs_beside import read
from tests.analyses.findings.test_new_commands import settled
from tests.analyses.mat.samples import THIGH
from tests.analyses.misalignment.test_compare import law
from tests.analyses.misalignment.trials import STROKE, free, locked, recorded
from tests.analyses.modulus.synthetic_step import areas, forces
from tests.cli.calls import MESHES
from tests.trial_checks import damage
from tests.trial_checks import test_commands as trials

Attempt = Callable[[Path], Lines]
Change = Callable[[pd.DataFrame], Any]
STOOD = MESHES / "amputee_P1"


def table(file: Path, change: Change) -> None:
    """A .csv changed in place, or replaced by what the change returns."""
    found = pd.read_csv(file, comment="#", skipinitialspace=True)
    made = change(found)
    (found if made is None else made).to_csv(file, index=False)


def times_column(name: str, factor: float) -> Change:
    return lambda found: found.__setitem__(name, factor * found[name])


def functional(factor: float) -> Attempt:
    """The functional trial of an amputee beside the standing trial, of which one person is larger."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(STOOD, folder)
        trials.markers_changed("functional.trc", trials.larger(factor))(there)
        moved, still = (trials.read_trc(there / f"{name}.trc") for name in ("functional", "standing"))
        return heard_reading(lambda _: check_trial(TrialInputs(moved, still), MOVED_CHECKS), lambda: None)

    return attempt


def limb(markers: str) -> Attempt:
    return lambda folder: heard(gc.prosthesis.scale, STOOD / "standing.trc", mass=77.3, residual_markers=markers)


def keel(column: str, factor: float) -> Attempt:
    """Prosthesis keel of the bench foot with all curves in another unit."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(MESHES / "foot_bench", folder)
        for name in ("soft", "firm", "hard", "walking"):
            table(there / f"{name}.csv", times_column(column, factor))
        return heard(gc.prosthesis.keel, there / "foot.toml")

    return attempt


def law_of_friction(still: float, sliding: float) -> Attempt:
    """Prosthesis calibrate, up to its reading, with the friction of a law."""

    def change(folder: Path) -> dict[str, Any]:
        (folder / "law.toml").write_text(f"mu_s = {still}\nmu_k = {sliding}\n")
        return {"law": folder / "law.toml"}

    return read(change, trials.calibrate, lambda folder: trials.files_of(trials.WALK, folder))


def copied_centre(noise: float) -> Attempt:
    """The same with z of the centre of pressure from x."""

    def change(columns: dict[str, np.ndarray]) -> None:
        more = np.random.default_rng(1).normal(size=len(columns["time"]))
        columns["own_force_pz"] = columns["own_force_px"] + noise * more

    return read(trials.plates_changed(change), trials.calibrate, lambda folder: trials.files_of(trials.WALK, folder))


def risen(change: damage.Damage, design: bool = False) -> Attempt:
    """Sit-to-stand compare or design, up to its reading, of the held-out trial."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(MESHES / "standing_up_held_out", folder)
        worn = trials.files_of(MESHES / "standing_up_exoskeleton", folder)
        change(there)
        given: dict[str, Any] = {"parameters": worn / "truth.csv"}
        if design:
            return heard_reading(read_design, StandingDesignOptions, there / "study.toml", **given)
        given["against"] = worn / "study.toml"
        return heard_reading(read_compare, StandingCompareOptions, there / "study.toml", **given)

    return attempt


def torques(factor: float, begin: str = "") -> damage.Damage:
    """Torques of the person, or of the hinges whose names begin so, times a factor."""
    own = ("ankle", "knee", "hip")

    def change(columns: dict[str, np.ndarray]) -> None:
        for name, values in columns.items():
            if name.startswith(begin) if begin else name in own:
                columns[name] = factor * values

    return trials.columns_changed("P1_torques.sto", change)


def exchanged_torques(columns: dict[str, np.ndarray]) -> None:
    columns["knee"], columns["hip"] = columns["hip"], columns["knee"]


def of_another_trial(folder: Path) -> dict[str, Any]:
    shutil.copy(MESHES / "standing_up_exoskeleton" / "T3_torques.sto", folder / "P1_torques.sto")
    return {}


def strapped(factor: float = 1.0, late: float = 0.0) -> damage.Damage:
    def change(folder: Path) -> dict[str, Any]:
        table(folder / "P1_strap.csv", times_column("normal [N]", factor))
        table(folder / "P1_strap.csv", lambda found: found.__setitem__("time [s]", found["time [s]"] + late))
        return {}

    return change


def softer_strap(folder: Path) -> dict[str, Any]:
    file = folder.parent / "standing_up_exoskeleton" / "truth.csv"
    file.write_text(file.read_text().replace("strap normal,N/m,4500", "strap normal,N/m,450"))
    return {}


def overhead(change: Change) -> Attempt:
    """Shoulder optimise, up to its reading, with a changed recording of the tool."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(trials.OVERHEAD, folder)
        (there / "study.toml").write_text(trials.OVERHEAD_STUDY)
        table(there / "tool.csv", change)
        return heard_reading(read_optimise, ShoulderOptimiseOptions, there / "study.toml")

    return attempt


def elbow(change: Change, pick: Callable[[Path], tuple[Path, ...]] = locked, copy: bool = False) -> Attempt:
    """Elbow compare of changed recordings with the true law, or with themselves."""

    def attempt(folder: Path) -> Lines:
        files = pick(recorded(folder, stroke=STROKE))
        for file in files:
            table(file, change)
        beside = {"simulated": files} if copy else {"fit": law(folder)}
        return heard(gc.misalignment.compare, files, **beside)

    return attempt


def drifting(text: str) -> Attempt:
    """Elbow design with a drift of the axis."""
    return lambda folder: typed(
        "elbow", "design", "--k", 222, "--l-mm", 169, "--z-mm", 127, "--range", "0:120deg", "--limit", 5, "--step-mm",
        30, "--drift", text, "--out", folder / "out",
    )  # fmt: skip


def on_thigh(change: Change, **options: Any) -> Attempt:
    """Mat on the shipped thigh with changed frames."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(THIGH, folder)
        table(there / "frames.csv", change)
        given = {"layout": there / "layout.toml", "landmarks": there / "landmarks.csv", "unit": "mm", "cutoff": 0.0}
        return heard(gc.mat, there / "frames.csv", surface=MESHES / "thigh.stl", **(given | options))

    return attempt


def of_row(row: int, value: Callable[[pd.DataFrame, int], Any]) -> Change:
    """All cells of a row."""

    def change(found: pd.DataFrame) -> None:
        for column in range(8):
            found[f"r{row}c{column} [kPa]"] = value(found, column)

    return change


def beside_model(
    factor: float = 1.0, late: float = 0.0, channels: tuple[str, ...] = ("fx", "fy", "fz"), clock: float = 1.0
) -> Attempt:
    """Mat beside its true forces, of which something is wrong."""

    def attempt(folder: Path) -> Lines:
        found = pd.read_csv(THIGH / "truth.csv", comment="#", skipinitialspace=True)
        for name in [each for each in found.columns if each.startswith(channels)]:
            found[name] = factor * found[name]
        found["time [s]"] = clock * found["time [s]"] + late
        found.to_csv(folder / "model.csv", index=False)
        return on_thigh(lambda _: None, compare=folder / "model.csv")(folder)

    return attempt


def sheared_by_pressure(folder: Path) -> Lines:
    frames = THIGH / "frames.csv"
    return on_thigh(lambda _: None, shear_rows=frames, shear_columns=frames)(folder)


def modulus(change_forces: Change, area: float = 1.0, **options: Any) -> Attempt:
    """Modulus of the synthetic step with changed forces, and areas in another unit."""

    def attempt(folder: Path) -> Lines:
        pressed, touched = forces(folder), areas(folder)
        table(pressed, change_forces)
        if area != 1.0:
            table(touched, lambda found: found.update(area * found.filter(like="[mm^2]")))
        again = {"predict_area": (touched,), "predict_force": pressed} if options.pop("again", False) else {}
        return heard(gc.modulus, area=(touched,), force=pressed, radius=gc.mm(37), bootstrap=0, **again, **options)

    return attempt


def ball(radius: float) -> Attempt:
    """Modulus of a ball on a plate whose distance is known: areas within two thresholds, 2 pi R (T - d), R 20 mm."""

    def attempt(folder: Path) -> Lines:
        time = np.linspace(0.0, 1.0, 41)
        near = {T: 2.0 * np.pi * 20.0 * (T + 0.5 * np.sin(np.pi * time)) for T in (1.0, 2.0, 4.0)}
        rows = [(t, T, each[k]) for k, t in enumerate(time) for T, each in near.items()]
        touched, pressed = folder / "area.csv", folder / "forces.csv"
        columns = ["time [s]", "threshold [mm]", "area_fixed [mm^2]"]
        pd.DataFrame(rows, columns=columns).to_csv(touched, index=False)
        force = 4.0 / 3.0 * 6.8 * (near[4.0] / np.pi) ** 1.5 / 20.0
        pd.DataFrame({"time [s]": time, "total [N]": force}).to_csv(pressed, index=False)
        return heard(gc.modulus, area=(touched,), force=pressed, radius=gc.mm(radius), bootstrap=0)

    return attempt


def exchange(found: pd.DataFrame) -> None:
    found["medial [N]"], found["lateral [N]"] = found["lateral [N]"].copy(), found["medial [N]"].copy()


def as_it_is(_: object) -> None:
    return None


def rows_missing(found: pd.DataFrame) -> pd.DataFrame:
    return found.drop(index=range(20, 30))


def untouched(_: Path) -> dict[str, Any]:
    return {}


FINDINGS: dict[str, Finding] = {
    "walk: the functional trial of somebody larger": Finding(functional(1.15), "warned: .*are both trials of one pers"),
    "scale: residual limb on the sound side": Finding(limb("LKNE,LSH1"), "refused: .*`residual_markers`: LKNE lies"),
    "scale: residual limb to the ankle": Finding(limb("RKNE,RANK"), "refused: .*`residual_markers`: .*not shorter"),
    "keel: forces in kgf": Finding(keel("force [N]", 1 / 9.81), "warned: .*GPa is unusual for .*laminate.*in N"),
    "keel: forces ten times": Finding(keel("force [N]", 10.0), "warned: .*GPa is unusual for .*laminate.*in N"),
    "keel: deflections in inches": Finding(keel("deflection [mm]", 1 / 25.4), "warned: .*and the data in theirs"),
    "calibrate: friction exchanged": Finding(law_of_friction(0.5, 0.8), "warned: .*kinetic friction mu_k # is larger"),
    "calibrate: a copied column": Finding(copied_centre(0.0), "warned: .*x and z of its centre of pressure are equal"),
    "compare: torques of the person turned": Finding(risen(torques(-1.0)), "warned: .*ground reaction.*sign turned"),
    "compare: torques of the hinges turned": Finding(risen(torques(-1.0, "exo")), "warned: .*exoskeleton in thei"),
    "compare: torques of one leg": Finding(
        risen(trials.all_of(torques(0.5), torques(0.5, "exo"))), "warned: .*ask for, rms: .*are they of one leg"
    ),
    "compare: torques for each kg": Finding(
        risen(trials.all_of(torques(1 / 70), torques(1 / 70, "exo"))), "warned: .*not for each kg of the body"
    ),
    "compare: knee and hip exchanged": Finding(
        risen(trials.columns_changed("P1_torques.sto", exchanged_torques)), "warned: .*ask for, rms: knee .* hip"
    ),
    "compare: torques of another trial": Finding(risen(of_another_trial), "warned: .*are they of this trial"),
    "compare: a strap in kgf": Finding(risen(strapped(1 / 9.81)), "warned: .*by coordinates and stiffness by .*in N"),
    "compare: a strap without force": Finding(risen(strapped(0.0)), "warned: .*does its cell work"),
    "compare: a strap 0.3 s late": Finding(risen(strapped(late=0.3)), "warned: .*0.30 s late: is its clock right"),
    "compare: a strap turned": Finding(risen(strapped(-1.0)), "warned: .*falls where its spring .*is its sign turned"),
    "compare: stiffness of another strap": Finding(risen(softer_strap), "warned: .*are the parameters those"),
    "design: torques of the person turned": Finding(risen(torques(-1.0), True), "warned: .*is their sign turned"),
    "design: a strap in kgf": Finding(risen(strapped(1 / 9.81), True), "warned: .*is it in N, does its cell"),
    "optimise: the tool 20 s later": Finding(
        overhead(lambda found: found.__setitem__("time [s]", found["time [s]"] + 20.0)), "warned: .*is it of this trial"
    ),
    "optimise: the tool's time in ms": Finding(overhead(times_column("time [s]", 1e3)), "warned: .*its time in s, not"),
    "optimise: the tool's current turned": Finding(
        overhead(times_column("current [A]", -1.0)), "warned: .*current is down to -4.82 A: is its sign turned"
    ),
    "optimise: the tool's current in mA": Finding(overhead(times_column("current [A]", 1e3)), "warned: .*4820 mA mea"),
    "elbow: forces in kgf": Finding(
        elbow(times_column("force [N]", 1 / 9.81)), "contradicts: .*0.1 times the simulated ones: is the unit right"
    ),
    "elbow: forces in lbf": Finding(
        elbow(times_column("force [N]", 1 / 4.448)), "contradicts: .*0.23 times the simulated ones: is the unit right"
    ),
    "elbow: compared with itself": Finding(elbow(as_it_is, copy=True), "warned: .*that of the simulated recording"),
    "elbow: a free joint without its stroke": Finding(elbow(as_it_is, free), "warned: .*slides by 38 mm.*give its"),
    "elbow: rows missing": Finding(elbow(rows_missing), "warned: .*has nothing from .* are rows missing"),
    "elbow design: a drift in m": Finding(drifting("x=0:-0.008:0.002"), "warned: .*moves by 0.008 mm.*is it in mm"),
    "elbow design: a drift of metres": Finding(drifting("x=0:-800:2"), "warned: .*the axis moves by .* not in m"),
    "mat: a model in kN": Finding(beside_model(1e-3), "warned: .*1e.03 times the simulated ones: is the unit right"),
    "mat: a model turned": Finding(beside_model(-1.0), "warned: .*describe the mat's force better: is a sign turned"),
    "mat: a model 0.3 s late": Finding(beside_model(late=0.3), "warned: .*0.30 s late: is its clock right"),
    "mat: moments of a model in N mm": Finding(
        beside_model(1e3, channels=("mx", "my", "mz")), "warned: .*m[xz]: R² is .*0.001 times the simulated ones"
    ),
    "mat: a model's time in ms": Finding(beside_model(clock=1e3), "warned: .*is its time in s, not in ms"),
    "mat: the pressure as shear": Finding(sheared_by_pressure, "refused: .*values are those of the pressure"),
    "mat: a row copied": Finding(
        on_thigh(of_row(9, lambda found, c: found[f"r8c{c} [kPa]"])), "warned: .*row 9 reads what row 8 reads"
    ),
    "mat: a row broken": Finding(on_thigh(of_row(8, lambda _, c: 0.0)), "warned: .*no cell of row 8 is ever pressed"),
    "mat: a cell ten times": Finding(
        on_thigh(times_column("r8c4 [kPa]", 10.0)),
        "warned: .*row 8 column 4 reads 272.9 kPa, and cells end at 60 .*or that cell faulty",
    ),
    "mat: never touched": Finding(on_thigh(as_it_is, touched=5e4), "warned: .*no cell is touched"),
    "mat: never beyond the gate": Finding(on_thigh(as_it_is, gate=500.0), "warned: .*no frame has a centre"),
    "mat: frames missing": Finding(on_thigh(rows_missing), "warned: .*has nothing from 0.38 to 0.6 s"),
    "modulus: a side copied": Finding(
        modulus(lambda found: found.__setitem__("lateral [N]", found["medial [N]"])), "warned: .*is a column copied"
    ),
    "modulus: sides exchanged": Finding(modulus(exchange), "warned: .*if medial and lateral forces were exchanged"),
    "modulus: a diameter": Finding(ball(40.0), "warned: .*on a radius of 20 mm.* R is 40 mm: is one of them a diam"),
    "elbow: a stiffness 35 % off": Finding(
        elbow(times_column("force [N]", 1.35)), "warned: .*times the model's in every trial.*is its stiffness that of"
    ),
    "modulus: areas in cm²": Finding(modulus(as_it_is, 0.01), "warned: .*largest force over largest area: .*in mm²"),
    "modulus: tested with its own trial": Finding(modulus(as_it_is, again=True), "warned: .*of the trial that was"),
    "knee: sides split at 50 mm": Finding(settled(split="z=50"), "warned: .*all of the force is medial, or all"),
}  # fmt: skip
NEARLY: dict[str, Attempt] = {
    "walk: the functional trial of the person": functional(1.0),
    "walk: 2 % larger": functional(1.02),
    "keel": keel("force [N]", 1.0),
    "keel: forces 2 % off": keel("force [N]", 1.02),
    "calibrate: friction": law_of_friction(0.8, 0.8),
    "calibrate: components nearly alike": copied_centre(1e-3),
    "compare": risen(untouched),
    "compare: torques 10 % off": risen(trials.all_of(torques(0.9), torques(0.9, "exo"))),
    "compare: a strap 50 % stiffer": risen(strapped(1.5)),
    "compare: a strap 0.03 s late": risen(strapped(late=0.03)),
    "design": risen(untouched, True),
    "elbow": elbow(as_it_is),
    "elbow: two rows missing": elbow(lambda found: found.drop(index=[20, 21])),
    "elbow design: a drift of 10 mm": drifting("x=0:-8:2"),
    "mat beside its model": beside_model(),
    "mat beside its model, 10 % off": beside_model(0.9),
    "mat: two frames missing": on_thigh(lambda found: found.drop(index=[20, 21])),
    "mat: a cell 10 % off": on_thigh(times_column("r8c4 [kPa]", 1.1)),
    "modulus": modulus(as_it_is),
    "modulus: a radius 40 % larger": ball(28.0),
    "elbow: a stiffness 15 % off": elbow(times_column("force [N]", 1.15)),
    "knee": settled(),
}
KNOWN = r"no sensitivities where there is no force|has another centre|the sole is -0.06\d+ N/mm off the stiffness"
"""Warnings of what is right."""


@pytest.mark.parametrize("finding", as_parameters(FINDINGS))
def test_it_is_heard_of(finding: Finding, tmp_path: Path) -> None:
    lines = finding.attempt(tmp_path)
    assert [line for line in lines if re.match(finding.words, line, re.DOTALL)], lines


@pytest.mark.parametrize("attempt", NEARLY.values(), ids=NEARLY)
def test_what_is_right_is_not_doubted(attempt: Attempt, tmp_path: Path) -> None:
    said = [line for line in attempt(tmp_path) if line.startswith(("refused", "warned", "contradicts"))]
    assert not [line for line in said if not re.search(KNOWN, line)]


def test_tools_as_they_are_say_nothing_of_themselves(tmp_path: Path) -> None:
    assert not [line for line in as_lines(overhead(as_it_is)(tmp_path)) if "tool" in line]
