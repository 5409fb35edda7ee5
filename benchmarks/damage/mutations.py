"""Ways in which a file is damaged or comes from another program, each a function of its bytes and of chance."""

from __future__ import annotations

import io
import random
import re
import struct
import zipfile
import zlib
from collections.abc import Callable

Mutation = Callable[[bytes, random.Random], bytes]
NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.])")
WHOLE = re.compile(rb"(?<![\w.])\d+(?![\w.])")
ODD = (b"nan", b"NaN", b"inf", b"-Infinity", b"1e308", b"1e39", b"1e999", b"-1e30", b"1.#QNAN", b"1_0", b"0x10", b"-")
COUNTS = (b"0", b"-1", b"1", b"4000000000", b"99999999999999999999999", b"1e9", b"2147483648")
DEEP = 3000
BOMB = (
    b'<!DOCTYPE x [<!ENTITY a "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa">'
    + b"".join(b'<!ENTITY %c "%s">' % (98 + k, b"&%c;" % (97 + k) * 10) for k in range(8))
    + b"]>"
)


def span(data: bytes, chance: random.Random, most: int = 80) -> tuple[int, int]:
    """A part of the file."""
    start = chance.randrange(len(data))
    return start, min(len(data), start + chance.randrange(1, most))


def flip_bits(data: bytes, chance: random.Random) -> bytes:
    body = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 8))):
        body[chance.randrange(len(body))] ^= 1 << chance.randrange(8)
    return bytes(body)


def cut(data: bytes, chance: random.Random) -> bytes:
    return data[: chance.randrange(len(data))]


def drop(data: bytes, chance: random.Random) -> bytes:
    start, end = span(data, chance)
    return data[:start] + data[end:]


def repeat(data: bytes, chance: random.Random) -> bytes:
    start, end = span(data, chance)
    return data[:end] + data[start:end] + data[end:]


def zeros(data: bytes, chance: random.Random) -> bytes:
    start, end = span(data, chance)
    return data[:start] + bytes(end - start) + data[end:]


def noise(data: bytes, chance: random.Random) -> bytes:
    start = chance.randrange(len(data) + 1)
    return data[:start] + chance.randbytes(chance.randrange(1, 60)) + data[start:]


def empty(data: bytes, chance: random.Random) -> bytes:
    return chance.choice((b"", b"\n", b"  \n\n", b"\0" * 600, b"\xef\xbb\xbf"))


def byte_order_mark(data: bytes, chance: random.Random) -> bytes:
    return b"\xef\xbb\xbf" + data


def utf_16(data: bytes, chance: random.Random) -> bytes:
    return data.decode("latin-1").encode(chance.choice(("utf-16", "utf-16-le", "utf-16-be")))


def latin_1(data: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(data))
    return data[:at] + chance.choice((b"\xe9", b"\xb0", b"\xff", b"\xa0")) + data[at:]


def line_ends(data: bytes, chance: random.Random) -> bytes:
    return data.replace(b"\r\n", b"\n").replace(b"\n", chance.choice((b"\r\n", b"\r", b"\n\n")))


def drop_line(data: bytes, chance: random.Random) -> bytes:
    lines = data.splitlines(keepends=True)
    at = _place(lines, chance)
    return b"".join(lines[:at] + lines[at + 1 :])


def repeat_line(data: bytes, chance: random.Random) -> bytes:
    lines = data.splitlines(keepends=True)
    at = _place(lines, chance)
    return b"".join(lines[: at + 1] + lines[at:])


def swap_lines(data: bytes, chance: random.Random) -> bytes:
    lines = data.splitlines(keepends=True)
    one, other = _place(lines, chance), _place(lines, chance)
    lines[one], lines[other] = lines[other], lines[one]
    return b"".join(lines)


def _place(lines: list[bytes], chance: random.Random) -> int:
    """A line; every second time one of the first ten, where heads are."""
    return chance.randrange(min(10, len(lines)) if chance.random() < 0.5 else len(lines))


def swap_columns(data: bytes, chance: random.Random) -> bytes:
    """Everywhere or in one line only."""
    mark = max((b",", b"\t", b";", b" "), key=data.count)
    lines = data.split(b"\n")
    one, other, only = chance.randrange(8), chance.randrange(8), chance.randrange(len(lines))
    everywhere = chance.random() < 0.5
    for k, line in enumerate(lines):
        cells = line.split(mark)
        if max(one, other) < len(cells) and (everywhere or k == only):
            cells[one], cells[other] = cells[other], cells[one]
            lines[k] = mark.join(cells)
    return b"\n".join(lines)


def cells_of_a_line(data: bytes, chance: random.Random) -> bytes:
    """One cell less or more in a line."""
    mark = max((b",", b"\t", b";", b" "), key=data.count)
    lines = data.split(b"\n")
    at = _place(lines, chance)
    cells = lines[at].split(mark)
    k = chance.randrange(len(cells))
    cells[k : k + 1] = [] if chance.random() < 0.5 else [cells[k], cells[k]]
    lines[at] = mark.join(cells)
    return b"\n".join(lines)


def odd_number(data: bytes, chance: random.Random) -> bytes:
    return _in_place_of(NUMBER, data, chance, chance.choice(ODD))


def odd_count(data: bytes, chance: random.Random) -> bytes:
    """A whole number, mostly of the first 600 bytes, becomes another one."""
    head = 600 if chance.random() < 0.7 else len(data)
    return _in_place_of(WHOLE, data[:head], chance, chance.choice(COUNTS)) + data[head:]


def sign(data: bytes, chance: random.Random) -> bytes:
    found = list(NUMBER.finditer(data))
    if not found:
        return flip_bits(data, chance)
    one = chance.choice(found)
    return data[: one.start()] + b"-" + one[0].lstrip(b"+-") + data[one.end() :]


def _in_place_of(what: re.Pattern[bytes], data: bytes, chance: random.Random, new: bytes) -> bytes:
    found = list(what.finditer(data))
    if not found:
        return data
    one = chance.choice(found)
    return data[: one.start()] + new + data[one.end() :]


def decimal_commas(data: bytes, chance: random.Random) -> bytes:
    body = re.sub(rb"(\d)\.(\d)", rb"\1,\2", data)
    return body if chance.random() < 0.5 else re.sub(rb"(\d)\.(\d)", rb"\1,\2", data.replace(b",", b";"))


def long_line(data: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(data))
    return data[:at] + chance.choice((b"9", b"a", b" ", b",", b"\t", b"[", b'"')) * 1_500_000 + data[at:]


def quote(data: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(data))
    return data[:at] + chance.choice((b'"', b"'", b"\\", b"#", b"=", b"[", b"]", b"{", b"}", b";")) + data[at:]


def words(data: bytes, chance: random.Random) -> bytes:
    """A word becomes another one of the file, or part of it is lost."""
    found = list(re.finditer(rb"[A-Za-z_]\w+", data))
    if len(found) < 2:
        return flip_bits(data, chance)
    one, other = chance.sample(found, 2)
    new = other[0] if chance.random() < 0.5 else one[0][:-1]
    return data[: one.start()] + new + data[one.end() :]


def kind_of_value(data: bytes, chance: random.Random) -> bytes:
    """A value in a settings file becomes one of another kind."""
    new = (b"[]", b"{}", b'"x"', b"true", b"null", b"[1, [2]]", b"-5", b"1e400", b"nan", b"1979-05-27", b"9" * 5000)
    return _in_place_of(re.compile(rb'"[^"\n]*"|(?<![\w.])-?\d[\d.eE+-]*'), data, chance, chance.choice(new))


def nested(data: bytes, chance: random.Random) -> bytes:
    """Brackets in brackets."""
    mark = chance.choice(((b"[", b"]"), (b'{"a":', b"}"), (b"{a = ", b"}")))
    return _in_place_of(NUMBER, data, chance, mark[0] * DEEP + b"1" + mark[1] * DEEP)


def entity_bomb(data: bytes, chance: random.Random) -> bytes:
    head, mark, rest = data.partition(b"?>")
    body = rest if mark else head
    bomb = chance.choice((BOMB, b'<!DOCTYPE x [<!ENTITY i SYSTEM "file:///etc/passwd">]>'))
    return (head + mark if mark else b"") + bomb + _in_place_of(re.compile(rb">[^<>]+<"), body, chance, b">&i;<")


def nested_elements(data: bytes, chance: random.Random) -> bytes:
    pairs = (
        (b"<a>", b"</a>"),
        (b"<Body name='b'>", b"</Body>"),
        (b"<MultiplierFunction><function>", b"</function></MultiplierFunction>"),
    )
    tag, end = chance.choice(pairs)
    return _in_place_of(re.compile(rb">[^<>]+<"), data, chance, b">" + tag * DEEP + end * DEEP + b"<")


def drop_element(data: bytes, chance: random.Random) -> bytes:
    """An element goes, is there twice, or is empty."""
    found = list(re.finditer(rb"<(\w+)[^<>]*>(?:(?!</?\1\b).){0,2000}</\1>", data, re.DOTALL))
    if not found:
        return drop(data, chance)
    one = chance.choice(found)
    new = chance.choice((b"", one[0] * 2, b"<" + one[1] + b"/>"))
    return data[: one.start()] + new + data[one.end() :]


def attribute(data: bytes, chance: random.Random) -> bytes:
    new = chance.choice((b'""', b'"-1"', b'"4000000000"', b'"x"', b'"../../x"', b'"nan"'))
    return _in_place_of(re.compile(rb'"[^"\n]*"'), data, chance, new)


def odd_float(data: bytes, chance: random.Random) -> bytes:
    """Four or eight bytes of a binary file as a number that is none, or is too large."""
    body = bytearray(data)
    form, size = chance.choice((("<f", 4), (">f", 4), ("<d", 8)))
    at = chance.randrange(max(1, len(body) - size))
    body[at : at + size] = struct.pack(form, chance.choice((float("nan"), float("inf"), -1e30, 3e38)))
    return bytes(body)


def odd_word(data: bytes, chance: random.Random) -> bytes:
    """Two or four bytes near the start of a binary file as a count that cannot be."""
    body = bytearray(data)
    size = chance.choice((1, 2, 4))
    at = chance.randrange(min(len(body), 1200)) if chance.random() < 0.8 else chance.randrange(len(body))
    body[at : at + size] = chance.choice((b"\xff\xff\xff\xff", b"\0\0\0\0", b"\xff\xff\xff\x7f", b"\1\0\0\0"))[:size]
    return bytes(body)


def inside_the_archive(data: bytes, chance: random.Random) -> bytes:
    """A part of a workbook damaged, or three hundred times as large."""
    out = io.BytesIO()
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as new:
            chosen = chance.choice([name for name in old.namelist() if old.read(name)])
            way = chance.choice((*XML, odd_number, odd_count, cut, inflated))
            for name in old.namelist():
                part = old.read(name)
                new.writestr(name, way(part, chance) if name == chosen else part)
    except (zipfile.BadZipFile, zlib.error, ValueError, OSError, EOFError, NotImplementedError, RuntimeError):
        return data  # damaged before, so that it is no archive any more
    return out.getvalue()


def inflated(data: bytes, chance: random.Random) -> bytes:
    at = max(0, data.rfind(b"</"))
    return data[:at] + b" " * 400_000_000 + data[at:]


ANY = (flip_bits, cut, drop, repeat, zeros, noise, empty)
LINES = (line_ends, drop_line, repeat_line, swap_lines, swap_columns, cells_of_a_line)
TEXT = (*ANY, byte_order_mark, utf_16, latin_1, *LINES, odd_number, odd_number, odd_count, sign, decimal_commas)
TABLE = (*TEXT, long_line, quote, words)
SETTINGS = (*TEXT, quote, words, kind_of_value, kind_of_value, nested)
XML = (entity_bomb, nested_elements, drop_element, drop_element, attribute)
MARKUP = (*TEXT, long_line, quote, words, *XML)
BINARY = (*ANY, odd_float, odd_float, odd_word, odd_word)
ARCHIVE = (*ANY, *6 * (inside_the_archive,))
KINDS: dict[str, tuple[Mutation, ...]] = {
    "table": TABLE,
    "settings": SETTINGS,
    "markup": MARKUP,
    "binary": BINARY,
    "archive": ARCHIVE,
}


def mutated(data: bytes, kind: str, seed: str) -> tuple[bytes, str]:
    """Damaged once, sometimes twice; and the names of the ways."""
    chance = random.Random(seed)
    ways = [chance.choice(KINDS[kind]) for _ in range(chance.choice((1, 1, 1, 2)))]
    for way in ways:
        data = way(data, chance) if data else data
    return data, ", ".join(way.__name__ for way in ways)
