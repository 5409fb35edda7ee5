"""A case from chosen columns of recordings, a shipped model and answers: files against numbers computed here."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.quantities import UNITS, is_known
from geocontact.analyses.gap.chosen_columns import ChosenColumn, recorded_columns, write_chosen
from geocontact.analyses.gap.init.answers import AnsweredNumber, answer_case, begun_settings
from geocontact.analyses.gap.init.options import QUESTIONS
from geocontact.io.cases.trial_table import read_trial
from geocontact.systems.catalogue import SYSTEMS
from tests.analyses.gap.shipped_cases import MODELS, written

RADIUS = 0.037


def knee_trials(folder: Path, count: int = 4) -> Path:
    """Areas [mm^2] of two sides and loads of two Hertzian circles of E* = 6.8 MPa; synthetic."""
    folder.mkdir()
    time = 0.02 * np.arange(80)
    for k in range(1, count + 1):
        areas = 1e-6 * np.array([500.0 + 90.0 * np.sin((2 + k) * time), 380.0 + 60.0 * np.cos((3 + k) * time)])
        force = 4.0 / 3.0 * 6.8e6 * (areas / np.pi) ** 1.5 / RADIUS
        rows = np.column_stack([time, 40.0 + 20.0 * np.sin(time), 2.0 * np.cos(time), *(1e6 * areas), *(1e-3 * force)])
        head = "time [s],flexion [deg],add,A_med [mm^2],A_lat [mm^2],F_med,F_lat"
        np.savetxt(folder / f"t{k}.csv", rows, delimiter=",", header=head, comments="", fmt="%.12g")
    return folder


CHOSEN = (
    ChosenColumn("flexion", "flexion", "deg"),
    ChosenColumn("add", "adduction", "deg"),
    ChosenColumn("A_med", "area_medial", "mm^2"),
    ChosenColumn("A_lat", "area_lateral", "mm^2"),
    ChosenColumn("F_med", "force_medial", "kN"),
    ChosenColumn("F_lat", "force_lateral", "kN"),
)


def begun(folder: Path, young: float) -> Path:
    """The case of these trials that `gap init` begins for the shipped knee."""
    raw, data = knee_trials(folder / "raw"), folder / "data"
    data.mkdir()
    for file in sorted(raw.glob("*.csv")):
        write_chosen(file, CHOSEN, data / file.name)
    result = gc.init_gap_case(simulator="knee", data=data, number={"E_star": young, "R": RADIUS})
    force = np.loadtxt(raw / "t1.csv", delimiter=",", skiprows=1)[:, 5]
    off = 1e3 * float(np.sqrt(np.mean(force**2))) * abs(1.0 - young / 6.8e6)
    assert result.errors["t1"]["force_medial"] == pytest.approx(off, rel=1e-6, abs=1e-6)
    result.write(folder / "case")
    return folder / "case"


def test_the_first_run_of_a_shipped_model_is_that_of_its_formula(tmp_path: Path) -> None:
    """No error at the modulus that made the forces; half of the force at half of it."""
    for name, young in (("true", 6.8e6), ("half", 3.4e6)):
        (tmp_path / name).mkdir()
        begun(tmp_path / name, young)


def test_answers_make_the_case_that_a_diagnosis_reads(tmp_path: Path) -> None:
    case = begun(tmp_path, 5e6)
    with pytest.raises(gc.InputError, match="lower"):
        gc.read_gap_case(case)
    numbers = {
        "E_star": AnsweredNumber(5e6, 1e6, 5e7, "Pa"),
        "R": AnsweredNumber(RADIUS, None, None, "m"),
    }
    before = (case / "case.toml").read_text("utf-8")
    with pytest.raises(gc.InputError):
        answer_case(case, ["t2"], {**numbers, "E_star": AnsweredNumber(5e6, 6e6, 5e7, "Pa")}, {})
    assert (case / "case.toml").read_text("utf-8") == before  # a refused answer leaves the questions
    with pytest.raises(gc.InputError, match="has no trial t9"):
        answer_case(case, ["t9"], numbers, {})
    answer_case(case, ["t2", "t4"], numbers, {"force_medial": 2.0})
    found = tomllib.loads((case / "case.toml").read_text("utf-8"))
    assert (found["calibration"], found["evaluation"]) == (["t1", "t3"], ["t2", "t4"])
    assert found["system"] == "knee" and found["noise"] == {"force_medial": 2.0}
    assert found["constants"] == {"R": RADIUS} and list(found["parameters"]) == ["E_star"]
    assert found["parameters"]["E_star"] == {"start": 5e6, "lower": 1e6, "upper": 5e7, "unit": "Pa"}
    assert "?" not in found["parameters"]["E_star"].values()
    read = gc.read_gap_case(case)
    force = 4.0 / 3.0 * 6.8e6 * (read.evaluation[0].column("area_medial") / np.pi) ** 1.5 / RADIUS
    assert read.evaluation[0].column("force_medial") == pytest.approx(force, rel=1e-9)
    assert gc.system_of(read).name == "knee"
    answer_case(case, ["t4"], numbers, {})  # a second answer takes the place of the first
    again = tomllib.loads((case / "case.toml").read_text("utf-8"))
    assert again["calibration"] == ["t1", "t2", "t3"] and "noise" not in again


def spring_case(folder: Path) -> Path:
    """A begun case of a function that asks for a number: it leaves open which columns are outputs, and their units."""
    data, time = folder / "data", 0.02 * np.arange(60)
    data.mkdir()
    for k in range(1, 5):
        angle = 0.2 * np.sin((2 + k) * time)
        rows = np.column_stack([time, angle, 50.0 * angle])
        np.savetxt(data / f"t{k}.csv", rows, delimiter=",", header="time [s],x [rad],M [N m]", comments="")
    (folder / "spring.py").write_text('def run(time, inputs, numbers):\n    return numbers["k"] * inputs[0]\n')
    gc.init_gap_case(simulator=str(folder / "spring.py"), data=data).write(folder / "case")
    return folder / "case"


SPRING = {"k": AnsweredNumber(50.0, 10.0, 200.0, "N m/rad")}


def test_questions_without_an_answer_stay(tmp_path: Path) -> None:
    """Those of outputs and units are shown and kept, those of numbers and noise are answered."""
    case = spring_case(tmp_path)
    questions = begun_settings(case)[QUESTIONS]
    assert [each.partition("?")[0] for each in questions] == [
        "are M the outputs",
        "does run take time in s, inputs[0] = x in rad, and give M in N m",
    ]
    for _ in range(2):  # a second answer changes nothing
        answer_case(case, ["t4"], SPRING, {"M": 0.1})
        text = (case / "case.toml").read_text("utf-8")
        head, *comments = [line for line in text.splitlines() if line.startswith("#")]
        assert head.startswith("# Open questions") and text.startswith(head)
        assert [line.partition(". ")[2] for line in comments] == questions == begun_settings(case)[QUESTIONS]
    for line in comments:  # deleted by hand
        text = text.replace(f"{line}\n", "")
    (case / "case.toml").write_text(text)
    answer_case(case, ["t4"], SPRING, {})
    assert "#" not in (case / "case.toml").read_text("utf-8") and begun_settings(case)[QUESTIONS] == []


def test_what_was_written_by_hand_stays(tmp_path: Path) -> None:
    """Sections and keys of others; what cannot be kept line by line, and numbers nobody answers, are refused."""
    case = spring_case(tmp_path)
    file = case / "case.toml"
    by_hand = '[constants] # SI\nm = 2.5\n# 1. weighed\n\n[trial.t2]\nlevel = 0.5\ncondition = "[a]"\n\n'
    begun = file.read_text("utf-8")
    for place in ("[noise]", "[parameters.k]"):
        file.write_text(begun.replace(place, by_hand + place))
        answer_case(case, ["t4"], SPRING, {"M": 0.1})
        assert file.read_text("utf-8").count("# 1. weighed") == 1
        found = tomllib.loads(file.read_text("utf-8"))
        assert found["constants"] == {"m": 2.5} and found["trial"] == {"t2": {"level": 0.5, "condition": "[a]"}}
        assert found["noise"] == {"M": 0.1} and list(found["parameters"]) == ["k"] and "# SI" in file.read_text("utf-8")
    file.write_text(begun)
    answer_case(case, ["t4"], SPRING, {"M": 0.1})
    done = file.read_text("utf-8")
    for text, words in (
        (f"{done}\n[parameters.c]\nstart = 1.0\nfixed = true\n", "parameters.c.*not among the numbers"),
        (f"noise.M = 0.2\n{done.replace('[noise]', '').replace('M = 0.1', '')}", "line by line"),
        (done.replace('evaluation = ["t4"]', 'evaluation = [\n  "t4",\n]'), "line by line"),
        (f"{done}\n[open", "is not TOML"),
    ):
        file.write_text(text)
        with pytest.raises(gc.InputError, match=words):
            answer_case(case, ["t4"], SPRING, {})
        assert file.read_text("utf-8") == text


def test_a_unit_that_is_asked_for_is_not_left_empty(tmp_path: Path) -> None:
    case = spring_case(tmp_path)
    before = (case / "case.toml").read_text("utf-8")
    with pytest.raises(gc.InputError, match=r"\[parameters.k\].*unit is missing"):
        answer_case(case, ["t4"], {"k": AnsweredNumber(50.0, None, None, " ")}, {})
    assert (case / "case.toml").read_text("utf-8") == before
    answer_case(case, ["t4"], {"k": AnsweredNumber(50.0, None, None, "-")}, {})


def test_any_error_leaves_the_case_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = spring_case(tmp_path)
    before = (case / "case.toml").read_bytes()

    def ended(*_: object, **__: object) -> None:
        assert (case / "case.toml").read_bytes() != before
        raise KeyboardInterrupt

    monkeypatch.setattr("geocontact.analyses.gap.init.answers.read_gap_case", ended)
    with pytest.raises(KeyboardInterrupt):
        answer_case(case, ["t4"], SPRING, {})
    assert (case / "case.toml").read_bytes() == before


def test_columns_keep_their_numbers_and_units_are_not_guessed(tmp_path: Path) -> None:
    file = knee_trials(tmp_path / "raw") / "t1.csv"
    assert recorded_columns(file) == [
        ("flexion", "deg"), ("add", ""), ("A_med", "mm^2"), ("A_lat", "mm^2"), ("F_med", ""), ("F_lat", "")
    ]  # fmt: skip
    write_chosen(file, CHOSEN, tmp_path / "out.csv")
    head, *rows = (tmp_path / "out.csv").read_text("utf-8").splitlines()
    assert head == (
        "time [s],flexion [deg],adduction [deg],area_medial [mm^2],area_lateral [mm^2],"
        "force_medial [kN],force_lateral [kN]"
    )
    given = np.loadtxt(file, delimiter=",", skiprows=1)
    assert (np.array([[float(cell) for cell in row.split(",")] for row in rows]) == given).all()
    for wrong, words in (
        (ChosenColumn("gone", "x", "N"), "no column 'gone'"),
        (ChosenColumn("F_med", "x", ""), "has no unit"),
        (ChosenColumn("flexion", "x", "rad"), "is in deg, not in rad"),
    ):
        with pytest.raises(gc.InputError, match=words):
            write_chosen(file, [wrong], tmp_path / "wrong.csv")
    with pytest.raises(gc.InputError, match="two columns are the channel x"):
        write_chosen(file, [ChosenColumn("F_med", "x", "N"), ChosenColumn("F_lat", "x", "N")], tmp_path / "wrong.csv")
    percent = tmp_path / "percent.csv"
    percent.write_text("time [%],force [N]\n0,1\n50,2\n100,3\n")
    with pytest.raises(gc.InputError, match="per cent"):
        recorded_columns(percent)


def trial_of(folder: Path, head: str, chosen: ChosenColumn, name: str = "t.csv") -> str:
    """Header of the trial that is written from a recording with this head."""
    file = folder / name
    rows = ("0 10", "0.5 20", "1 30")
    file.write_text("\n".join([head, *(row if name.endswith("o") else row.replace(" ", ",") for row in rows)]) + "\n")
    write_chosen(file, [chosen], folder / "out.csv")
    return (folder / "out.csv").read_text("utf-8").partition("\n")[0]


def test_a_unit_that_one_file_states_is_not_taken_for_another_that_states_none(tmp_path: Path) -> None:
    """`stated` is what the first file says: deg, nothing, or a word that is no known unit."""
    deg, none, word = (ChosenColumn("knee", "knee", "deg", stated) for stated in ("deg", "", "degrees"))
    assert trial_of(tmp_path, "time [s],knee [deg]", deg) == "time [s],knee [deg]"
    assert trial_of(tmp_path, "time [s],knee [rad]", deg) == "time [s],knee [rad]"  # each states its own: 10 rad stay
    assert trial_of(tmp_path, "time [s],knee", none) == "time [s],knee [deg]"
    assert trial_of(tmp_path, "time [s],knee [°]", none) == "time [s],knee [°]"
    assert trial_of(tmp_path, "time [s],knee [degrees]", word) == "time [s],knee [deg]"
    for head, chosen, words in (
        ("time [s],knee", deg, "column knee has no unit; in the first file it is in 'deg'"),
        ("time [s],knee", word, "column knee has no unit; in the first file it is in 'degrees'"),
        ("time [s],knee [degrees]", none, "column knee is in 'degrees'; in the first file it has none"),
        ("time [s],knee [radians]", word, "column knee is in 'radians'; in the first file it is in 'degrees'"),
        ("time [s],knee [rad]", none, "column knee is in rad, not in deg"),
        ("time [s],knee [rad]", word, "column knee is in rad, not in deg"),
        ("time [s],knee [N]", deg, "column knee is in N, not in deg"),
    ):
        with pytest.raises(gc.InputError, match=words):
            trial_of(tmp_path, head, chosen)


@pytest.mark.parametrize(("flag", "said", "other"), [("yes", "deg", "rad"), ("no", "rad", "deg")])
def test_angles_are_in_the_unit_of_the_header(tmp_path: Path, flag: str, said: str, other: str) -> None:
    head = f"name\nversion=1\nnRows=3\nnColumns=2\ninDegrees={flag}\nendheader\ntime knee"
    for rate in ("", "/s", "/s^2"):
        for unit in (f"{said}{rate}", "N", "rpm"):
            assert trial_of(tmp_path, head, ChosenColumn("knee", "x", unit), "t.sto") == f"time [s],x [{unit}]"
        wrong = ChosenColumn("knee", "x", f"{other}{rate}")
        with pytest.raises(gc.InputError, match=f"line 5: 'inDegrees={flag}' says that angles are in {said}") as caught:
            trial_of(tmp_path, head, wrong, "t.sto")
        assert f"choose {said}{rate}, or" in str(caught.value)
    silent = head.replace(f"inDegrees={flag}\n", "")
    assert trial_of(tmp_path, silent, ChosenColumn("knee", "x", other), "t.sto") == f"time [s],x [{other}]"


def test_every_unit_that_is_offered_can_be_read(tmp_path: Path) -> None:
    """Those of angular speed, length in cm and stiffness among them; 10 of each in the trial."""
    assert {"cm", "rad/s", "deg/s", "N m/rad", "m/s^2"} <= set(UNITS) and not is_known("degrees") and not is_known("")
    for unit in UNITS:
        trial_of(tmp_path, "time [s],a", ChosenColumn("a", "a", unit))
        column = read_trial(tmp_path / "out.csv")
        assert column.signals.column("a")[0] == pytest.approx(10.0 * column.column("a").factor), unit
    given = np.radians(10.0)
    trial_of(tmp_path, "time [s],a", ChosenColumn("a", "a", "deg/s"))
    assert read_trial(tmp_path / "out.csv").signals.column("a")[0] == pytest.approx(given)


def test_a_shipped_model_has_channels_of_its_own_and_asks_for_its_numbers(tmp_path: Path) -> None:
    raw, data = knee_trials(tmp_path / "raw"), tmp_path / "data"
    data.mkdir()
    for file in raw.glob("*.csv"):
        write_chosen(file, CHOSEN, data / file.name)
    with pytest.raises(gc.InputError, match=r"knee needs R \[m\], E_star \[Pa\]; give each"):
        gc.init_gap_case(simulator="knee", data=data)
    with pytest.raises(gc.InputError, match="channels of the model knee are"):
        gc.init_gap_case(simulator="knee", data=data, outputs="force_medial")
    with pytest.raises(gc.InputError, match=r"there is no file 'ankle'.*elbow, foot, shoulder, knee"):
        gc.init_gap_case(simulator="ankle", data=data)
    (tmp_path / "s.csv").write_text("px [m]\n1\n")
    with pytest.raises(gc.InputError, match="knee has no table spheres; it takes none"):
        gc.init_gap_case(simulator="knee", data=data, table=(f"spheres={tmp_path / 's.csv'}",))
    swapped = (ChosenColumn("A_med", "flexion", "mm^2"), *CHOSEN[1:2], ChosenColumn("flexion", "area_medial", "deg"))
    for file in data.glob("*.csv"):
        write_chosen(tmp_path / "raw" / file.name, (*swapped, *CHOSEN[3:]), file)
    with pytest.raises(gc.InputError, match=r"needs flexion in rad, the trials give m\^2"):
        gc.init_gap_case(simulator="knee", data=data, number={"E_star": 5e6, "R": RADIUS})


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.slow] * (n == "shoulder")) for n in MODELS])
def test_every_model_of_the_package_can_be_begun(name: str, tmp_path: Path) -> None:
    """A sixth of what was measured is missed; with answers the case is the one that was written by hand."""
    hand = tmp_path / "hand"
    case = written(name, hand)
    trials = (*case.calibration, *case.evaluation)
    numbers = case.constants | {each.name: each.start for each in case.parameters}
    numbers |= {f"{one.name}.{key}": value for one in trials for key, value in one.covariates.items()}
    asked = {"simulator": name, "data": hand / "trials", "table": [f"{each}={hand / each}.csv" for each in case.tables]}
    for lacking in (next(iter(numbers)), list(numbers)[-1]):
        some = {each: value for each, value in numbers.items() if each != lacking}
        with pytest.raises(gc.InputError, match=rf"needs {lacking}( |;)"):
            gc.init_gap_case(**asked, number=some)
    if case.tables:
        with pytest.raises(gc.InputError, match=f"needs a table .* give it as {next(iter(case.tables))}="):
            gc.init_gap_case(**{**asked, "table": ()}, number=numbers)
    result = gc.init_gap_case(**asked, number=numbers)
    for trial in trials:
        for channel, error in result.errors[trial.name].items():
            size = float(np.sqrt(np.nanmean(trial.column(channel) ** 2)))
            assert size > 0.0 and error == pytest.approx(size / 6.0, rel=1e-6), (trial.name, channel)
    result.write(tmp_path / "case")
    begun_units = {each: one["unit"] for each, one in begun_settings(tmp_path / "case")["parameters"].items()}
    assert begun_units.items() >= {each.name: each.unit for each in case.parameters}.items()
    answers = {each: AnsweredNumber(value, None, None, begun_units[each]) for each, value in case.constants.items()}
    answers |= {each.name: AnsweredNumber(each.start, each.lower, each.upper, each.unit) for each in case.parameters}
    for _ in range(2):  # a second answer takes the place of the first
        answer_case(tmp_path / "case", ["t3", "t4"], answers, {})
    made, by_hand = (tomllib.loads((each / "case.toml").read_text("utf-8")) for each in (tmp_path / "case", hand))
    assert made == by_hand
    for one, other in zip(case.calibration, gc.read_gap_case(tmp_path / "case").calibration, strict=True):
        assert other.signals.values == pytest.approx(one.signals.values, rel=1e-8, nan_ok=True)


def test_what_a_model_does_not_know_is_refused(tmp_path: Path) -> None:
    """A misspelled number, one of a trial that is not there; a column beside the channels asks for nothing."""
    case = written("sit_to_stand", tmp_path)
    numbers = case.constants | {each.name: each.start for each in case.parameters}
    asked = {"simulator": "sit_to_stand", "data": tmp_path / "trials"}
    for wrong in ("rho_thig", "t9.level", "t1.level"):
        with pytest.raises(gc.InputError, match=f"sit_to_stand has no number {wrong}; it has k_n_thigh, rho_thigh, b"):
            gc.init_gap_case(**asked, number=numbers | {wrong: 1.0})
    for file in (tmp_path / "trials").glob("*.csv"):
        head, *rows = file.read_text("utf-8").splitlines()
        file.write_text("\n".join([f"{head},shank_length [m]", *(f"{row},0.4" for row in rows)]) + "\n", "utf-8")
    assert gc.init_gap_case(**asked, number=numbers).errors["t1"]["thigh_force"] > 0.0


@pytest.mark.parametrize(
    ("numbers", "refusal"),
    [
        ({"k": 3.0, "t1.level": 1.0, "level": 2.0}, "level is given for all trials and for t1"),
        ({"k": 3.0, "t1.level": 1.0, "t3.level": 1.0}, r"needs t2\.level, t4\.level"),
        ({"k": 3.0, "t2.level": 1.0, "t3.level": 1.0, "t4.level": 1.0}, r"needs t1\.level"),
        ({"k": 3.0, "level": 2.0, "t1.c": 1.0}, "c is given for all trials and for t1"),
        ({"k": float("nan")}, "`number`: is k=nan"),
        ({"t1.level": float("inf")}, r"`number`: is t1\.level=inf"),
        ({"t1.": 1.0}, r"`number`: is t1\.=1"),
    ],
)
def test_a_number_is_that_of_all_trials_or_of_each(numbers: dict[str, float], refusal: str, tmp_path: Path) -> None:
    """That of all would be taken without a word; c is declared in the file."""
    written("sit_to_stand", tmp_path)
    model = tmp_path / "level_model.py"
    model.write_text(
        'import geocontact as gc\nPARAMETERS = (gc.Parameter("c", "N/m", 1.0),)\n'
        'def run(time, inputs, numbers):\n    return numbers["k"] * numbers["level"] * inputs[0]\n'
    )
    asked = {"simulator": str(model), "data": tmp_path / "trials", "outputs": "thigh_force"}
    with pytest.raises(gc.InputError, match=refusal):
        gc.init_gap_case(**asked, number=numbers)


def test_a_table_is_no_other_key_of_the_case(tmp_path: Path) -> None:
    """Its name is a key of case.toml and that of a file in the folder."""
    written("sit_to_stand", tmp_path)
    (tmp_path / "s.csv").write_text("px [m]\n1\n")
    model = tmp_path / "no_model.py"
    model.write_text("def run(time, inputs, numbers):\n    return inputs[0]\n")
    asked = {"simulator": str(model), "data": tmp_path / "trials", "outputs": "thigh_force"}
    for name in ("calibration", "system", "trial", "tables", "first_run", "1st"):
        with pytest.raises(gc.InputError, match=f"`table`: is '{name}="):
            gc.init_gap_case(**asked, table=(f"{name}={tmp_path / 's.csv'}",))
    with pytest.raises(gc.InputError, match=r"`table`: names own twice"):
        gc.init_gap_case(**asked, table=(f"own={tmp_path / 's.csv'}",) * 2)


def test_an_answer_in_another_unit_than_the_model_takes_is_refused(tmp_path: Path) -> None:
    """27 mm would be 27 m: nothing is converted by the unit of a number."""
    case = written("sit_to_stand", tmp_path / "hand")
    numbers = case.constants | {each.name: each.start for each in case.parameters}
    begun = gc.init_gap_case(simulator="sit_to_stand", data=tmp_path / "hand" / "trials", number=numbers)
    begun.write(tmp_path / "case")
    said = begun_settings(tmp_path / "case")["parameters"]
    answers = {name: AnsweredNumber(one["start"], None, None, one["unit"]) for name, one in said.items()}
    for upper in (None, 50.0):
        lower = None if upper is None else 1.0
        answers["rho_thigh"] = AnsweredNumber(20.0, lower, upper, "mm")
        with pytest.raises(gc.InputError, match=r"parameters.rho_thigh\]: is answered in mm; give it in m"):
            answer_case(tmp_path / "case", ["t3", "t4"], answers, {})


def test_units_of_channels_are_declared_for_all_models() -> None:
    """Those of the built system, for each model whose numbers need no table."""
    for base in SYSTEMS:
        assert base.needs is not None and set(base.needs.units) == {*base.inputs, *base.outputs}
        if not base.needs.tables:
            numbers = base.needs.numbers(base.inputs, {})
            system = base.build(tuple(gc.Parameter(each, unit, 1.0) for each, unit in numbers.items()), {}, {})
            assert {name: system.unit(name) for name in base.needs.units} == base.needs.units
