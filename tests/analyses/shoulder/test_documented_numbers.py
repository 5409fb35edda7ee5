"""The table of a device's numbers in the reference is what files may say, in the units that it tells."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.devices import device_named
from geocontact.shoulder_exoskeleton.device import QUANTITIES
from geocontact.shoulder_exoskeleton.lucy import lucy

PAGE = Path(__file__).resolve().parents[3] / "docs" / "reference" / "input_files.md"


def documented() -> dict[str, str]:
    """Unit by number."""
    text = PAGE.read_text(encoding="utf-8")
    section = text[text.index("| numbers | unit | what |") : text.index("**Person**")]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in section.splitlines() if "`" in line]
    return {name: unit for names, unit, _ in rows for name in re.findall(r"`(\w+)`", names)}


def test_a_file_with_every_documented_number_is_the_device_itself(tmp_path: Path) -> None:
    units, device = documented(), lucy()
    assert set(units) == set(QUANTITIES)
    lines = [
        f'{name} = {{ value = {number.value * QUANTITIES[name].written[1]!r}, unit = "{units[name]}" }}'
        for name, number in device.numbers.items()
    ]
    file = tmp_path / "same.toml"
    file.write_text("[numbers]\n" + "\n".join(lines) + "\n", encoding="utf-8")
    read = device_named(Record("shoulder simulate", {}), str(file))
    for name, number in device.numbers.items():
        assert read[name] == pytest.approx(number.value, rel=1e-12, abs=1e-15), name
