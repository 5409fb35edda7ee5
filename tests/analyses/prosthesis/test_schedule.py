"""A semi-active foot over two strides: stance for stance what a fixed fulcrum gives, numbers by hand, refusals."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.foot_file import read_foot
from geocontact.analyses.prosthesis.foot_writer import write_foot
from geocontact.analyses.prosthesis.simulate import strides as room
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.result import ProsthesisSimulateResult, _doubt, against_each, beside_words
from geocontact.analyses.prosthesis.simulate.strides import of_longest, scheduled, worst_first
from geocontact.analyses.prosthesis.simulate.walk import read, walk_of
from geocontact.below_knee_prosthesis.evaluation import stance_errors
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.identify.signals.cycles import loaded_spans
from tests.analyses.prosthesis.strides_trial import TRIAL, written
from tests.below_knee_prosthesis.stances import a_stance
from tests.below_knee_prosthesis.test_stance_errors import plate_of, walked
from tests.recording import opened

GIVEN: dict[str, Any] = {
    "static": TRIAL / "standing.trc",
    "mass": 77.3,
    "other_plate": "other_force",
    "plate": "own_force",
    "socket_turns": 0,
}
ONE = {"markers": TRIAL / "walking.trc", "plates": TRIAL / "plates.mot"}


def schedule(folder: Path, text: str) -> Path:
    (folder / "schedule.csv").write_text(text)
    return folder / "schedule.csv"


def simulated(files: dict[str, Path], **more: Any) -> ProsthesisSimulateResult:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        return gc.prosthesis.simulate(files["markers"], plates=files["plates"], **(GIVEN | more))


@pytest.fixture(scope="module")
def strides(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return written(tmp_path_factory.mktemp("strides"))


@pytest.mark.slow
def test_each_stride_is_that_of_its_fixed_fulcrum(strides: dict[str, Path], tmp_path: Path) -> None:
    """Low, then medium, beside both settings alone over the same two strides, to the bit."""
    two = simulated(strides, schedule=schedule(tmp_path, "stride [-],setting\n1,low\n2,medium\n"))
    for k, setting in enumerate(("low", "medium")):
        fixed = simulated(strides, schedule=schedule(tmp_path, f"stride [-],setting\n1,{setting}\n"))
        np.testing.assert_array_equal(two.strides[k].limb.stance.force, fixed.strides[k].limb.stance.force)
        np.testing.assert_array_equal(two.strides[k].limb.stance.stored, fixed.strides[k].limb.stance.stored)
    table = two.table("strides")
    assert re.search(
        r"^against the plate \(stride [12] of 2, the longest\): R²", "\n".join(two.sentences), re.MULTILINE
    )
    assert all(any(line.startswith(f"stride {k}: the socket's motion") for line in two.warnings) for k in (1, 2))
    assert list(table["setting"]) == ["low", "medium"]
    assert table["touch-down [s]"].diff()[1] == pytest.approx(1.2, abs=2e-3)
    assert table["moved [mm]"].tolist() == pytest.approx([0.0, 1e3 * (two.strides[1].walk.fulcrum - 0.066)])
    swing = table["touch-down [s]"][1] - table["toe-off [s]"][0]
    assert table["needed speed [mm/s]"][1] == pytest.approx(table["moved [mm]"][1] / swing)
    s = two.strides[0].limb.stance
    lost, peak = 0.002 * np.concatenate([[0.0], np.cumsum(_damping(s))]), int(np.argmax(s.stored))
    returned = s.stored[peak] - s.stored[-1] - lost[-1] + lost[peak]
    assert table["returned [J]"][0] == pytest.approx(returned, rel=1e-6)
    pressing, x = s.force[:, 1] >= 20.0, s.poses.rotation.apply([1.0, 0.0, 0.0])
    way = np.einsum("ti,ti->t", s.centre("ground") - s.poses.translation, x)[pressing]
    assert table["cop travel [mm]"][0] == pytest.approx(1e3 * np.ptp(way), rel=1e-9)
    assert table["returned [J]"][0] > 1.5 * table["returned [J]"][1]  # a softer keel stores more


def _damping(s: Any) -> np.ndarray:
    """Mean power of the keel's dampers between samples [W], 2 ms stiffnesses."""
    power = (s.found.u[:, 8:] ** 2 * (0.002 * s.foot.keel.stiffness(s.fulcrum))).sum(axis=1)
    return np.asarray(0.5 * (power[1:] + power[:-1]))


def with_a_longer_third(files: dict[str, Path], folder: Path) -> Path:
    """Plates that go on with the first stance once more, after the markers have ended; both others end 10 ms sooner."""
    lines = files["plates"].read_text().splitlines()
    names, rows = lines[6].split("\t"), np.array([[float(x) for x in line.split("\t")] for line in lines[7:] if line])
    own, step = [name.startswith("own_force_v") for name in names], rows[1, 0] - rows[0, 0]
    rest = np.repeat(rows[-1:], round(3.6 / step) - len(rows), axis=0)
    rest[:, 0] += step * np.arange(1, len(rest) + 1)
    third = (rest[:, 0] >= 2.4) & (rest[:, 0] < 3.3)
    rest[np.ix_(~third, own)] = 0.0
    rest[np.ix_(third, own)] = rows[: third.sum()][:, own]
    for span in loaded_spans(rows[:, 0], rows[:, names.index("own_force_vy")], 20.0):
        rows[np.ix_((rows[:, 0] > span.end - 0.01) & (rows[:, 0] < span.end + 0.1), own)] = 0.0
    lines[2] = f"nRows={len(rows) + len(rest)}"
    text = ["\t".join(f"{x:.4f}" for x in row) for row in np.vstack([rows, rest])]
    (folder / "longer.mot").write_text("\n".join([*lines[:7], *text, ""]))
    return folder / "longer.mot"


def test_a_stance_that_the_markers_do_not_cover_is_left_out(
    strides: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is the longest on the plate: tests and parts are of those that are covered. Nothing is simulated."""
    given = GIVEN | {"plates": with_a_longer_third(strides, tmp_path)}
    record = opened(Record("prosthesis simulate", {}))
    fixed = ProsthesisSimulateOptions(strides["markers"], **given)
    with pytest.raises(gc.InputError, match=r"the stance on own_force is from 2\.5"):
        walk_of(read(fixed), fixed)
    rows = schedule(tmp_path, "stride [-],setting\n1,low\n2,medium\n9,high\n")
    o = ProsthesisSimulateOptions(strides["markers"], **given, schedule=rows)
    recorded = read(o)
    assert recorded.schedule is not None
    monkeypatch.setattr(room, "simulated", lambda *_: SimpleNamespace(stance=None))
    monkeypatch.setattr(room, "stance_errors", lambda *_: None)
    found = scheduled(walk_of(recorded, o), recorded.schedule, o)
    assert [each.stride.place.name for each in found] == ["low", "medium"]
    for one in found:
        down, off = one.stride.stance
        assert one.walk.span == pytest.approx((down - 0.12, off + 0.1), abs=0.06)
    assert "1 of 3 stances on own_force are not covered by the markers" in record.warnings
    assert "rows by stride that none of 2 strides comes to: high from 9" in record.warnings


def test_every_stride_is_judged_and_named_worst_first() -> None:
    """Made-up forces: half as large in the second stride, which a constant describes better, and cut short."""
    time, plate = np.arange(0.0, 0.95, 0.002), plate_of(np.arange(-0.2, 1.2, 0.002))
    stances = [a_stance(time, walked(time)), a_stance(time[:300], 0.1 * walked(time[:300]))]
    two: Any = [
        SimpleNamespace(
            stride=SimpleNamespace(number=k, stance=(0.1, 0.8 if k == 1 else 0.7)),
            walk=SimpleNamespace(plate=plate),
            limb=SimpleNamespace(stance=stance, settled=True),
            errors=stance_errors(stance, plate),
        )
        for k, stance in enumerate(stances, start=1)
    ]
    assert [each.stride.number for each in worst_first(two)] == [2, 1]
    fit = against_each(two)
    assert fit.outcome == "contradicts"
    # the made-up foot stands still, and its centre of pressure with it
    assert [doubt.what.partition(": ")[0] for doubt in fit.doubts] == [
        "stride 2, resultant force",
        "stride 2, centre of pressure",
        "stride 2, the simulation has ended for 29% of the plate's stance",
        "stride 1, centre of pressure",
    ]
    record, asked = opened(Record("prosthesis simulate", {})), ProsthesisSimulateOptions(**(GIVEN | ONE))
    _doubt({f"stride {each.stride.number}": each.limb for each in worst_first(two)}, asked)
    still = [line for line in record.warnings if "still on the floor" in line]
    assert len(still) == 1 and still[0].startswith("stride 2: ")
    longest, which = of_longest(two)
    assert longest is two[0] and which == " (stride 1 of 2, the longest)"
    assert beside_words(longest.errors, which).startswith("against the plate (stride 1 of 2, the longest): R² 1.00")


@pytest.mark.slow
def test_a_constant_schedule_is_the_fixed_fulcrum(tmp_path: Path) -> None:
    """Every table but that of the strides, to the bit."""
    fixed = simulated(ONE, setting="low")
    found = simulated(ONE, schedule=schedule(tmp_path, "speed [m/s],setting\n0,low\n"))
    assert set(found.tables()) - set(fixed.tables()) == {"strides"}
    for name, table in fixed.tables().items():
        assert table.equals(found.table(name)), name
    found.write(tmp_path / "out")
    assert (tmp_path / "out" / "strides.csv").is_file()


@pytest.mark.parametrize(
    ("rows", "more", "words"),
    [
        ("time [s],setting\n-1,low\n0.4,medium\n", {}, "schedule.csv time: moves the fulcrum to medium at 0.40 s, in"),
        ("stride [-],setting\n1,low\n2,middle\n", {}, "row 2: 'middle' is none of the settings"),
        ("stride [-],fulcrum [mm]\n1,40\n", {}, "row 1: .* 66 to 151 mm"),
        ("stride [-],setting\n1,low\n", {"setting": "high"}, "in place of `setting`"),
        ("stride [-],setting\n1,low\n", {"plate": None}, "`schedule`: has no effect"),
    ],
)
def test_refused(tmp_path: Path, rows: str, more: dict[str, Any], words: str) -> None:
    with pytest.raises(gc.InputError, match=words):
        simulated(ONE, schedule=schedule(tmp_path, rows), **more)


def test_an_actuator_that_is_too_slow_is_refused(strides: dict[str, Path], tmp_path: Path) -> None:
    """51 mm from low to medium in 0.46 s ask for 111 mm/s."""
    write_foot(tmp_path, vsf_foot())
    file = tmp_path / "foot.toml"
    file.write_text(file.read_text() + '\n[actuator]\nspeed = { value = 100, unit = "mm/s" }\n')
    rows = schedule(tmp_path, "stride [-],setting\n1,low\n2,medium\n")
    with pytest.raises(gc.InputError, match=r"stride 2: 51 mm to medium in 0.46 s of swing need 111 mm/s.*does 100"):
        simulated(strides, schedule=rows, foot=file)


def test_the_source_of_an_actuators_speed_stays_when_its_foot_is_written_again(tmp_path: Path) -> None:
    write_foot(tmp_path, vsf_foot())
    file = tmp_path / "foot.toml"
    stated = 'speed = { value = 0.111, unit = "m/s", source = "paper", note = "without load" }'
    file.write_text(f"{file.read_text()}\n[actuator]\n{stated}\n")
    opened(Record("prosthesis simulate", {}))
    write_foot(tmp_path / "again", read_foot(file).foot)
    assert stated in (tmp_path / "again" / "foot.toml").read_text()
