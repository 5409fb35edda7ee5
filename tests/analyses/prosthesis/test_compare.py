"""A study by the analysis: what is refused in its description, and the shipped stances from end to end."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.compare import stances
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.result import run
from geocontact.analyses.prosthesis.compare.show import comparison_curves, in_words
from geocontact.analyses.prosthesis.compare.stances import read as read_study
from geocontact.analyses.prosthesis.quantity_words import small_force
from geocontact.below_knee_prosthesis.marker_draws import MarkerBand, marker_band
from tests.below_knee_prosthesis.stances import a_stance
from tests.below_knee_prosthesis.test_stance_errors import plate_of, walked
from tests.cli.calls import MESHES
from tests.recording import opened

PERSON = '[persons.P1]\nmass = {{ value = 77.3, unit = "kg" }}\nstatic = "{meshes}/gait_P1_medium_1/standing.trc"\n'
TRIAL = """
[[trials]]
name = "P1_{setting}_1"
person = "P1"
setting = "{setting}"
markers = "{meshes}/gait_P1_{setting}_1/walking.trc"
plates = "{meshes}/gait_P1_{setting}_1/plates.mot"
plate = "own_force"
other_plate = "other_force"
"""


def written(folder: Path, *settings: str, changed: tuple[str, str] = ("", "")) -> Path:
    text = PERSON.format(meshes=MESHES) + "".join(TRIAL.format(meshes=MESHES, setting=each) for each in settings)
    file = folder / "study.toml"
    file.write_text(text.replace(*changed))
    return file


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('setting = "low"', 'setting = "soft"', "'soft' is none"),
        ('setting = "low"', "", "needs a setting or a fulcrum"),
        (
            'setting = "low"',
            'fulcrum = { value = 60, unit = "mm" }',
            "60 mm cannot be the place of a fulcrum: that is 66 to 151 mm",
        ),
        ('person = "P1"', 'person = "P2"', r"no \[persons.P2\]"),
        ('unit = "kg"', 'unit = "N"', "is not a unit of it"),
        ('plate = "own_force"', "", "no plate"),
        ('name = "P1_low_1"', 'called = "P1"', r"\[\[trials\]\] 1 called: is not known here"),
        ("walking.trc", "running.trc", "there is no file"),
        ('setting = "low"', 'setting = "low"\nlaw = "low.toml"', "there is no file low.toml"),
        ('setting = "low"', 'setting = "low"\nlaw = "study.toml"', "study.toml.*not known here"),
        ('setting = "low"', 'setting = "low"\nground = "slope:3"', "neither a plane nor stairs"),
    ],
)
def test_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    with pytest.raises(gc.InputError, match=words):
        gc.prosthesis.compare(written(tmp_path, "low", changed=(old, new)))


def test_a_stance_twice_is_refused(tmp_path: Path) -> None:
    """At another setting it would be among the others that it is compared with."""
    again = TRIAL.format(meshes=MESHES, setting="low").replace('"P1_low_1"', '"again"').replace('"low"', '"high"')
    study = written(tmp_path, "low")
    study.write_text(study.read_text() + again)
    with pytest.raises(gc.InputError, match=r"\[\[trials\]\]: the stance of P1_low_1 and of again is the same one"):
        gc.prosthesis.compare(study)


@pytest.mark.slow
@pytest.mark.long
def test_shipped_stances_from_markers_to_files(tmp_path: Path) -> None:
    """The error of a stance is that of `prosthesis simulate`; the one that lands too hard says so."""
    study = written(tmp_path, "low", "high")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.prosthesis.compare(study, workers=1)
        trial = MESHES / "gait_P1_low_1"
        alone = gc.prosthesis.simulate(
            trial / "walking.trc",
            static=MESHES / "gait_P1_medium_1" / "standing.trc",
            mass=77.3,
            setting="low",
            plates=trial / "plates.mot",
            other_plate="other_force",
            plate="own_force",
        )
    assert found.sentences[0] == "2 stances, 1 person, 2 settings of the foot"
    assert re.match(
        r"resultant force: R² [\d.]+, [\d.]+% BW; without a model mean of the others [\d.]+% BW,", found.sentences[1]
    )
    errors = found.table("errors").set_index(["trial", "quantity"])
    own = alone.table("errors").set_index("quantity")
    for quantity in ("resultant", "fore_aft", "cop_ground"):
        assert errors.loc[("P1_low_1", quantity), "rmse"] == pytest.approx(own.loc[quantity, "rmse"], rel=1e-12)
    assert errors.loc[("P1_low_1", "resultant"), "rmse"] < 0.08  # the plain predictors are 0.10 and more off
    assert bool(errors.loc[("P1_low_1", "resultant"), "better"])
    seen = found.table("trials").set_index("trial")["what is seen"]
    assert "leaves the floor again" in seen["P1_high_1"] and "leaves" not in seen["P1_low_1"]
    summary = found.table("summary").set_index(["setting", "quantity"])
    assert np.isfinite(
        summary.loc[("low", "resultant"), ["another r2 [-]", "mean of the others r2 [-]"]].astype(float)
    ).all()
    (said,) = [each for each in found.sentences if each.startswith("low: ")]
    assert said.count("without a model") == 3
    changes = found.table("changes").set_index("outcome")
    peaks = found.table("trials").set_index("trial")
    for column, kind in (("most vertical [-]", "predicted"), ("most vertical on the plate [-]", "measured")):
        change = peaks.loc["P1_high_1", column] - peaks.loc["P1_low_1", column]
        assert changes.loc["largest vertical force", kind] == pytest.approx(change, rel=1e-9)
    assert set(changes["verdict"]) == {"error not known"} and set(changes["to"]) == {"high"}
    assert any(each.startswith("low to high: largest ankle moment ") for each in found.sentences)
    ensembles = found.table("ensembles").set_index("setting")
    high = found.stances[1].measured("resultant")
    np.testing.assert_allclose(ensembles.loc["low", "resultant another setting [-]"], high, rtol=1e-12)
    sheet = comparison_curves(found.stances)
    panels = {each.title.rpartition(": ")[2].partition(",")[0]: each.curves for each in sheet.panels[:2]}
    assert [each.name for each in panels["low"]] == ["plate", "model", "mean of the others", "another setting"]
    np.testing.assert_allclose(panels["low"][3].values, found.stances[1].measured("vertical"))
    found.write(tmp_path / "out")
    assert (tmp_path / "out" / "trials" / "P1_high_1" / "ground_reaction.xml").is_file()


@pytest.mark.slow
def test_the_foot_beside_its_standing_trial_is_said_and_written(tmp_path: Path) -> None:
    law = tmp_path / "law.toml"
    law.write_text("[foot]\nheight = 0.4e-3\npitch = -0.012\n")
    study = written(tmp_path, "low", changed=("[persons.P1]\n", f'[persons.P1]\nlaw = "{law}"\n'))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.prosthesis.compare(study, workers=1, socket_turns=0)
    assert any(each.endswith("are taken from the law on 1 of 1 stances") for each in found.sentences)
    row = found.table("trials").iloc[0]
    assert (row["foot height [mm]"], row["foot pitch [deg]"]) == pytest.approx((0.4, np.degrees(-0.012)))
    found.write(tmp_path / "out")
    lines = (tmp_path / "out" / "trials" / "P1_low_1" / "numbers.csv").read_text().splitlines()
    (pitch,) = [line.split(",")[1] for line in lines if line.startswith("leg foot_pitch,")]
    assert float(pitch) == -0.012


def test_what_all_stances_are_warned_of_is_one_line(tmp_path: Path) -> None:
    """The hip's regression is that of the person; a study has keys, no options."""
    heard = opened(Record("prosthesis compare", {}))
    read_study(ProsthesisCompareOptions(written(tmp_path, "low", "medium")))
    assert [line for line in heard.warnings if "regression" in line] == [
        "all 2 stances: the hip's centre comes from a regression; a functional trial determines it better"
    ]


OWN = np.arange(0.0, 0.95, 0.002)


def studied(name: str, setting: str, lasting: float = 0.7) -> Any:
    """A stance of a study whose simulation is made up: the plate's force over another time [s]."""
    stance = a_stance(OWN, walked(0.1 + (OWN - 0.1) * 0.7 / lasting))
    whose = {"name": name, "person": "P", "setting": setting, "calibrated": False}
    asked = SimpleNamespace(side="right", score="stance")
    return SimpleNamespace(**whose, walk=stance, asked=asked, recorded=name, plate=plate_of(OWN))


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> MarkerBand:
    """Stances as they are, and draws that fail of the one called b; the band of the others."""
    band = marker_band(
        a_stance(OWN, walked(OWN)), lambda rng: a_stance(OWN, (1.0 + 0.01 * rng.standard_normal()) * walked(OWN)), 3
    )

    def drawn(recorded: str, _: object, asked: object) -> MarkerBand | None:
        if recorded == "b":
            raise gc.InputError("b.trc", "`walks`", "7 of 12 draws cannot be simulated", "")
        return band

    monkeypatch.setattr(stances, "simulated", lambda walk, asked: SimpleNamespace(stance=walk, settled=True))
    monkeypatch.setattr(stances, "band_of", drawn)
    return band


def test_a_stance_whose_draws_fail_is_kept_without_a_band(made_up: MarkerBand) -> None:
    """Of two the second has no band: in the table its columns are empty, and the mean is that of the first."""
    given = (studied("a", "low"), studied("b", "low"))
    heard = opened(Record("prosthesis compare", {}))
    result = run(given, ProsthesisCompareOptions(Path("study.toml"), walks=12, workers=1))
    assert [one.name for one in result.stances] == ["a", "b"] and list(result.bands) == ["a"]
    assert [line for line in heard.warnings if "draws" in line] == ["b has no band: 7 of 12 draws cannot be simulated"]
    table = result.table("trials").set_index("trial")
    assert table.loc["b", list(stances.MOVED)].isna().all()
    on = result.stances[0].stance.on
    half = made_up.width("vertical", on)
    assert half > 0.0 and table.loc["a", "vertical moved by markers [-]"] == pytest.approx(half)
    (said,) = [line for line in result.sentences if line.startswith("errors of the markers")]
    assert f"±{half:.1%} BW" in said and said.endswith("within that for 100% of the stance")


@pytest.mark.usefixtures("made_up")
def test_the_length_of_stances_is_said_by_setting() -> None:
    """20 ms longer at low, 10 and 20 ms shorter at high: mean -3 ms."""
    given = tuple(
        studied(f"{setting} {late}", setting, 0.7 + late)
        for setting, late in (("low", 0.02), ("high", -0.01), ("high", -0.02))
    )
    opened(Record("prosthesis compare", {}))
    result = run(given, ProsthesisCompareOptions(Path("study.toml"), workers=1))
    summary = result.table("summary").set_index(["quantity", "setting"])["difference"]
    for setting, late in (("low", 0.02), ("high", -0.015), ("all", -0.01 / 3.0)):
        assert summary["stance", setting] == pytest.approx(late, abs=1e-3), setting
    (said,) = [line for line in result.sentences if line.startswith("stance longer")]
    mean, low, high = (1e3 * summary["stance", setting] for setting in ("all", "low", "high"))
    assert said.startswith(f"stance longer than on the plate by {mean:+.0f} ms (SD 17 ms)")
    assert said.endswith(f"; low {low:+.0f}, high {high:+.0f} ms")


def test_a_small_force_below_a_constant_is_judged_by_its_error() -> None:
    assert small_force("medio_lateral", -2.565).endswith("R² is -2.56; this force is small: judge by its error")
    assert not small_force("resultant", -8.18) and not small_force("medio_lateral", 0.2)


def test_counts_of_better_stances_are_no_answers() -> None:
    """One of one is 1, not yes; whether a stance is better is yes or no, also where another row has no answer."""
    counts = pd.DataFrame({"quantity": ["resultant", "stance"], "better": [1.0, np.nan], "trials": [1, 1]})
    assert list(in_words(counts)["better"].dropna()) == [1.0]
    answers = pd.DataFrame({"quantity": ["resultant", "vertical", "stance"], "better": [True, False, np.nan]})
    assert list(in_words(answers)["better"]) == ["yes", "no", ""]
    assert list(in_words(answers)["quantity"]) == ["resultant force", "vertical force", "length of the stance"]


OWN_SEGMENTS = """age = { value = 15, unit = "years" }
height = { value = 1.81, unit = "m" }
segments.thigh = { mass = { value = 8, unit = "kg" } }
segments.foot = { mass = { value = 1.1, unit = "kg" } }
"""


@pytest.mark.filterwarnings("ignore::geocontact.InputWarning")
def test_masses_of_a_described_person_are_those_of_the_leg(tmp_path: Path) -> None:
    """The thigh its own, the residual limb a part of a shank of 5.6 of 99.9 % (a boy of 15 years)."""
    opened(Record("prosthesis compare", {}))
    plain, own = (
        read_study(ProsthesisCompareOptions(written(tmp_path, "low", changed=change)))[0].walk.leg
        for change in (("", ""), ("[persons.P1]\n", f"[persons.P1]\n{OWN_SEGMENTS}"))
    )
    assert own.thigh_body()[0] == pytest.approx(8.0, rel=1e-12)
    shares = own.residual_body()[0] / plain.residual_body()[0]
    assert shares == pytest.approx(5.6 / 99.9 / 0.0433, rel=1e-9)
    numbers = own.numbers()
    assert numbers["thigh_mass"].note.startswith("own values of thigh, foot, else Jensen 1986 and 1989, boys of 15")
    np.testing.assert_allclose(own.thigh_body()[1], plain.thigh_body()[1], rtol=1e-12)
