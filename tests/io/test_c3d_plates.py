"""Force plates of .c3d files composed by hand: a known load, and what a file says of its own plate."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.force_plate import ForcePlate, lengths_outside
from geocontact.io.mocap.c3d_markers import markers_of, read_c3d_markers
from geocontact.io.mocap.c3d_plates import clipped_runs, plate_units, plates_of
from geocontact.io.mocap.force_plates import plate_named, read_force_plates
from tests.io.plate_files import CENTRE, FREE, PEAK, channels, plate_file, stance

OFFSET = np.array([3.0, 2.0, 25.0, 0.5, -0.8, 0.1])
"""What an empty plate reads [N, N m]."""


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    """ezc3d in this process, which takes a tenth of the time: these files are whole."""
    own = {plates_of.__module__: plates_of, markers_of.__module__: markers_of}
    monkeypatch.setattr("geocontact.io.mocap.c3d_plates._run", lambda _, module, copy, __: own[module](copy))


def with_offset(share: np.ndarray) -> np.ndarray:
    noise = np.random.default_rng(0).normal(0.0, [[0.3], [0.3], [0.3], [0.02], [0.02], [0.02]], (6, len(share)))
    return channels(share) + OFFSET[:, None] + noise


def only(file: Path) -> ForcePlate:
    (plate,) = read_force_plates(file)
    return plate_named((plate,), None, file, "`plate`")


def require_true(plate: ForcePlate, share: np.ndarray, within: float = 1e-3) -> None:
    """The load that was composed: newtons at every sample, centre of pressure and free moment at the peak."""
    load = plate.wrench.force @ plate.normal
    np.testing.assert_allclose(load, PEAK * share, atol=within * PEAK)
    peak = int(np.argmax(share))
    np.testing.assert_allclose(plate.centre_of_pressure()[peak], CENTRE, atol=within)
    assert plate.free_moment()[peak] == pytest.approx(FREE, abs=50.0 * within)
    assert np.isnan(plate.centre_of_pressure()[share == 0.0]).all(), "nobody stands on it there"


def test_a_plate_reads_what_was_composed(tmp_path: Path) -> None:
    require_true(only(plate_file(tmp_path / "a.c3d", channels(stance()))), stance(), 1e-5)


@pytest.mark.parametrize("zero", [(1, 20), (0, 20), (75, 100)])
@pytest.mark.usefixtures("here")
def test_the_offset_of_the_frames_that_zero_names_is_taken_off(zero: tuple[int, int], tmp_path: Path) -> None:
    """25 N on the empty plate are beyond the gate: without it there would be a centre of pressure throughout."""
    file = plate_file(tmp_path / "a.c3d", with_offset(stance()), ZERO=list(zero))
    plate = only(file)
    require_true(plate, stance(), 2e-3)
    assert abs(np.mean((plate.wrench.force @ plate.normal)[:200])) < 0.05


@pytest.mark.usefixtures("here")
def test_frames_that_are_loaded_in_part_tell_the_offset_by_the_rest(tmp_path: Path) -> None:
    """ZERO over the whole recording, as of a file that somebody gave us."""
    file = plate_file(tmp_path / "a.c3d", with_offset(stance()), ZERO=[1, 100])
    with pytest.warns(InputWarning, match="frames 1 to 100, it is loaded in 40% of them: its offset is that of the o"):
        plate = only(file)
    require_true(plate, stance(), 2e-3)


@pytest.mark.parametrize(
    ("share", "said"),
    [
        (stance()[::-1] * 0.0 + 1.0, "frames 1 to 10, in which it carries 700 to 700 N: no offset is taken off"),
        (np.where(stance() > 0, stance(), 0.2), "frames 1 to 10, in which it carries 140 to 140 N: no offset"),
        (np.roll(stance(), -450), "frames 1 to 10, in which it carries "),
    ],
    ids=["stands", "leans", "leaves"],
)
@pytest.mark.usefixtures("here")
def test_an_offset_of_a_loaded_plate_is_left_and_said(share: np.ndarray, said: str, tmp_path: Path) -> None:
    file = plate_file(tmp_path / "a.c3d", channels(share), ZERO=[1, 10])
    with pytest.warns(InputWarning) as record:
        plate = only(file)
    assert any(said in str(each.message) for each in record)
    np.testing.assert_allclose(plate.wrench.force @ plate.normal, PEAK * share, atol=1e-3)


@pytest.mark.usefixtures("here")
def test_frames_that_the_file_does_not_have_are_said(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match="frames 200 to 300 of 100: no offset is taken off"):
        only(plate_file(tmp_path / "a.c3d", channels(stance()), ZERO=[200, 300]))


@pytest.mark.parametrize("zero", [[0, 0], []])
@pytest.mark.usefixtures("here")
def test_without_frames_nothing_is_taken_off_but_a_plate_that_never_returns_is_said(
    zero: list[int], tmp_path: Path
) -> None:
    file = plate_file(tmp_path / "a.c3d", with_offset(stance()), ZERO=zero)
    with pytest.warns(InputWarning, match="never returns to about 0 N: it carries 25 N or more for 95 % of the time"):
        plate = only(file)
    assert np.mean((plate.wrench.force @ plate.normal)[:200]) == pytest.approx(25.0, abs=0.05)


@pytest.mark.usefixtures("here")
def test_an_empty_plate_with_an_offset_is_empty(tmp_path: Path) -> None:
    file = plate_file(tmp_path / "a.c3d", with_offset(np.zeros(1000)), ZERO=[1, 10])
    with pytest.warns(InputWarning, match="plate 1: never carries 20 N"):
        plate = only(file)
    assert np.abs(plate.wrench.force).max() < 2.0


@pytest.mark.parametrize(
    ("units", "length", "moment"),
    [
        (("m", "N", "Nmm"), 1.0, 1e-3),
        (("meters", "N", "Nmm"), 1.0, 1e-3),
        (("METERS", "N", "Nm"), 1.0, 1.0),
        (("mete", "Newtons", "N.m"), 1.0, 1.0),
        (("M", "N", "N*mm"), 1.0, 1e-3),
        (("MM", "N", "NMM"), 1e-3, 1e-3),
        (("Millimeters", "nt", "ntmm"), 1e-3, 1e-3),
        (("mm", "N", "Nm"), 1e-3, 1.0),
        (("cm", "", ""), 1e-2, 1e-2),
        (("m", "N", ""), 1.0, 1.0),
    ],
)
@pytest.mark.usefixtures("here")
def test_units_are_those_of_the_channels(
    units: tuple[str, str, str], length: float, moment: float, tmp_path: Path
) -> None:
    """Of points by POINT:UNITS, of moments by ANALOG:UNITS, where ezc3d takes N times the unit of points for all."""
    file = plate_file(tmp_path / "a.c3d", channels(stance()), units, length, moment)
    require_true(only(file), stance(), 1e-5)


@pytest.mark.usefixtures("here")
def test_the_lever_of_a_tilted_plate_is_taken_apart_too(tmp_path: Path) -> None:
    """Nm beside points in mm on a plate whose corners are tilted: the same as with Nmm."""
    turned = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]]) @ [
        [1, 0, 0],
        [0, 0.96, -0.28],
        [0, 0.28, 0.96],
    ]
    corners = 1e3 * turned @ np.array([[0.6, 0.0, 0.0], [0.2, 0.0, 0.0], [0.2, 0.4, 0.0], [0.6, 0.4, 0.0]]).T
    same = [
        only(
            plate_file(
                tmp_path / f"{unit}.c3d", channels(stance()), ("mm", "N", unit), 1e-3, size, CORNERS=corners[:, :, None]
            )
        )
        for unit, size in (("Nm", 1.0), ("Nmm", 1e-3))
    ]
    np.testing.assert_allclose(same[0].wrench.moment, same[1].wrench.moment, atol=1e-4)
    np.testing.assert_allclose(same[0].centre_of_pressure(200.0)[500], turned @ CENTRE, atol=1e-5)


@pytest.mark.usefixtures("here")
def test_units_of_force_are_converted_or_said() -> None:
    """Kilograms of force are 9.80665 N each; pounds without "force" are no unit of force, and are said."""
    found = plate_units("a.c3d", "plate 1", 2, "mm", ["kgf"] * 3 + ["kgf.m"] * 3)
    assert (found.newton, found.newton_metre, found.doubt) == (9.80665, 9.80665, "")
    strange = plate_units("a.c3d", "plate 1", 2, "mm", ["lb"] * 3 + ["in-lb"] * 3)
    assert "'lb'; they are taken to be in N and Nmm" in strange.doubt


def test_channels_in_volts_are_said(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match="ANALOG:UNITS of its channels is 'V'; they are taken to be in N and Nmm"):
        only(plate_file(tmp_path / "a.c3d", channels(stance()), ("mm", "V", "V")))


@pytest.mark.usefixtures("here")
def test_an_empty_unit_of_points_is_refused_unless_it_is_stated(tmp_path: Path) -> None:
    """It was taken as mm, which is a thousand times too small where it is m."""
    file = plate_file(tmp_path / "a.c3d", channels(stance()), ("", "N", "Nm"), 1.0, 1.0)
    with pytest.raises(InputError, match=r"POINT:UNITS: is empty: .* is unknown; state it with `c3d_unit` m, cm, mm"):
        read_force_plates(file)
    (plate,) = read_force_plates(file, "m")
    require_true(plate, stance(), 1e-5)


@pytest.mark.usefixtures("here")
def test_units_that_contradict_each_other_are_refused(tmp_path: Path) -> None:
    file = plate_file(tmp_path / "a.c3d", channels(stance()), ANALOG_UNITS=["N", "N", "N", "Nmm", "Nm", "Nmm"])
    with pytest.raises(InputError, match="its moments are in 'Nmm', 'Nm', 'Nmm'; correct ANALOG:UNITS"):
        read_force_plates(file)


@pytest.mark.usefixtures("here")
def test_a_centre_of_pressure_off_its_plate_is_refused_where_that_plate_is_asked_for(tmp_path: Path) -> None:
    """Nmm called Nm: every centre of pressure a thousand times too far from the middle."""
    file = plate_file(tmp_path / "a.c3d", channels(stance()), ("mm", "N", "Nm"), 1e-3, 1e-3)
    with pytest.warns(InputWarning, match="check POINT:UNITS, ANALOG:UNITS, and ORIGIN, CORNERS and CHANNEL"):
        plates = read_force_plates(file)
    with pytest.raises(InputError, match=r"plate 1: under load its centre of pressure lies .* plate's lengths outside"):
        plate_named(plates, None, file, "`plate`")


@pytest.mark.usefixtures("here")
def test_a_wrong_order_of_channels_shows_at_the_corners(tmp_path: Path) -> None:
    """Mx and Fx exchanged in CHANNEL."""
    file = plate_file(tmp_path / "a.c3d", channels(stance()), CHANNEL=np.array([4, 2, 3, 1, 5, 6])[:, None])
    with pytest.warns(InputWarning, match=r"under load its centre of pressure lies .* outside of it"):
        plates = read_force_plates(file)
    with pytest.raises(InputError, match="ORIGIN, CORNERS and CHANNEL of FORCE_PLATFORM"):
        plate_named(plates, None, file, "`plate`")


@pytest.mark.usefixtures("here")
def test_a_little_off_the_plate_is_said_and_used(tmp_path: Path) -> None:
    """The load 0.1 m beyond the edge of 0.4 m, a quarter of its length."""
    file = plate_file(tmp_path / "a.c3d", channels(stance(), np.array([0.70, 0.24, 0.0])))
    with pytest.warns(InputWarning, match=r"lies 0\.25 plate's lengths outside of it \(median\); check POINT:UNITS"):
        assert only(file).centre_of_pressure(200.0)[500, 0] == pytest.approx(0.70, abs=1e-5)


def test_lengths_outside_by_hand() -> None:
    corners = np.array([[2.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 1.0, 0.0]])
    centre = np.array([[1.0, 1.25, 0.0], [1.0, 0.5, 0.0], [np.nan] * 3, [1.0, 1.5, 0.0], [3.0, 0.5, 0.0]])
    load = np.array([100.0, 30.0, 100.0, 100.0, 100.0])
    assert lengths_outside(centre, load, corners, 40.0) == 0.5  # 0.25, 0.5 and 0.5 lengths; the light one left out
    assert np.isnan(lengths_outside(centre, 0.1 * load, corners, 40.0))


@pytest.mark.usefixtures("here")
def test_clipped_channels_are_said_with_their_time(tmp_path: Path) -> None:
    """A converter of 12 bits whose Fz ends at 2047 counts, 614.1 N: from 0.3 + 0.4 asin(0.8773)/pi = 0.4367 s on."""
    per_count, unit = np.array([[0.1], [0.1], [0.3], [30.0], [30.0], [30.0]]), np.array([[1.0]] * 3 + [[1e-3]] * 3)
    counts = np.minimum(np.round(channels(stance()) / unit / per_count), 2047)
    told = {"ANALOG_BITS": [12], "ANALOG_SCALE": per_count.ravel()}
    file = plate_file(tmp_path / "a.c3d", counts * per_count * unit, **told)
    said = r"plate 1: channel 'Fz1' is clipped at the end of its converter from 0\.437 to 0\.563 s$"
    with pytest.warns(InputWarning, match=said):
        (plate,) = read_force_plates(file)
    assert (plate.wrench.force @ plate.normal).max() == pytest.approx(614.1, abs=1e-3)


def test_runs_at_the_end_of_a_converter_by_hand() -> None:
    column = np.array([0, 2047, 2047, 2047, 5, 2047, 2047, 5, -2048, -2048, -2048, -2048.0])
    steady = np.full(12, 700.0)  # constant, but at no limit
    real = np.where(column == 2047, 2047.3, column)  # no counts at all
    runs = clipped_runs(np.column_stack([column, steady, real, column + 2048]), np.array([0.0, 0.0, 0.0, 2048.0]), 12)
    assert sorted(map(tuple, runs.tolist())) == [(0, 1, 3), (0, 8, 4), (3, 1, 3), (3, 8, 4)]


@pytest.mark.usefixtures("here")
def test_a_correction_of_the_centre_of_pressure_is_said_not_to_be_applied(tmp_path: Path) -> None:
    file = plate_file(tmp_path / "a.c3d", channels(stance()), FPCOPPOLY=np.full((6, 2, 1), 1e-6))
    with pytest.warns(InputWarning, match="FORCE_PLATFORM:FPCOPPOLY, Kistler's correction .* is not applied"):
        require_true(only(file), stance(), 1e-5)


def as_real(data: bytes, group: str, name: str, shift: float = 0.0) -> bytes:
    """The file with a parameter of two bytes a number written with four, as some programs have it."""
    out, start = bytearray(data), 512 * (data[0] - 1)
    end, at, groups = start + 512 * data[start + 2], start + 4, dict[int, str]()
    while True:
        letters, number = struct.unpack_from("<bb", out, at)
        ahead_at = at + 2 + abs(letters)
        word, (ahead,) = out[at + 2 : ahead_at].decode(), struct.unpack_from("<h", out, ahead_at)
        if number < 0:
            groups[-number] = word
        elif (groups[number], word) == (group, name):
            sizes = out[ahead_at + 4 : ahead_at + 4 + out[ahead_at + 3]]
            count, numbers_at = int(np.prod(sizes, dtype=int)), ahead_at + 4 + len(sizes)
            values = struct.unpack_from(f"<{count}h", out, numbers_at)
            out[ahead_at + 2] = 4
            struct.pack_into("<h", out, ahead_at, ahead + 2 * count)
            real = struct.pack(f"<{count}f", *[value + shift for value in values])
            out[numbers_at:end] = real + out[numbers_at + 2 * count : end - 2 * count]
            return bytes(out)
        at = ahead_at + ahead


@pytest.mark.parametrize(
    "parameter",
    ["ANALOG:OFFSET", "ANALOG:USED", "POINT:USED", "POINT:FRAMES", "FORCE_PLATFORM:USED", "FORCE_PLATFORM:CHANNEL"],
)
@pytest.mark.usefixtures("here")
def test_counts_that_are_written_as_real_numbers_are_read(parameter: str, tmp_path: Path) -> None:
    """ezc3d says of each that it is 'not an INT'."""
    whole = plate_file(tmp_path / "a.c3d", channels(stance())).read_bytes()
    file = tmp_path / "real.c3d"
    file.write_bytes(as_real(whole, *parameter.split(":")))
    require_true(only(file), stance(), 1e-5)
    np.testing.assert_allclose(read_c3d_markers(file).positions[0, 0], [0.3, 0.2, 0.1], atol=1e-6)


@pytest.mark.usefixtures("here")
def test_offsets_that_are_not_whole_are_named_and_markers_are_read(tmp_path: Path) -> None:
    whole = plate_file(tmp_path / "a.c3d", channels(stance())).read_bytes()
    file = tmp_path / "real.c3d"
    file.write_bytes(as_real(whole, "ANALOG", "OFFSET", 0.5))
    with pytest.raises(
        InputError, match=r"ANALOG:OFFSET: is 0\.5; ezc3d takes whole numbers .* may be sound; save it w"
    ):
        read_force_plates(file)
    np.testing.assert_allclose(read_c3d_markers(file).positions[0, 0], [0.3, 0.2, 0.1], atol=1e-6)


def test_plates_at_fault_leave_the_markers(tmp_path: Path) -> None:
    file = plate_file(tmp_path / "a.c3d", channels(stance()), TYPE=[99])
    with pytest.raises(InputError, match=r"its force plates cannot be computed \(.*\); the rest of the file is read"):
        read_force_plates(file)
    np.testing.assert_allclose(read_c3d_markers(file).positions[0, 0], [0.3, 0.2, 0.1], atol=1e-6)
