"""Errors of a simulated arm beside recordings whose errors are known."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.io.text.side_table import LARGEST_RESULT, LARGEST_TABLE
from tests.shoulder_exoskeleton.arms import raised

TIME = np.arange(601) * 0.01
PHASE = np.select([TIME < 0.8, TIME < 2.2, TIME < 4.0, TIME < 5.2], ["rest", "lift", "screw-in", "lower"], "rest")


def simulated(folder: Path) -> Path:
    """A simulated arm of which the comparison reads four columns."""
    angle = np.degrees(raised(TIME))
    columns = {"time [s]": TIME, "phase": PHASE, "elevation [deg]": angle, "supporting [N]": 0.2 * angle}
    file = folder / "right.csv"
    pd.DataFrame(columns).to_csv(file, index=False)
    return file


def recorded(folder: Path, late: float = 0.0, **columns: np.ndarray) -> Path:
    file = folder / "recorded.csv"
    pd.DataFrame({"time [s]": TIME + late, **columns}).to_csv(file, index=False)
    return file


def test_errors_are_those_that_were_put_in_phase_by_phase(tmp_path: Path) -> None:
    """3 degrees too high while screwing, 1 else; the force 2 N too low everywhere."""
    angle = np.degrees(raised(TIME))
    file = recorded(
        tmp_path,
        **{"exo [deg]": angle + np.where(PHASE == "screw-in", 3.0, 1.0), "mat [N]": 0.2 * angle - 2.0},
    )
    found = gc.shoulder.compare(simulated(tmp_path), file, map="elevation=exo,force=mat")
    table = found.table().set_index(["channel", "phase"])
    for phase, error in (("lift", 1.0), ("screw-in", 3.0), ("lower", 1.0)):
        assert table.loc[("elevation", phase), "mae"] == pytest.approx(error, abs=1e-9)
        assert table.loc[("elevation", phase), "bias"] == pytest.approx(-error, abs=1e-9)
    counts = {phase: int(np.sum(phase == PHASE)) for phase in ("lift", "screw-in", "lower")}
    work = (counts["lift"] + counts["lower"] + 3.0 * counts["screw-in"]) / sum(counts.values())
    assert table.loc[("elevation", "work"), "mae"] == pytest.approx(work, abs=1e-9)
    assert table.loc[("force", "all"), "rmsd"] == pytest.approx(2.0, abs=1e-9)
    assert table.loc[("force", "all"), "samples"] == 601
    assert found.sentences[0].startswith("elevation, all: MAE 1.6")


def test_passive_joints_that_were_measured_are_a_channel(tmp_path: Path) -> None:
    """2 degrees too far out, with the sign that the encoder has; a simulated table without them is refused."""
    first, second = 30.0 * np.sin(TIME), -20.0 * np.cos(0.7 * TIME)
    plain = simulated(tmp_path)
    file = recorded(tmp_path, **{"encoder [deg]": -(first + 2.0), "passive_2 [deg]": second})
    with pytest.raises(gc.InputError, match=r"no column passive_1"):
        gc.shoulder.compare(plain, file, map="passive_1=-encoder")
    table = pd.read_csv(plain).assign(**{"passive_1 [deg]": first, "passive_2 [deg]": second})
    table.to_csv(plain, index=False)
    found = gc.shoulder.compare(plain, file, map="passive_1=-encoder")
    errors = found.table().set_index(["channel", "phase"])
    assert errors.loc[("passive_1", "all"), ["unit", "bias"]].tolist() == ["deg", pytest.approx(-2.0, abs=1e-9)]
    assert errors.loc[("passive_2", "work"), "rmsd"] == pytest.approx(0.0, abs=1e-9)
    assert [panel.title for panel in found.curves()["comparison"].panels] == ["Passive_1", "Passive_2"]


def test_a_late_clock_is_set_right(tmp_path: Path) -> None:
    file = recorded(tmp_path, late=0.5, **{"elevation [deg]": np.degrees(raised(TIME))})
    with pytest.warns(gc.InputWarning) as seen:  # a clock that is a quarter of a second late is warned of as well
        both = [gc.shoulder.compare(simulated(tmp_path), file, delay=delay) for delay in (0.5, 0.25)]
    assert any("96% of the simulated time was recorded" in str(each.message) for each in seen)
    assert any("0.25 s late: is its clock right? give `delay` 0.50s" in str(each.message) for each in seen)
    assert both[0].table()["mae"].max() < 1e-9
    assert both[1].table()["mae"][0] > 1.0
    assert both[1].table()["lag [s]"][0] == pytest.approx(-0.25, abs=0.01)


@pytest.mark.parametrize(
    ("columns", "options", "words"),
    [
        (
            {"angle [deg]": TIME},
            {},
            "no column elevation, force, passive_1, passive_2, normal, shear, shear_along or shear_around; columns are",
        ),
        ({"elevation [deg]": TIME}, {"map": "force=mat"}, "no column 'mat' for force"),
        ({"elevation [deg]": TIME}, {"delay": 100.0}, "the simulation from 0 to 6 s; give `delay`"),
    ],
)
def test_what_cannot_be_compared_is_refused(
    tmp_path: Path, columns: dict[str, np.ndarray], options: dict[str, object], words: str
) -> None:
    with pytest.raises(gc.InputError) as told:
        gc.shoulder.compare(simulated(tmp_path), recorded(tmp_path, **columns), **options)
    assert words in str(told.value)


def test_another_table_is_no_simulated_arm(tmp_path: Path) -> None:
    file = recorded(tmp_path, **{"elevation [deg]": TIME})
    with pytest.raises(gc.InputError, match=r"no column phase; give right\.csv or left\.csv"):
        gc.shoulder.compare(file, file)


def test_files_and_page(tmp_path: Path) -> None:
    file = recorded(tmp_path, **{"elevation [deg]": np.degrees(raised(TIME)) + 1.0})
    folder = gc.shoulder.compare(simulated(tmp_path), file).write(tmp_path / "result")
    assert {"comparison.csv", "comparison.png", "report.html"} <= {each.name for each in folder.iterdir()}
    assert "Errors by channel and phase" in (folder / "report.html").read_text(encoding="utf-8")


def test_a_sphere_out_of_the_cuff_is_told_in_every_sentence(tmp_path: Path) -> None:
    file = simulated(tmp_path)
    table = pd.read_csv(file)
    table["out of the cuff"] = (TIME < 1.2).astype(int)
    table.to_csv(file, index=False)
    with pytest.warns(gc.InputWarning, match="doubtful: the sphere is out of the cuff for 20% of the time"):
        found = gc.shoulder.compare(file, recorded(tmp_path, **{"elevation [deg]": np.degrees(raised(TIME))}))
    assert len(found.sentences) == 2
    assert all(line.endswith("deg; the sphere is out of the cuff for 20% of the time") for line in found.sentences)


def test_a_column_of_words_is_left_out_of_a_recording(tmp_path: Path) -> None:
    """The table of `shoulder simulate` itself has one, the work phase."""
    angle = np.degrees(raised(TIME))
    file = recorded(tmp_path, phase=PHASE, **{"elevation [deg]": angle + 1.0, "force [N]": 0.2 * angle + 0.5})
    table = gc.shoulder.compare(simulated(tmp_path), file).table().set_index(["channel", "phase"])
    assert table.loc[("elevation", "all"), "mae"] == pytest.approx(1.0, abs=1e-9)
    with pytest.raises(gc.InputError, match="column 'phase' holds words, no force"):
        gc.shoulder.compare(simulated(tmp_path), file, map="force=phase")


@pytest.mark.parametrize("row", [0, 300])
def test_a_damaged_number_is_no_column_of_words(tmp_path: Path, row: int) -> None:
    angle = np.degrees(raised(TIME)).astype(str).astype(object)
    angle[row] = "12.5x"
    file = recorded(tmp_path, **{"elevation [deg]": angle})
    with pytest.raises(gc.InputError, match=r"'12\.5x' in column 'elevation' is not a number"):
        gc.shoulder.compare(simulated(tmp_path), file)


@pytest.mark.parametrize(
    ("factor", "shift", "words"),
    [
        (-1.0, 0.0, r"force: R² is -\d.*: is a sign turned"),
        (1e-3, 0.0, r"force: R² is -\d.*recorded values are 0\.001 times the simulated ones: is the unit right"),
        (1.0, 15.0, r"force: R² is -\d.*a constant would fit better"),
    ],
)
def test_a_recording_that_cannot_be_meant_is_warned_of(tmp_path: Path, factor: float, shift: float, words: str) -> None:
    """A force turned round, in kN under [N], and with an offset larger than its spread."""
    angle = np.degrees(raised(TIME))
    file = recorded(tmp_path, **{"elevation [deg]": angle, "force [N]": factor * 0.2 * angle + shift})
    with pytest.warns(gc.InputWarning, match=words):
        gc.shoulder.compare(simulated(tmp_path), file)


def test_an_hour_of_results_is_read(tmp_path: Path) -> None:
    """More than other tables may hold."""
    file, angle = simulated(tmp_path), np.degrees(raised(TIME))
    file.write_text(("#" + 998 * " " + "\n") * (LARGEST_TABLE // 1000 + 1) + file.read_text("utf-8"), "utf-8")
    table = gc.shoulder.compare(file, recorded(tmp_path, **{"elevation [deg]": angle + 1.0})).table()
    assert LARGEST_TABLE < file.stat().st_size < LARGEST_RESULT and table["mae"][0] == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("late", [1.0, -0.8])
def test_a_clock_that_is_off_is_warned_of_with_its_delay(tmp_path: Path, late: float) -> None:
    """The delay that the warning names sets the clock right: the error is that of a tenth of a sample then."""
    file = recorded(tmp_path, late=late, **{"elevation [deg]": np.degrees(raised(TIME))})
    with pytest.warns(gc.InputWarning) as seen:
        gc.shoulder.compare(simulated(tmp_path), file)
    named = next(found[1] for each in seen if (found := re.search(r"give `delay` (\S+)", str(each.message))))
    assert float(named.rstrip("s")) == pytest.approx(late, abs=0.02)


def test_a_recording_that_fits_has_no_warning(tmp_path: Path) -> None:
    angle = np.degrees(raised(TIME))
    found = gc.shoulder.compare(simulated(tmp_path), recorded(tmp_path, **{"elevation [deg]": angle + 1.0}))
    assert not found.warnings


def test_the_headline_has_both_channels(tmp_path: Path) -> None:
    """Elevation 1 degree too high in the recording, force 2 N too low."""
    angle = np.degrees(raised(TIME))
    file = recorded(tmp_path, **{"elevation [deg]": angle + 1.0, "force [N]": 0.2 * angle - 2.0})
    page = gc.shoulder.compare(simulated(tmp_path), file).pages({})["report.html"]
    assert page.headline[0].startswith("The simulation misses the elevation by 1° and the force by 2 N")
    assert any(label.startswith("force") and "2 N" in value for label, value in page.facts)
