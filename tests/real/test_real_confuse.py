"""What the trials of a practice case of each system can tell of a delay: its size, who looks like it, and the page."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PRACTICE = ROOT.parent / "shared" / "gap" / "practice"
WITHOUT_EFFECT = ("elbow_01", "foot_02", "knee_03", "sit_to_stand_01")
CASES = [*WITHOUT_EFFECT, pytest.param("shoulder_03", marks=pytest.mark.slow)]


@pytest.mark.parametrize("name", CASES)
def test_a_delay_of_milliseconds_would_be_seen(name: str, tmp_path: Path) -> None:
    if not PRACTICE.is_dir():
        pytest.skip("no practice cases: ../shared/gap/practice is absent")
    out = tmp_path / "out"
    command = [sys.executable, str(ROOT / "cli.py"), "gap", "confuse", str(PRACTICE / name), "--out", str(out)]
    said = subprocess.run(
        [*command, "--effects", "time_shift,filter_lag"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert said.returncode == 0, said.stderr
    answer = json.loads((out / "confuse.json").read_text(encoding="utf-8"))
    assert answer["verdict"] == "no_gap"
    late = answer["detectability"]["time_shift"]
    assert 1e-4 < late["smallest"] < 0.1
    assert 0.8 <= late["power"] < 0.9
    assert answer["separability"]["time_shift"]["none"] == pytest.approx(50.0, rel=0.1)
    assert answer["separability"]["time_shift"]["filter_lag"] < 50.0
    assert "time_shift from time_shift.delay" in said.stdout
    page = (out / "report.html").read_text(encoding="utf-8")
    assert '<div class="timeline"' not in page.partition("<main>")[2], "nothing runs in time"
