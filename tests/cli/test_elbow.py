"""`geocontact elbow simulate`, `fit` and `compare` on synthetic recordings: what they write, say and refuse."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest import mock

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.misalignment.parameters import PER_SI
from geocontact.analyses.misalignment.simulate.run import SEED, TRIALS, USUAL
from geocontact.analyses.stale_results import NAMES, PICTURES
from geocontact.axis_misalignment.explicit import Offsets, displacement
from geocontact.axis_misalignment.synthetic import PAPER
from tests.cli.calls import Call, call, done, inventory, written

QUICK = ("--seconds", 20, "--rate", 50, "--noise", 0.2, "--memory", 0.1, "--trials", 3)
KNOWN = ("--known", "l=169,z=127", "--bootstrap", 0)
FIT = {
    "elbow.json", "bins.csv", "boxes.csv", "intervals.csv", "scale_line.csv", "held_out.csv", "report.html", "run.json",
    *(f"{name}.{ending}" for name in ("forces", "identifiability", "residuals") for ending in ("png", "svg")),
}  # fmt: skip


@contextmanager
def unpictured() -> Iterator[None]:
    """Neither figures nor pages are made; most of the time goes into them, and few tests look at them."""
    places = {
        "simulate.run": ("surface_figure", "save_both", "write_simulation_report"),
        "identify.write": (
            "save_both",
            "force_figure",
            "told_figure",
            "residual_figure",
            "conditions_figure",
            "write_fit_report",
        ),
        "compare.run": ("save_both", "comparison_figure", "write_comparison_report"),
    }
    with ExitStack() as stack:
        for place, names in places.items():
            for name in names:
                whole = f"geocontact.analyses.misalignment.{place}.{name}"
                stack.enter_context(mock.patch(whole, return_value=b""))
        yield


def elbow(command: str, folder: Path, *arguments: object, picture: bool = False) -> Call:
    with ExitStack() as stack:
        if not picture:
            stack.enter_context(unpictured())
        return call("elbow", command, *arguments, "--out", folder, folder=folder)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three locked and three free trials."""
    folder = tmp_path_factory.mktemp("made")
    done(elbow("simulate", folder, *QUICK, "--stroke-mm=-10:60", "--pressure", "10:60"))
    return folder


def locked(made: Path) -> list[Path]:
    return sorted(made.glob("locked_*.csv"))


def told(result: Call) -> dict:
    return json.loads(result.bytes("elbow.json"))


def test_simulated_trials_say_what_they_are_and_are_as_asked(made: Path) -> None:
    assert {p.name for p in made.glob("*.csv")} >= {"locked_3.csv", "free_1.csv", "surfaces.csv"}
    for file in made.glob("*_1.csv"):
        assert file.read_text(encoding="utf-8").startswith("# synthetic: ")
    table = pd.read_csv(made / "free_1.csv", comment="#")
    assert list(table) == ["time [s]", "beta [deg]", "force [N]", "displacement [mm]", "pressure [mmHg]"]
    assert len(table) == 1001 and table["displacement [mm]"].min() == pytest.approx(-10.0, abs=0.05)
    assert table["beta [deg]"].min() == pytest.approx(8.0, abs=0.05)
    assert 10.0 < table["pressure [mmHg]"].iloc[0] < 60.0
    truth = json.loads((made / "truth.json").read_text(encoding="utf-8"))
    assert truth["synthetic"] is True and truth["stroke_mm"] == [-10.0, 60.0]
    assert truth["numbers"] == pytest.approx(
        {"k_N_per_m": 222.43, "x_mm": 48.0, "y_mm": 59.0, "l_mm": 169.0, "z_mm": 127.0, "b_N_s_per_m": 0.0,
         "s_per_mmHg": 0.0}
    )  # fmt: skip


def test_the_help_says_what_each_command_does(tmp_path: Path) -> None:
    shown = done(call("elbow", "--help", folder=tmp_path)).out
    for command in ("simulate", "fit", "compare", "design", "population"):
        assert f"{command}: " in shown, shown


def test_the_help_of_a_simulation_tells_what_it_takes_unless_given(tmp_path: Path) -> None:
    """Numbers of the design and the law as they are, held against what stands in the help."""
    shown = done(call("elbow", "simulate", "--help", folder=tmp_path)).out
    options = re.split(r" --(?=[\w-]+ [A-Z]+ )", " ".join(shown.replace("│", " ").split()))
    told = {each.split(" ")[0]: each for each in options}
    low, high = np.degrees(USUAL.reach)
    numbers = ",".join(f"{name}={value * PER_SI[name]:g}" for name, value in PAPER.items())
    expected = {
        "numbers": f"the paper's {numbers}", "trials": TRIALS, "seconds": f"{USUAL.seconds:g}", "noise": USUAL.noise,
        "rate": f"{USUAL.rate:g}", "band": "{:g}:{:g}".format(*USUAL.band), "range": f"{low:g}:{high:g}",
        "memory": USUAL.memory, "donning-mm": f"{USUAL.donning * 1e3:g}", "bits": USUAL.bits, "seed": SEED,
        "stroke-mm": "None", "pressure": "no pressure",
    }  # fmt: skip
    assert USUAL.pressures is None
    for option, default in expected.items():
        assert f" {default} unless given." in told[option], told[option]


def test_the_same_seed_gives_the_same_recordings(tmp_path: Path) -> None:
    seeds = {"a": 4, "b": 4, "c": 5}
    one, two, other = (elbow("simulate", tmp_path / n, *QUICK, "--seed", seed) for n, seed in seeds.items())
    assert one.bytes("locked_1.csv") == two.bytes("locked_1.csv") != other.bytes("locked_1.csv")
    assert one.bytes("locked_1.csv") != one.bytes("locked_2.csv")


def test_forces_along_recorded_angles(tmp_path: Path, made: Path) -> None:
    source = written(tmp_path / "walk.csv", "time [s],hinge [deg]\n0,20\n1,60\n2,90\n3,120\n")
    numbers = "k=300,x=30,y=40,l=170,z=100"
    result = done(elbow("simulate", tmp_path / "out", source, "--map", "beta=hinge", "--numbers", numbers))
    table = pd.read_csv(result.folder / "simulated_walk.csv", comment="#")
    assert table["force [N]"].iloc[2] == pytest.approx(9.947513684, rel=1e-6)  # the right angle worked by hand
    record = result.record()
    assert record["inputs"][0]["role"] == "angle" and "simulated_walk.csv" in record["files"]
    again = done(elbow("simulate", tmp_path / "out", *QUICK))
    assert not (again.folder / "simulated_walk.csv").exists(), "left over from the first run"


def test_with_the_link_known_the_numbers_are_found(tmp_path: Path, made: Path) -> None:
    free = [part for file in sorted(made.glob("free_*.csv")) for part in ("--unlocked", file)]
    result = done(elbow("fit", tmp_path, *locked(made), "--known", "l=169,z=127", "--bootstrap", 100, *free))
    found = told(result)
    assert found["free"] == ["k", "x", "y"] and not found["scale_free"]
    for name, true in (("k", 222.43), ("x", 48.0), ("y", 59.0)):
        one = found["intervals"][name]
        for low, high in (one["profile_likelihood"], one["wild_bootstrap"]):
            assert low < one["value"] < high and low < true < high, name
    assert found["r2"] > 0.98 and len(found["held_out"]) == 3 and min(h["r2"] for h in found["held_out"]) > 0.95
    assert found["between_bins"]["p"] < 0.01
    assert found["between_bins"]["counted_visits"] < found["between_bins"]["samples"] / 5
    pairs = found["between_bins"]["neighbours"]
    np.testing.assert_allclose(np.diff([pair["between_deg"] for pair in pairs]), 10.0)
    assert all(pair["p"] <= pair["p_holm"] for pair in pairs) and min(pair["p_holm"] for pair in pairs) < 0.05
    (stop,) = found["free_joint"]["stops"]
    assert stop["side"] == "lower" and stop["force_N"] < -5.0 and 50.0 < stop["leaves_at_deg"] < 70.0
    stiffness = found["free_joint"]["k_by_displacement_N_per_m"]["value"]
    assert stiffness == pytest.approx(222.43, rel=0.15)
    assert stop["stroke_wanting_mm"] == pytest.approx(-stop["force_N"] / stiffness * 1e3)
    bins = result.table("bins.csv")
    assert list(bins)[:5] == ["beta [deg]", "trials", "visits", "samples", "mean [N]"]
    np.testing.assert_allclose(bins["fitted [N]"] + bins["residual [N]"], bins["mean [N]"])
    assert bins["samples"].sum() == 3 * 1001 and np.allclose(np.diff(bins["beta [deg]"]), 2.0)
    boxes = result.table("boxes.csv")
    assert (boxes["25% [N]"] <= boxes["50% [N]"]).all() and (boxes["50% [N]"] <= boxes["75% [N]"]).all()
    free_boxes = result.table("boxes_free.csv").set_index("beta [deg]")
    assert free_boxes["samples"].sum() == 3 * 1001
    assert abs(free_boxes.loc[85.0, "50% [N]"]) < 0.2 < boxes.set_index("beta [deg]").loc[85.0, "50% [N]"]
    both = result.table("conditions.csv")
    assert list(both) == ["beta [deg]", "locked [N]", "free [N]", "displacement [mm]"]


def test_without_anything_known_the_scale_is_named_and_shown(tmp_path: Path, made: Path) -> None:
    result = done(elbow("fit", tmp_path, *locked(made), "--bootstrap", 0))
    found = told(result)
    assert found["scale_free"] and found["identifiability"]["k_and_lengths"]["flat"]
    np.testing.assert_allclose(
        np.array(found["identifiability"]["k_and_lengths"]["told_least"]) * np.sqrt(5), [-1, 1, 1, 1, 1], atol=1e-5
    )
    assert any("F(k/s, s × lengths) = F" in line and "--known" in line for line in result.warnings)
    line = result.table("scale_line.csv")
    assert np.ptp(line["r2 [-]"]) < 1e-9 and line["k [N/m]"].max() / line["k [N/m]"].min() == pytest.approx(4.0)
    np.testing.assert_allclose(line["k [N/m]"] * line["l [mm]"] * 1e-3, found["ratios"]["k_times_l_N"], rtol=1e-9)
    assert set(found["intervals"]) == {"k_times_l", "x_over_l", "y_over_l", "z_over_l"}
    true = {"k_times_l": 222.43 * 0.169, "x_over_l": 48.0 / 169.0, "y_over_l": 59.0 / 169.0, "z_over_l": 127.0 / 169.0}
    for name, value in true.items():
        low, high = found["intervals"][name]["profile_likelihood"]
        assert low < value < high, name
    table = result.table("intervals.csv").set_index("number")
    assert table.loc[["k", "x", "y", "l", "z"], "profile lower"].isna().all() and "k l" in table.index
    assert "k l " in result.out and "\nk 3" not in result.out


def test_a_known_0_sets_no_scale(tmp_path: Path, made: Path) -> None:
    result = done(elbow("fit", tmp_path, *locked(made), "--known", "z=0", "--bootstrap", 100))
    found = told(result)
    assert found["scale_free"] and found["identifiability"]["k_and_lengths"]["numbers"] == ["k", "x", "y", "l"]
    assert any("F(k/s, s × lengths) = F" in line for line in result.warnings)
    drawn = result.table("intervals.csv").set_index("number")["bootstrap lower"]
    assert drawn[["k", "x", "y", "l"]].isna().all(), "of the start's own point of the line"
    assert drawn[["k l", "x/l", "y/l"]].notna().all()


def test_a_stiffness_that_follows_the_pressure_is_told_and_compared_in_mmhg(tmp_path: Path) -> None:
    """The pressure that s counts from lies among those that were recorded, here as in the comparison."""
    numbers = "k=222.43,x=48,y=59,l=169,z=127,s=0.01"
    design = ("--seconds", 20, "--rate", 50, "--noise", 0.01, "--trials", 4, "--bits", 0, "--pressure", "10:60")
    made = done(elbow("simulate", tmp_path / "made", *design, "--numbers", numbers)).folder
    result = done(elbow("fit", tmp_path / "fit", *locked(made), *KNOWN, "--free", "s"))
    found = told(result)
    means = [table_of(file)["pressure [mmHg]"].mean() for file in locked(made)]
    assert found["pressure_mmHg"] == pytest.approx(np.mean(means), rel=1e-6) and 10.0 < found["pressure_mmHg"] < 60.0
    beside = done(elbow("compare", tmp_path / "cmp", *locked(made), "--fit", result.folder / "elbow.json"))
    np.testing.assert_allclose(beside.table("comparison.csv")["rmse"], 0.01, rtol=0.5)
    by_hand = {"numbers": found["numbers"], "pressure_mmHg": 20.0 + found["pressure_mmHg"]}
    moved = written(tmp_path / "moved.json", json.dumps(by_hand))
    table = done(elbow("compare", tmp_path / "cmp2", *locked(made), "--fit", moved)).table("comparison.csv")
    assert (table["rmse"] > 0.3).all(), "20 mmHg of 0.01 each are a fifth of the force"
    assert (table["r2 [-]"] > 0.5).all()


def test_the_free_joints_displacement_sets_the_scale(tmp_path: Path, made: Path) -> None:
    free = [part for file in sorted(made.glob("free_*.csv")) for part in ("--unlocked", file)]
    result = done(elbow("fit", tmp_path / "all", *locked(made), *free, "--bootstrap", 0))
    found = told(result)
    assert not found["scale_free"] and any("the scale is set by the free joint's disp" in w for w in result.warnings)
    by_displacement = found["free_joint"]["k_by_displacement_N_per_m"]
    low, high = found["intervals"]["k"]["profile_likelihood"]
    assert low < 222.43 < high and high - low < 8.0 * by_displacement["se"]
    assert 0.0 < found["free_joint"]["scale"]["se"] < 0.02 and found["free_joint"]["scale"]["trials"] == 3
    (stop,) = found["free_joint"]["stops"]
    wanting = -stop["force_N"] / by_displacement["value"] * 1e3
    assert stop["stroke_wanting_mm"] == pytest.approx(wanting)
    lone = done(elbow("fit", tmp_path / "one", *locked(made), *free[:2], "--bootstrap", 0))
    assert told(lone)["scale_free"] and any("takes two free trials" in w for w in lone.warnings)
    assert told(lone)["free_joint"]["scale"] is None


def test_a_prior_and_bounds_as_the_papers(tmp_path: Path, made: Path) -> None:
    arguments = ("--prior", "l=185:1", "--bounds", "l=160:210,z=60:130", "--start", "k=300,x=30,y=40,l=200,z=120")
    found = told(done(elbow("fit", tmp_path, *locked(made), *arguments, "--bootstrap", 0)))
    assert found["numbers"]["l_mm"] == pytest.approx(185.0, abs=3.0) and not found["scale_free"]
    sources = pd.read_csv(tmp_path / "intervals.csv").set_index("number")["from"]
    assert (
        sources["l"] == "recordings and prior" and sources["k"] == "recordings" and sources["b"] == "known beforehand"
    )
    assert 60.0 <= found["numbers"]["z_mm"] <= 130.0


def test_recordings_that_were_held_out_tell_r2(tmp_path: Path, made: Path) -> None:
    first, *rest = locked(made)
    found = told(done(elbow("fit", tmp_path, first, rest[0], "--held-out", rest[1], *KNOWN)))
    assert [h["name"] for h in found["held_out"]] == ["locked_3"] and found["held_out"][0]["r2"] > 0.95


def test_the_page_and_its_figures(tmp_path: Path, made: Path) -> None:
    free = ("--unlocked", made / "free_1.csv")
    result = done(elbow("fit", tmp_path / "fit", *locked(made), *KNOWN, "--cutoff", 5, *free, picture=True))
    files = set(inventory(result.folder))
    assert files == FIT | {"conditions.csv", "boxes_free.csv", "conditions.png", "conditions.svg"} and files <= NAMES
    page = (result.folder / "report.html").read_text(encoding="utf-8")
    assert "bootstrap lower" not in page, "without a bootstrap no empty columns"
    for words in (
        "What the data tell",
        "known beforehand",
        "set by what was known beforehand",
        "Lilliefors",
        "Joint locked and free",
    ):
        assert words in page
    simulated = done(elbow("simulate", tmp_path / "sim", *QUICK, "--stroke-mm=-10:60", picture=True))
    assert "Displacement of the joint, free_1 (synthetic)" in (simulated.folder / "report.html").read_text("utf-8")
    assert {"surfaces.png", "report.html"} <= set(inventory(simulated.folder))
    assert all(name in NAMES or PICTURES.fullmatch(name) for name in inventory(simulated.folder))
    assert "These recordings are synthetic" in (simulated.folder / "report.html").read_text(encoding="utf-8")
    fit = result.folder / "elbow.json"
    beside = done(elbow("compare", tmp_path / "cmp", *locked(made)[:1], "--fit", fit, picture=True))
    assert set(inventory(beside.folder)) == {
        "comparison.csv", "comparison_force.png", "comparison_force.svg", "report.html", "run.json",
    }  # fmt: skip


def test_a_fit_is_compared_trial_by_trial_and_channel_by_channel(tmp_path: Path, made: Path) -> None:
    law = {"numbers": json.loads((made / "truth.json").read_text(encoding="utf-8"))["numbers"], "pressure_mmHg": None}
    fit = written(tmp_path / "elbow.json", json.dumps(law))
    free = sorted(made.glob("free_*.csv"))
    table = done(elbow("compare", tmp_path / "o", *free, "--fit", fit, "--stroke-mm=-10:60")).table("comparison.csv")
    assert list(table["channel"]) == ["force", "displacement"] * 3 and list(table["unit"]) == ["N", "mm"] * 3
    force, slide = table[table["channel"] == "force"], table[table["channel"] == "displacement"]
    np.testing.assert_allclose(force["rmse"], 0.2, rtol=0.2)  # the noise alone
    assert (force["mae"] < force["rmse"]).all() and (slide["r2 [-]"] > 0.9999).all() and (slide["rmse"] < 0.1).all()


def test_two_sets_of_recordings_are_compared(tmp_path: Path, made: Path) -> None:
    one = locked(made)[0]
    table = done(elbow("compare", tmp_path, one, "--simulated", one)).table("comparison.csv")
    assert table["mae"].item() == 0.0 and table["r2 [-]"].item() == 1.0


REFUSED = {
    "known twice": (("--known", "l=169,l=170"), "l is given twice"),
    "no such number": (("--known", "q=3"), "one of k, x, y"),
    "not a number": (("--known", "l=long"), "'long' is not a finite number"),
    "prior of a known one": (("--known", "l=169", "--prior", "l=169:5"), "l is known already"),
    "prior without SD": (("--prior", "l=169"), "not a pair"),
    "SD of 0": (("--prior", "l=169:0"), "not above 0"),
    "bounds without room": (("--bounds", "x=60:-60"), "no room between its bounds"),
    "start outside": (("--bounds", "x=0:10", "--start", "x=20"), "not between its bounds"),
    "everything known": (("--known", "k=222,x=48,y=59,l=169,z=127"), "leaves nothing"),
    "negative link": (("--known", "l=-169"), "l is not positive"),
    "link in metres": (("--known", "l=0.169"), "are these metres?"),
    "prior on a link in metres": (("--prior", "l=0.185:0.01"), "are these metres?"),
    "start of a link in metres": (("--start", "l=0.2"), "are these metres?"),
    "bounds of a link in metres": (("--bounds", "l=0.16:0.21"), "are these metres?"),
    "free what is free": (("--free", "k"), "not b or s"),
    "pressure that is not there": (("--free", "s", "--map", "pressure=cuff"), "cuff"),
    "damping bounds unasked": (("--bounds", "b=0:10"), "b is not free"),
    "bins of nothing": (("--bin-deg", "0"), "0.1 to 30"),
    "wide bins": (("--bin-deg", "20"), "bins are reached"),
    "few replicates": (("--bootstrap", "5"), "100 to 100000"),
    "cut-off beyond": (("--cutoff", "40"), "cut-off of 40 Hz"),
    "a fold": (("--known", "l=40,x=48,y=0,z=0"), "beyond the model: |x| = 48 mm"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_fits_that_cannot_be_are_refused_in_one_line(tmp_path: Path, made: Path, name: str) -> None:
    options, said = REFUSED[name]
    result = elbow("fit", tmp_path / "out", *locked(made), *options)
    assert result.code == 2 and len(result.complaints) == 1 and said in result.err, result.err
    assert not (tmp_path / "out").exists()


def test_a_pressure_that_stays_tells_no_stiffness_over_it(tmp_path: Path, made: Path) -> None:
    names = []
    for file in locked(made):
        table = table_of(file)
        table["pressure [mmHg]"] = 30.0
        table.to_csv(tmp_path / file.name, index=False)
        names.append(tmp_path / file.name)
    result = elbow("fit", tmp_path / "out", *names, *KNOWN, "--free", "s")
    assert result.code == 2 and "pressure varies by 0 mmHg only" in result.err
    table.drop(columns="pressure [mmHg]").to_csv(tmp_path / "none.csv", index=False)
    result = elbow("fit", tmp_path / "out", *names[:2], tmp_path / "none.csv", *KNOWN, "--free", "s")
    assert result.code == 2 and "needs a column pressure in every trial" in result.err


def table_of(file: Path) -> pd.DataFrame:
    return pd.read_csv(file, comment="#")


def test_recordings_that_contradict_each_other_are_refused(tmp_path: Path, made: Path) -> None:
    turned = table_of(locked(made)[1])
    turned["force [N]"] *= -1.0
    turned.to_csv(tmp_path / "turned.csv", index=False)
    rest = locked(made)[:1] + locked(made)[2:]
    result = elbow("fit", tmp_path / "o", *rest, tmp_path / "turned.csv")
    assert result.code == 2 and "turned.csv: its force mirrors that of the other trials" in result.err
    result = elbow("fit", tmp_path / "o", rest[0], tmp_path / "turned.csv", *KNOWN)
    assert result.code == 2 and "mirrors that of the other trial, and nothing tells which is right" in result.err
    result = elbow("fit", tmp_path / "o", *rest, "--held-out", tmp_path / "turned.csv", *KNOWN)
    assert result.code == 2 and "mirrors what the fitted trials predict" in result.err
    free = table_of(made / "free_1.csv")
    free["displacement [mm]"] *= -1.0
    free.to_csv(tmp_path / "against.csv", index=False)
    result = elbow("fit", tmp_path / "o", *locked(made), "--unlocked", tmp_path / "against.csv", *KNOWN)
    assert result.code == 2 and "run against each other" in result.err
    result = elbow("fit", tmp_path / "o", *locked(made), made / "free_1.csv")
    assert result.code == 2 and "the compensation joint slides by" in result.err and "--unlocked" in result.err
    result = elbow("fit", tmp_path / "o", locked(made)[0], locked(made)[0])
    assert result.code == 2 and "second recording named" in result.err


def test_where_a_rotary_joint_was_free_as_well_the_displacement_is_d_lin(tmp_path: Path, made: Path) -> None:
    """Free trials whose joint slides by d_lin: taken for d_tot they set a wrong scale, said to be d_lin right one."""
    free = []
    for k, file in enumerate(sorted(made.glob("free_*.csv"))):
        table = table_of(file)
        offsets = Offsets(l=0.169, z=0.127, x=0.048, y=0.059)
        slid = displacement(np.radians(table["beta [deg]"].to_numpy()), offsets).linear
        table["displacement [mm]"] = 1e3 * np.clip(slid, -0.010, 0.060) * (1.0 + 0.004 * (k - 1))
        table.to_csv(tmp_path / file.name, index=False)
        free += ["--unlocked", tmp_path / file.name]
    right = told(done(elbow("fit", tmp_path / "r", *locked(made), *free, "--rotary-free", "--bootstrap", 0)))
    low, high = right["intervals"]["k"]["profile_likelihood"]
    assert low < 222.43 < high
    taken = done(elbow("fit", tmp_path / "t", *locked(made), *free, "--bootstrap", 0))
    assert any("(else --rotary-free)" in line for line in taken.warnings)
    low, high = told(taken)["intervals"]["k"]["profile_likelihood"]
    assert not low < 222.43 < high
    idle = elbow("fit", tmp_path / "i", *locked(made), "--rotary-free")
    assert idle.code == 2 and "--rotary-free: does nothing without --unlocked" in idle.err


def test_offsets_that_change_from_trial_to_trial_are_warned_of(tmp_path: Path, made: Path) -> None:
    """Donning of 4 mm leaves more than noise within the trials would; without it the fit leaves what noise leaves."""
    done(elbow("simulate", tmp_path / "don", *QUICK, "--donning-mm", 4))
    found = {name: elbow("fit", tmp_path / name, *locked(folder), *KNOWN)
             for name, folder in (("still", made), ("donned", tmp_path / "don"))}  # fmt: skip
    ratios = {name: told(done(each))["residuals"]["over_noise"] for name, each in found.items()}
    assert 0.6 < ratios["still"] < 1.5 and ratios["donned"] > 3.0
    words = "offsets that change from trial to trial"
    assert any(words in line for line in found["donned"].warnings)
    assert not any(words in line for line in found["still"].warnings)


def test_what_does_worse_than_a_constant_is_warned_of(tmp_path: Path, made: Path) -> None:
    """A trial whose force has nothing to do with the angle, held out and compared."""
    table = table_of(locked(made)[2])
    table["force [N]"] = 8.0 * np.sin(9.0 * table["time [s]"]) + 5.0
    table.to_csv(tmp_path / "noise.csv", index=False)
    result = done(elbow("fit", tmp_path / "f", *locked(made)[:2], "--held-out", tmp_path / "noise.csv", *KNOWN))
    assert any("a constant force would do better: noise (-" in line for line in result.warnings)
    beside = done(elbow("compare", tmp_path / "c", tmp_path / "noise.csv", "--fit", tmp_path / "f" / "elbow.json"))
    assert any("a constant would do better" in line for line in beside.warnings)


def test_recordings_of_other_motions_are_not_compared(tmp_path: Path, made: Path) -> None:
    one, two, _ = locked(made)
    result = elbow("compare", tmp_path, one, "--simulated", two)
    assert result.code == 2 and "degrees, root mean square, from that of the model's recording" in result.err


def test_the_bootstrap_draws_ratios_where_nothing_sets_the_scale(tmp_path: Path, made: Path) -> None:
    result = done(elbow("fit", tmp_path, *locked(made), "--bootstrap", 100))
    table = result.table("intervals.csv").set_index("number")
    for name in ("k l", "x/l", "y/l", "z/l"):
        row = table.loc[name]
        assert row["bootstrap lower"] < row["value"] < row["bootstrap upper"], name


def test_the_cuff_s_pressure_is_heeded_along_a_recording(tmp_path: Path) -> None:
    done(elbow("simulate", tmp_path / "made", *QUICK, "--pressure", "10:60"))
    recording = tmp_path / "made" / "locked_1.csv"
    forces = {}
    for s in ("0", "0.02"):
        done(elbow("simulate", tmp_path / s, recording, "--numbers", f"s={s}"))
        table = pd.read_csv(tmp_path / s / "simulated_locked_1.csv", comment="#")
        assert "pressure [mmHg]" in table
        forces[s] = table
    ratio = forces["0.02"]["force [N]"] / forces["0"]["force [N]"]
    pressure = forces["0"]["pressure [mmHg]"]
    np.testing.assert_allclose(ratio, 1.0 + 0.02 * (pressure - pressure.mean()), rtol=1e-6)


def test_missing_bins_are_named(tmp_path: Path, made: Path) -> None:
    names = []
    for file in locked(made):
        table = table_of(file)
        gap = (table["beta [deg]"] > 30.0) & (table["beta [deg]"] < 40.0)
        table[~gap].to_csv(tmp_path / file.name, index=False)
        names.append(tmp_path / file.name)
    result = done(elbow("fit", tmp_path / "out", *names, *KNOWN))
    assert any("no sample in 5 bins inside the range reached: 30…40°" in line for line in result.warnings)
    bins = result.table("bins.csv").set_index("beta [deg]")
    assert bins.loc[31.0, "samples"] == 0 and np.isnan(bins.loc[35.0, "mean [N]"])


def test_a_force_that_is_turned_over_throughout_is_doubted(tmp_path: Path, made: Path) -> None:
    """Offsets of the other sign make nearly the same curve: where the turned one fits better, it is said."""
    known = ("--known", "l=169,z=127", "--bounds", "x=0:100,y=0:100", "--bootstrap", 0)
    result = done(elbow("fit", tmp_path, *locked(made), *known, "--map", "force=-force"))
    assert any("the force turned over fits better" in line for line in result.warnings)


SIMULATED = {
    "a fold": (("--numbers", "x=180"), "|x| = 180 mm is more than the link's l = 169 mm"),
    "a pole": (("--numbers", "x=150,y=150", "--range", "0:140"), "tan γ has a pole at"),
    "a range in radians": (("--range", "0.1:1.6"), "are these radians?"),
    "a range beyond any elbow": (("--range", "0:400"), "beyond any elbow"),
    "a band that aliases": (("--band", "10:90", "--rate", 100), "reaches above half of 100 Hz"),
    "s without a pressure": (("--numbers", "s=0.01"), "s does nothing without a cuff pressure"),
    "no stiffness": (("--numbers", "k=0"), "not positive"),
    "a stroke that ends first": (("--stroke-mm=10:-10",), "no room"),
    "no trials": (("--trials", 0), "1 to 1000"),
    "negative noise": (("--noise", -1), "0 or more"),
    "a map of nothing": (("--map", "beta=b"), "without a recording"),
    "a band from 0": (("--band", "0:0.3"), "not above 0 Hz"),
}


@pytest.mark.parametrize("name", SIMULATED)
def test_simulations_that_cannot_be_are_refused_in_one_line(tmp_path: Path, name: str) -> None:
    options, said = SIMULATED[name]
    result = elbow("simulate", tmp_path / "out", *options)
    assert result.code == 2 and len(result.complaints) == 1 and said in result.err, result.err
    assert not (tmp_path / "out").exists()


def test_comparisons_that_cannot_be_are_refused(tmp_path: Path, made: Path) -> None:
    one, bad = locked(made)[0], written(tmp_path / "elbow.json", "{}")
    for options, said in (
        ((), "exactly one is compared with"),
        (("--fit", bad), "holds no law of an elbow"),
        (("--simulated", one, "--simulated", one), "given 2 times for 1 recording; "),
        (("--simulated", one, "--stroke-mm=0:1"), "does nothing without --fit"),
        (("--fit", tmp_path / "none.json"), "none.json"),
    ):
        result = elbow("compare", tmp_path / "out", one, *options)
        assert result.code == 2 and said in result.err, result.err
    with_s = {"k_N_per_m": 222, "x_mm": 1, "y_mm": 1, "l_mm": 169, "z_mm": 1, "b_N_s_per_m": 0, "s_per_mmHg": 0.01}
    fit = written(tmp_path / "s.json", json.dumps({"numbers": with_s, "pressure_mmHg": 30.0}))
    table_of(one)[["time [s]", "beta [deg]", "force [N]"]].to_csv(tmp_path / "bare.csv", index=False)
    result = elbow("compare", tmp_path / "out", tmp_path / "bare.csv", "--fit", fit)
    assert result.code == 2 and "follows the cuff's pressure" in result.err
