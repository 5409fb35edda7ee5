"""Offsets, link and stiffness from force and angle: found where they can be, and else said to be open."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.misalignment.identify.sentences import explained
from geocontact.axis_misalignment.explicit import Offsets, displacement
from geocontact.axis_misalignment.synthetic import offsets_in
from tests.analyses.misalignment.trials import KNOWN, PAPER, changed, free, locked, quietly, recorded

pytestmark = pytest.mark.slow


def identify(*recordings: Path, **options: Any) -> Any:
    return quietly(gc.misalignment.identify, *recordings, **options)


@pytest.fixture(scope="module")
def told(made: Path) -> Any:
    """With the link known, a bootstrap and the free joint."""
    return identify(*locked(made), known=KNOWN["known"], bootstrap=100, unlocked=free(made))


@pytest.fixture(scope="module")
def unscaled(made: Path) -> Any:
    """With nothing known."""
    return identify(*locked(made), bootstrap=0)


def test_with_the_link_known_the_numbers_are_found(told: Any) -> None:
    intervals = told.summary["intervals"]
    assert told.summary["free"] == ["k", "x", "y"] and not told.summary["scale_free"]
    shown = {"k": 222.43, "x": 48.0, "y": 59.0}
    for name, true in shown.items():
        one = intervals[name]
        for low, high in (one["profile_likelihood"], one["wild_bootstrap"]):
            assert low < one["value"] < high and low < true < high, name
    assert told.numbers["l"] == 0.169 and told.numbers["x"] == pytest.approx(intervals["x"]["value"] * 1e-3)
    held = told.fit.held
    assert told.fit.r2 > 0.98 and len(held) == 3 and min(h.r2 for h in held) > 0.95


def test_the_result_says_what_was_found(told: Any, unscaled: Any) -> None:
    assert str(told).startswith(f"k {told.fit.intervals[0].shown}\nx ")
    assert "k by the free joint's displacement: " in str(told)
    assert "k l " in str(unscaled) and "\nk 3" not in str(unscaled) and "warning: k and the lengths" in str(unscaled)


def test_bins_differ_by_visits_and_not_by_samples(told: Any) -> None:
    tested = told.summary["between_bins"]
    assert tested["p"] < 0.01 and tested["counted_visits"] < tested["samples"] / 5
    pairs = tested["neighbours"]
    np.testing.assert_allclose(np.diff([pair["between_deg"] for pair in pairs]), 10.0)
    assert all(pair["p"] <= pair["p_holm"] for pair in pairs) and min(pair["p_holm"] for pair in pairs) < 0.05


def test_the_free_joint_stands_at_an_end_and_says_how_much_stroke_is_wanting(told: Any) -> None:
    joint = told.summary["free_joint"]
    (stop,) = joint["stops"]
    assert stop["side"] == "lower" and stop["force_N"] < -5.0 and 50.0 < stop["leaves_at_deg"] < 70.0
    stiffness = joint["k_by_displacement_N_per_m"]["value"]
    assert stiffness == pytest.approx(222.43, rel=0.15)
    assert stop["stroke_wanting_mm"] == pytest.approx(-stop["force_N"] / stiffness * 1e3)


def test_tables_hold_bins_fit_and_spread(told: Any) -> None:
    bins = told.table("bins")
    assert list(bins)[:5] == ["beta [deg]", "trials", "visits", "samples", "mean [N]"]
    np.testing.assert_allclose(bins["fitted [N]"] + bins["residual [N]"], bins["mean [N]"])
    assert bins["samples"].sum() == 3 * 1001 and np.allclose(np.diff(bins["beta [deg]"]), 2.0)
    boxes = told.table("boxes")
    assert (boxes["25% [N]"] <= boxes["50% [N]"]).all() and (boxes["50% [N]"] <= boxes["75% [N]"]).all()
    loose = told.table("boxes_free").set_index("beta [deg]")
    assert loose["samples"].sum() == 3 * 1001
    assert abs(loose.loc[85.0, "50% [N]"]) < 0.2 < boxes.set_index("beta [deg]").loc[85.0, "50% [N]"]
    assert list(told.table("conditions")) == ["beta [deg]", "locked [N]", "free [N]", "displacement [mm]"]


def test_the_moment_on_the_cuff_and_the_fixation_beside_it_are_told(told: Any, unscaled: Any) -> None:
    bins, numbers = told.table("bins"), told.numbers
    gamma = displacement(np.radians(bins["beta [deg]"].to_numpy()), offsets_in(numbers)).gamma
    np.testing.assert_allclose(bins["gamma [deg]"], np.degrees(gamma))
    moment = -bins["fitted [N]"] * numbers["z"] / np.cos(gamma) ** 2
    np.testing.assert_allclose(bins["cuff_moment [N m]"], moment, atol=1e-12)
    assert not {"gamma [deg]", "cuff_moment [N m]"} & set(unscaled.table("bins")), "no length is known"
    apart, shown = told.fit.separable, told.summary["identifiability"]["fixation_from_cuff"]
    assert shown == {"own_beside_k": apart.from_cuff, "own_beside_all_free": apart.from_all, "told_apart": True}
    assert 0.0 < apart.from_all < apart.from_cuff < 0.2
    assert (
        f"as c is taken as 0. Of the effect of a yielding fixation on the force, {apart.from_all:.1%}"
        in explained(told.fit, told.free)[1]
    )
    assert not any("compliance" in line or "torque" in line for line in told.warnings)


def test_without_anything_known_the_scale_is_named_and_shown(unscaled: Any) -> None:
    found = unscaled.summary
    assert found["scale_free"] and found["identifiability"]["k_and_lengths"]["flat"]
    least = np.array(found["identifiability"]["k_and_lengths"]["told_least"])
    np.testing.assert_allclose(least * np.sqrt(5), [-1, 1, 1, 1, 1], atol=1e-5)
    assert any("F(k/s, s × lengths) = F" in line and "`known`" in line for line in unscaled.warnings)
    line = unscaled.table("scale_line")
    assert np.ptp(line["r2 [-]"]) < 1e-9 and line["k [N/m]"].max() / line["k [N/m]"].min() == pytest.approx(4.0)
    np.testing.assert_allclose(line["k [N/m]"] * line["l [mm]"] * 1e-3, found["ratios"]["k_times_l_N"], rtol=1e-9)
    assert unscaled.fit.line.alone_r2.min() < 0.5 < unscaled.fit.line.alone_r2.max(), "k alone is told along it"
    true = {"k_times_l": 222.43 * 0.169, "x_over_l": 48.0 / 169.0, "y_over_l": 59.0 / 169.0, "z_over_l": 127.0 / 169.0}
    assert set(found["intervals"]) == set(true)
    for name, value in true.items():
        low, high = found["intervals"][name]["profile_likelihood"]
        assert low < value < high, name


@pytest.mark.slow
def test_the_bootstrap_draws_ratios_where_nothing_sets_the_scale(made: Path) -> None:
    table = identify(*locked(made), bootstrap=100).table().set_index("number")
    assert table.loc[["k", "x", "y", "l", "z"], "profile lower"].isna().all()
    for name in ("k l", "x/l", "y/l", "z/l"):
        row = table.loc[name]
        assert row["bootstrap lower"] < row["value"] < row["bootstrap upper"], name


@pytest.mark.slow
def test_a_known_0_sets_no_scale(made: Path) -> None:
    result = identify(*locked(made), known={"z": 0.0}, bootstrap=100)
    directions = result.summary["identifiability"]["k_and_lengths"]
    assert result.summary["scale_free"] and directions["numbers"] == ["k", "x", "y", "l"]
    assert any("F(k/s, s × lengths) = F" in line for line in result.warnings)
    drawn = result.table().set_index("number")["bootstrap lower"]
    assert drawn[["k", "x", "y", "l"]].isna().all(), "of the start's own point of the line"
    assert drawn[["k l", "x/l", "y/l"]].notna().all()


@pytest.mark.slow
def test_the_free_joints_displacement_sets_the_scale(made: Path) -> None:
    result = identify(*locked(made), unlocked=free(made), bootstrap=0)
    found = result.summary
    assert not found["scale_free"] and any("the scale is set by the free joint's disp" in w for w in result.warnings)
    by_displacement = found["free_joint"]["k_by_displacement_N_per_m"]
    low, high = found["intervals"]["k"]["profile_likelihood"]
    assert low < 222.43 < high and high - low < 8.0 * by_displacement["se"]
    assert 0.0 < found["free_joint"]["scale"]["se"] < 0.02 and found["free_joint"]["scale"]["trials"] == 3
    (stop,) = found["free_joint"]["stops"]
    wanting = -stop["force_N"] / by_displacement["value"] * 1e3
    assert stop["stroke_wanting_mm"] == pytest.approx(wanting)


@pytest.mark.slow
def test_one_free_trial_sets_no_scale(made: Path) -> None:
    lone = identify(*locked(made), unlocked=free(made)[:1], bootstrap=0)
    assert lone.summary["scale_free"] and any("takes two free trials" in w for w in lone.warnings)
    assert lone.summary["free_joint"]["scale"] is None


@pytest.mark.slow
def test_a_prior_and_bounds_as_the_papers(made: Path) -> None:
    prior, bounds = {"l": gc.mm(185, 1)}, {"l": gc.mm(160, 210), "z": gc.mm(60, 130)}
    start = {"k": 300.0, "x": gc.mm(30), "y": gc.mm(40), "l": gc.mm(200), "z": gc.mm(120)}
    result = identify(*locked(made), prior=prior, bounds=bounds, start=start, bootstrap=0)
    assert result.numbers["l"] == pytest.approx(0.185, abs=3e-3) and not result.summary["scale_free"]
    sources = result.table().set_index("number")["from"]
    assert sources["l"] == "recordings and prior" and sources["k"] == "recordings"
    assert sources["b"] == "known beforehand" and 0.060 <= result.numbers["z"] <= 0.130


def test_a_prior_that_the_forces_contradict_is_a_doubt(made: Path) -> None:
    """x is 48 mm here; a prior of 30 ± 1 mm cannot hold it, one of 30 ± 20 mm says nothing."""
    said = {}
    for sd in (1.0, 20.0):
        found = identify(*locked(made), **KNOWN, prior={"x": gc.mm(30, sd)})
        off = (1e3 * found.numbers["x"] - 30.0) / sd
        said[sd] = [line for line in found.warnings if "off the mean of the prior of x" in line]
        assert bool(said[sd]) == (abs(off) > 3.0), off
        for line in said[sd]:
            assert f"{sd * off:+.3g} mm off the mean of the prior of x, {abs(off):.3g} times its standard dev" in line
    assert said[1.0] and not said[20.0]


def test_recordings_that_were_held_out_tell_r2(made: Path) -> None:
    first, second, third = locked(made)
    (held,) = identify(first, second, held_out=(third,), **KNOWN).fit.held
    assert held.name == "locked_3" and held.r2 > 0.95


@pytest.mark.slow
def test_a_stiffness_that_follows_the_pressure_is_told_about_the_recordings_mean(tmp_path: Path) -> None:
    design: dict[str, Any] = {"noise": 0.01, "trials": 4, "bits": 0, "pressure": gc.mmHg(10, 60)}
    folder = recorded(tmp_path, numbers={"s": 0.01 / gc.mmHg(1)}, **design)
    result = identify(*locked(folder), **KNOWN, free=("s",))
    means = [pd.read_csv(file)["pressure [mmHg]"].mean() for file in locked(folder)]
    centre = result.summary["pressure_mmHg"]
    assert centre == pytest.approx(np.mean(means), rel=1e-6) and 10.0 < centre < 60.0
    there = 222.43 * (1.0 + 0.01 * (centre - 35.0))  # the stiffness was given at 35 mmHg
    assert result.numbers["k"] == pytest.approx(there, rel=0.01)
    assert result.numbers["s"] == pytest.approx(0.01 / gc.mmHg(1) * 222.43 / there, rel=0.02)
    (tmp_path / "elbow.json").write_text(json.dumps(result.summary))
    beside = quietly(gc.misalignment.compare, *locked(folder), fit=tmp_path / "elbow.json").table()
    np.testing.assert_allclose(beside["rmse"], 0.01, rtol=0.5)


@pytest.mark.slow
def test_where_a_rotary_joint_was_free_as_well_the_displacement_is_d_lin(tmp_path: Path, made: Path) -> None:
    """Free trials whose joint slides by d_lin: taken for d_tot they set a wrong scale, said to be d_lin right one."""
    offsets = Offsets(l=0.169, z=0.127, x=0.048, y=0.059)

    def slid(table: pd.DataFrame, k: int) -> np.ndarray:
        linear = displacement(np.radians(table["beta [deg]"].to_numpy()), offsets).linear
        return 1e3 * np.clip(linear, -0.010, 0.060) * (1.0 + 0.004 * (k - 1))

    each = enumerate(free(made))
    files = tuple(changed(file, tmp_path, displacement=lambda t, k=k: slid(t, k)) for k, file in each)
    right = identify(*locked(made), unlocked=files, rotary_free=True, bootstrap=0)
    low, high = right.summary["intervals"]["k"]["profile_likelihood"]
    assert low < 222.43 < high
    taken = identify(*locked(made), unlocked=files, bootstrap=0)
    assert any("(else `rotary_free`)" in line for line in taken.warnings)
    low, high = taken.summary["intervals"]["k"]["profile_likelihood"]
    assert not low < 222.43 < high


@pytest.mark.slow
def test_offsets_that_change_from_trial_to_trial_are_warned_of(tmp_path: Path, made: Path) -> None:
    """Donning of 4 mm leaves more than noise within the trials would; without it the fit leaves what noise leaves."""
    donned = identify(*locked(recorded(tmp_path, donning=gc.mm(4))), **KNOWN)
    still = identify(*locked(made), **KNOWN)
    assert 0.6 < still.fit.residuals.excess.ratio < 1.5 and donned.fit.residuals.excess.ratio > 3.0
    words = "offsets that change from trial to trial"
    assert any(words in line for line in donned.warnings) and not any(words in line for line in still.warnings)


def test_what_does_worse_than_a_constant_is_warned_of(tmp_path: Path, made: Path) -> None:
    """A trial whose force has nothing to do with the angle, held out."""
    noise = changed(locked(made)[2], tmp_path, "noise.csv", force=lambda t: 8.0 * np.sin(9.0 * t["time [s]"]) + 5.0)
    result = identify(*locked(made)[:2], held_out=(noise,), **KNOWN)
    assert any("a constant force would do better: noise (-" in line for line in result.warnings)


def test_missing_bins_are_named(tmp_path: Path, made: Path) -> None:
    files = []
    for file in locked(made):
        table = pd.read_csv(file)
        table[~table["beta [deg]"].between(30.0, 40.0)].to_csv(tmp_path / file.name, index=False)
        files.append(tmp_path / file.name)
    result = identify(*files, **KNOWN)
    assert any("no sample in 5 bins inside the range reached: 30…40°" in line for line in result.warnings)
    bins = result.table("bins").set_index("beta [deg]")
    bins.index = bins.index.to_numpy().round(6)
    assert bins.loc[31.0, "samples"] == 0 and np.isnan(bins.loc[35.0, "mean [N]"])


def test_a_force_that_is_turned_over_throughout_is_doubted(made: Path) -> None:
    """Offsets of the other sign make nearly the same curve: where the turned one fits better, it is said."""
    bounds = {"x": gc.mm(0, 100), "y": gc.mm(0, 100)}
    result = identify(*locked(made), **KNOWN, bounds=bounds, map="force=-force")
    assert any("the force with its sign turned fits better" in line for line in result.warnings)
    assert PAPER["x"] < bounds["x"][1]


def test_recordings_that_contradict_each_other_are_refused(tmp_path: Path, made: Path) -> None:
    one, two, three = locked(made)
    turned = changed(two, tmp_path, "turned.csv", force=lambda t: -t["force [N]"])
    against = changed(free(made)[0], tmp_path, "against.csv", displacement=lambda t: -t["displacement [mm]"])
    cases: list[tuple[list[Path], dict[str, Any], str]] = [
        ([one, three, turned], {}, "turned.csv: its force mirrors that of the other trials"),
        ([one, turned], KNOWN, "mirrors that of the other trial, and nothing shows which is right"),
        ([one, three], {**KNOWN, "held_out": (turned,)}, "mirrors what the fitted trials predict"),
        ([one, two, three], {**KNOWN, "unlocked": (against,)}, "run against each other"),
        ([one, two, free(made)[0]], {}, "give it with `unlocked`"),
        ([one, one], {}, "second recording named"),
    ]
    for files, options, said in cases:
        with pytest.raises(gc.InputError, match=said):
            identify(*files, **options)


def test_a_pressure_that_stays_tells_no_stiffness_over_it(tmp_path: Path, made: Path) -> None:
    files = [changed(file, tmp_path, pressure=lambda t: 30.0 + 0.0 * t["force [N]"]) for file in locked(made)]
    with pytest.raises(gc.InputError, match="pressure varies by 0 mmHg only"):
        identify(*files, **KNOWN, free=("s",))
    pd.read_csv(files[2]).drop(columns="pressure [mmHg]").to_csv(files[2], index=False)
    with pytest.raises(gc.InputError, match="`free` s needs a column pressure in every trial"):
        identify(*files, **KNOWN, free=("s",))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"known": {"l": 169.0}}, "169000 mm cannot be a link of an exoskeleton"),
        ({"prior": {"q": (1.0, 1.0)}}, "'q' is not a number of the law"),
        ({"bin": 2.0}, "`bin`: 114.592 deg cannot be a width of bins: that is 0.1 to 30 deg; is 2 deg meant?"),
        ({"free": ("k",)}, "`free`: 'k' is not b, s or c"),
        ({"rotary_free": True}, "`rotary_free`: has no effect without `unlocked`"),
    ],
)
def test_what_cannot_be_is_refused_in_si(given: dict, said: str) -> None:
    with pytest.raises(gc.InputError) as refused:
        identify(Path(__file__), **given)  # refused before it is read
    assert said in str(refused.value)


def test_every_figure_has_a_name(told: Any, unscaled: Any) -> None:
    assert tuple(told.curves()) == ("forces", "identifiability", "residuals", "conditions")
    with pytest.raises(KeyError, match="there are forces, identifiability, residuals"):
        unscaled.figure("conditions")
