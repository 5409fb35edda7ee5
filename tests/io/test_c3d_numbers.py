"""Numbers of .c3d files as programs write them: of MIPS and of PC, real and whole, composed byte by byte."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.io.mocap.c3d_markers import markers_of, read_c3d_markers
from geocontact.io.mocap.c3d_plates import plates_of
from geocontact.io.mocap.force_plates import read_force_plates

pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
FRAMES, PER_FRAME = 30, 2
PLACES = np.array([[123.0, -45.0, 1720.0], [-310.0, 208.0, 96.0]])
"""Of two markers [mm], a millimetre further along x in each frame."""

FORCE, MOMENT = (12.0, -8.0, -640.0), (31000.0, 52000.0, -900.0)
"""What the plate's channels read from the eleventh frame on [N, Nmm]."""


@dataclass(frozen=True)
class Written:
    """How a file is written: order of its bytes, data in real numbers or counts, parameters whose kind is another."""

    order: str
    real: bool = True
    whole: tuple[str, ...] = ()
    spare: int = 200
    """Bytes of nothing at the end of the parameters."""

    last: bool = False
    """Whether the last parameter says how far the next one would be, in the other order."""

    def number(self, kind: str, *values: float) -> bytes:
        return struct.pack(f"{self.order}{len(values)}{kind}", *values)

    def entry(self, number: int, name: str, body: bytes) -> bytes:
        head = struct.pack("bb", len(name), number) + name.encode()
        return head + self.number("h", 2 + len(body)) + body

    def numbers(self, group: int, name: str, values: Any, kind: int) -> bytes:
        """Of kind 2 (whole) or 4 (real), in as many dimensions as there are."""
        array = np.asarray(values)
        flat = array.ravel(order="F")
        if name in self.whole:
            kind = 2
        digits = self.number("h" if kind == 2 else "f", *([int(v) for v in flat] if kind == 2 else flat.tolist()))
        return self.entry(group, name, struct.pack(f"bB{array.ndim}B", kind, array.ndim, *array.shape) + digits + b"\0")

    def texts(self, group: int, name: str, values: list[str]) -> bytes:
        long = max(map(len, values))
        body = struct.pack("bBBB", -1, 2, long, len(values)) + "".join(v.ljust(long) for v in values).encode()
        return self.entry(group, name, body + b"\0")

    def parameters(self, data_start: int) -> bytes:
        corners = np.array([[600.0, 0, 0], [200, 0, 0], [200, 400, 0], [600, 400, 0]]).T[:, :, None]
        scale = -1.0 if self.real else 1.0
        parts = [
            self.entry(-number, name, b"\0") for number, name in ((1, "POINT"), (2, "ANALOG"), (3, "FORCE_PLATFORM"))
        ]
        for name, value, kind in (
            ("USED", [2], 2),
            ("FRAMES", [FRAMES], 2),
            ("SCALE", [scale], 4),
            ("RATE", [50.0], 4),
            ("DATA_START", [data_start], 2),
        ):
            parts.append(self.numbers(1, name, value[0], kind))
        parts += [self.texts(1, "LABELS", ["HEE", "TOE"]), self.texts(1, "UNITS", ["mm"])]
        for name, values, kind in (
            ("USED", 6, 2),
            ("GEN_SCALE", 1.0, 4),
            ("RATE", 100.0, 4),
            ("SCALE", [0.5] * 3 + [100.0] * 3, 4),
            ("OFFSET", [0] * 6, 2),
        ):
            parts.append(self.numbers(2, name, values, kind))
        parts += [self.texts(2, "LABELS", ["Fx", "Fy", "Fz", "Mx", "My", "Mz"])]
        parts += [self.texts(2, "UNITS", ["N"] * 3 + ["Nmm"] * 3)]
        for name, values, kind in (
            ("USED", 1, 2),
            ("TYPE", [2], 2),
            ("ZERO", [0, 0], 2),
            ("CHANNEL", np.arange(1, 7)[:, None], 2),
            ("CORNERS", corners, 4),
            ("ORIGIN", np.array([[0.0], [0.0], [-40.0]]), 4),
        ):
            parts.append(self.numbers(3, name, values, kind))
        found = bytearray(b"".join(parts))
        at = len(found) - len(parts[-1]) + 2 + len("ORIGIN")
        other = {"<": ">", ">": "<"}[self.order]
        found[at : at + 2] = struct.pack(f"{other}h", len(found) - at) if self.last else bytes(2)
        return bytes(found)

    def file(self, path: Path) -> Path:
        section = struct.pack("BBBB", 1, 0x50, 0, 84 if self.order == "<" else 86) + self.parameters(0)
        blocks = -(-(len(section) + self.spare) // 512)
        section = struct.pack("BBBB", 1, 0x50, blocks, 84 if self.order == "<" else 86) + self.parameters(2 + blocks)
        header = bytearray(512)
        header[:2] = bytes([2, 0x50])
        header[2:12] = self.number("h", 2, 6 * PER_FRAME, 1, FRAMES, 0)
        header[12:16] = self.number("f", -1.0 if self.real else 1.0)
        header[16:20] = self.number("h", 2 + blocks, PER_FRAME)
        header[20:24] = self.number("f", 50.0)
        kind, data = ("f" if self.real else "h"), []
        channels = [v / s for v, s in zip((*FORCE, *MOMENT), [0.5] * 3 + [100.0] * 3, strict=True)]
        for frame in range(FRAMES):
            moved = PLACES + np.array([frame, 0, 0])
            data += [self.number(kind, *[int(v) for v in place], 0) for place in moved]
            data.append(self.number(kind, *[int(v) * (frame >= 10) for v in channels] * PER_FRAME))
        path.write_bytes(bytes(header) + section.ljust(512 * blocks, b"\0") + b"".join(data))
        return path


@pytest.fixture(autouse=True)
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    """ezc3d in this process, which takes a tenth of the time: these files are whole."""
    own = {plates_of.__module__: plates_of, markers_of.__module__: markers_of}
    monkeypatch.setattr("geocontact.io.mocap.c3d_plates._run", lambda _, module, copy, __: own[module](copy))


def require_what_was_written(file: Path) -> None:
    seen = read_c3d_markers(file)
    assert seen.names == ("HEE", "TOE") and len(seen.time) == FRAMES
    np.testing.assert_allclose(np.diff(seen.time), 0.02, rtol=1e-9)
    for frame in (0, 13, 29):
        np.testing.assert_allclose(seen.positions[frame], 1e-3 * (PLACES + np.array([frame, 0, 0])), rtol=1e-6)
    (plate,) = read_force_plates(file)
    assert len(plate.time) == FRAMES * PER_FRAME
    # x as the laboratory's, y and z turned over; the force on the foot is the opposite of that on the plate
    np.testing.assert_allclose(np.abs(plate.wrench.force[47]), np.abs(FORCE), rtol=1e-6)
    assert plate.wrench.force[47, 2] == pytest.approx(640.0)
    # r x F + T about a point 40 mm below the surface: cop = (-(My - z Fx), Mx + z Fy) / Fz in the plate's axes
    x = -(MOMENT[1] - 40.0 * -FORCE[0]) / FORCE[2]
    y = (MOMENT[0] + 40.0 * -FORCE[1]) / FORCE[2]
    np.testing.assert_allclose(plate.centre_of_pressure()[47, :2], 1e-3 * np.array([400.0 + x, 200.0 - y]), atol=1e-6)


@pytest.mark.parametrize("real", [True, False])
@pytest.mark.parametrize("order", ["<", ">"])
def test_both_orders_of_bytes_read_the_same(order: str, real: bool, tmp_path: Path) -> None:
    require_what_was_written(Written(order, real).file(tmp_path / "a.c3d"))


def test_a_last_parameter_that_points_beyond_the_section(tmp_path: Path) -> None:
    """As in c3d.org's sample 2 of SGI: how far the next one is stands there in the order of PC."""
    require_what_was_written(Written(">", last=True).file(tmp_path / "a.c3d"))


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("spare", [4, 120, 500])
def test_real_numbers_that_are_written_as_whole_ones(order: str, spare: int, tmp_path: Path) -> None:
    """ezc3d says of each that it is 'not a FLOAT'. Corners take 24 bytes more: with little to spare the data move."""
    whole = ("RATE", "CORNERS", "ORIGIN", "GEN_SCALE")
    require_what_was_written(Written(order, whole=whole, spare=spare).file(tmp_path / "a.c3d"))


def test_counts_as_real_numbers_of_mips(tmp_path: Path) -> None:
    """Both at once: the order of bytes, and counts written with four bytes."""

    class Real(Written):
        def numbers(self, group: int, name: str, values: Any, kind: int) -> bytes:
            return super().numbers(group, name, values, 4 if name in ("USED", "OFFSET", "CHANNEL") else kind)

    require_what_was_written(Real(">").file(tmp_path / "a.c3d"))


def test_a_torn_file_of_mips_is_refused_in_one_line(tmp_path: Path) -> None:
    whole = Written(">").file(tmp_path / "a.c3d").read_bytes()
    (tmp_path / "a.c3d").write_bytes(whole[:700])
    with pytest.raises(InputError, match=r"byte order of MIPS \(SGI\) computers, and its parameters cannot"):
        read_c3d_markers(tmp_path / "a.c3d")
