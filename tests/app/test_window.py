"""The window in a browser: forms, runs, results, mistakes, cancelling; offline, by keyboard, on a phone."""

from __future__ import annotations

import http.client
import http.server
import json
import os
import shutil
import subprocess
import sys
import threading
import time
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import numpy as np
import pytest

from geocontact.analyses.catalogue import ENTRIES
from geocontact.analyses.frame.rerun import differing, results_of
from geocontact.app import samples
from geocontact.app.fields import Form, shown
from geocontact.cli.demo import sample_folder
from tests.app.conftest import ENTRY, Window
from tests.cli.test_tool_folders import leg, opencap, put

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

__all__ = ["leg"]
PATIENCE = 1200.0  # s on a busy machine, of a run
PAUSE = 200  # ms between two looks; each costs both processes and the browser
SOCKET = "/_nicegui_ws/socket.io/?EIO=4&transport=polling"
QUICK = ("fit", "loadcells", "markers", "elbow design", "cop")
RESULTS_OF_SPEED = {"gap benchmark": ["benchmark.json", "benchmark.md"]}
"""Files that hold the date and how long the cases took, which is one of the results there."""
COMMANDS = sorted(each.command for each in ENTRIES if each.command)


def marked(command: str) -> object:
    """Quick ones run with every change, the others before a release."""
    return pytest.param(command, marks=[] if command in QUICK else [pytest.mark.slow, pytest.mark.long])


def slug(command: str) -> str:
    return command.replace(" ", ".")


def run_words(words: list[str], folder: Path) -> None:
    done = subprocess.run([sys.executable, "-c", ENTRY, *words], cwd=folder, capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr


def fill(tab: Page, form: Form) -> None:
    """Everything that a form holds, as a hand does: a field that needs another one when that is filled in."""
    tab.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    left, end = [one for one in form.fields if one.name in form.values], time.monotonic() + 60.0
    while left:
        one = left.pop(0)
        field = tab.locator(f'[name="{one.name}"]')
        if field.is_disabled():
            assert time.monotonic() < end, f"{one.name} stays disabled"
            left.append(one)
            tab.wait_for_timeout(PAUSE)
            continue
        value = form.values[one.name]
        if one.kind == "flag":
            field.set_checked(bool(value))
        elif one.kind == "choice":
            field.select_option(str(value))
        else:
            field.fill(str(value))
        if one.name in form.units:
            tab.locator(f'[name="{one.name}-unit"]').select_option(form.units[one.name])


def until(tab: Page, script: str, seconds: float = PATIENCE) -> None:
    end = time.monotonic() + seconds
    while not tab.evaluate(script):
        assert time.monotonic() < end, (script, tab.locator(".side").inner_text())
        tab.wait_for_timeout(PAUSE)


def settled(tab: Page, words: list[str]) -> None:
    """The page shows these words as its command line."""
    line = json.dumps(shown(words))
    until(tab, f"document.querySelector('[aria-label=\"command line\"]').textContent === {line}", 30.0)


def ended(tab: Page) -> str:
    """State of the last run once it has ended."""
    last = "[...document.querySelectorAll('.run strong')].at(-1)?.textContent ?? ''"
    until(tab, f"/: (done|refused|failed|cancelled)/.test({last})")
    return str(tab.evaluate(last))


@pytest.mark.parametrize("command", [marked(command) for command in COMMANDS])
def test_a_form_filled_by_hand_gives_the_numbers_of_the_command(command: str, window: Window) -> None:
    """The line that the page shows, run by itself into another folder, writes the same files."""
    for earlier in samples.before_of(command):
        if not (samples.results_of(earlier, window.folder) / "run.json").is_file():
            form = Form.of_words(samples.sample(earlier, window.folder).words)
            run_words(form.words(samples.results_of(earlier, window.folder)), window.folder)
    form = Form.of_words(samples.sample(command, window.folder).words)
    tab = window.tab(f"form/{slug(command)}")
    fill(tab, form)
    out = tab.get_by_label("folder for the results").input_value()
    expected = form.words(out)
    settled(tab, expected)
    tab.get_by_role("button", name="Run", exact=True).click()
    assert ": done" in ended(tab), tab.locator(".side").inner_text()
    twin = Path(f"{out}-twin")
    run_words([*expected[:-1], f"--out={twin}"], window.folder)
    before, after = results_of(Path(out)), results_of(twin)
    assert len(before) > 1 and before.keys() == after.keys()
    assert differing(before, after, Path(out), twin) == RESULTS_OF_SPEED.get(command, [])
    if (Path(out) / "report.html").is_file():
        frame = tab.frame_locator("iframe")
        assert frame.locator("body").inner_text(timeout=60_000).strip()
    tab.close()


def test_nothing_is_asked_of_another_machine(window: Window) -> None:
    """Of all pages that were opened before, the start page among them."""
    window.tab().close()
    asked = {urlsplit(url).netloc for url in window.requests if not url.startswith(("data:", "blob:"))}
    assert asked == {urlsplit(window.home).netloc}


def test_a_second_user_is_refused(window: Window, browser: Browser) -> None:
    """Another browser with the address that was used, static files and the socket; and a name that leads here."""
    other = browser.new_context()
    tab = other.new_page()
    answer = tab.goto(window.used)
    assert answer is not None and answer.status == 403 and "open the address" in tab.content()
    other.close()
    port = urlsplit(window.home).port
    cookie = "; ".join(f"{each['name']}={each['value']}" for each in window.context.cookies())
    inside = [url for url in window.requests if "_nicegui" in url and url.endswith((".js", ".css"))]
    assert inside
    home = urlsplit(window.home).path
    known = (f"{home}/", urlsplit(inside[0]).path, *(f"{home}{path}" for path in (SOCKET, "/upload/1?name=a")))
    for path in (*known, "/", "/form/area"):
        for headers in (
            {},
            {"Host": "evil.example", "Cookie": cookie},
            {"Origin": "http://evil.example", "Cookie": cookie},
        ):
            assert port is not None
            connection = http.client.HTTPConnection("127.0.0.1", port)
            connection.request("POST" if "upload" in path else "GET", path, headers=headers)
            found = connection.getresponse()
            assert found.status == 403 and b"<" not in found.read(), (path, headers)
            connection.close()


def test_a_server_at_another_port_hears_no_secret(window: Window) -> None:
    """The browser is led there and back to a page of it: neither cookie nor path comes along."""
    heard: list[str] = []

    class Other(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            heard.append(f"{self.path} {self.headers}")
            self.send_response(200)
            self.end_headers()
            self.wfile.write(b"<h1>other</h1>")

        def log_message(self, *_: object) -> None:
            pass

    with http.server.HTTPServer(("127.0.0.1", 0), Other) as other:
        threading.Thread(target=other.serve_forever, daemon=True).start()
        tab = window.tab()
        tab.evaluate(f"location.href = 'http://127.0.0.1:{other.server_port}/'")
        tab.wait_for_url(f"**:{other.server_port}/")
        tab.reload()
        tab.close()
        other.shutdown()
    secrets = [urlsplit(window.home).path.strip("/"), *(each["value"] for each in window.context.cookies())]
    assert len(heard) > 1 and len(secrets) == 2 and all(map(len, secrets))
    assert not [line for line in heard if any(secret in line for secret in secrets)]


def test_a_page_of_results_reaches_its_neighbours_and_no_server(window: Window, tmp_path: Path) -> None:
    """A foreign report: its link to a page beside it works, what it asks of servers is not sent."""
    out = window.folder / "markers-foreign"
    tab = window.tab("form/markers?sample=1", results=False)
    tab.get_by_label("folder for the results").fill(str(out))
    until(tab, "document.querySelector('[aria-label=\"command line\"]').textContent.includes('foreign')", 20.0)
    tab.get_by_role("button", name="Run", exact=True).click()
    assert ": done" in ended(tab)
    address = str(tab.locator(".run a").get_attribute("href"))
    tab.close()
    (out / "deep").mkdir()
    (out / "deep" / "report.html").write_text("<h1>deep</h1>", encoding="utf-8")
    asks = f"""<h1>foreign</h1><a href="deep/report.html">deep</a><script>
      const say = what => {{ document.title += what; }};
      fetch('/').then(() => say('fetched '), () => say('refused '));
      new Image().src = '{window.home}/form/area';
      document.title += document.referrer + ' ' + origin + ' ';
    </script>"""
    (out / "report.html").write_text(asks, encoding="utf-8")
    asked: list[str] = []
    tab = window.context.new_page()
    tab.on("requestfinished", lambda request: asked.append(urlsplit(request.url).path))
    tab.goto(f"{window.home[: -len(urlsplit(window.home).path)]}{address}")
    until(tab, "/refused|fetched/.test(document.title)", 20.0)
    assert "refused" in tab.title() and "null" in tab.title()
    tab.get_by_role("link", name="deep").click()
    tab.wait_for_url("**/deep/report.html")
    assert tab.locator("h1").inner_text() == "deep"
    assert {path for path in asked if path != "/favicon.ico"} == {address, address.replace("report", "deep/report")}
    tab.close()


def test_it_listens_to_this_machine_only(window: Window) -> None:
    port = urlsplit(window.home).port
    with open("/proc/net/tcp", encoding="ascii") as table:
        rows = [
            line.split()[1] for line in table if line.split()[3] == "0A" and line.split()[1].endswith(f":{port:04X}")
        ]
    assert rows == [f"0100007F:{port:04X}"]


def test_a_wrong_input_is_said_at_its_field(window: Window) -> None:
    tab = window.tab("form/area?sample=1")
    tab.locator('[name="threshold"]').fill("4 parsec")
    bad = tab.locator(".field", has=tab.locator('[name="threshold"]')).locator(".bad")
    until(tab, "[...document.querySelectorAll('.bad')].some(each => each.textContent.includes('4 parsec'))", 20.0)
    assert "4 parsec" in (bad.text_content() or "") and tab.locator(".bad:not(:empty)").count() == 1
    assert tab.locator('[name="threshold"]').get_attribute("aria-invalid") == "true"
    tab.locator('[name="threshold"]').fill("4")
    until(tab, "[...document.querySelectorAll('.bad')].every(each => !each.textContent)", 20.0)
    tab.locator('[name="unit"]').select_option("m")
    tab.get_by_role("button", name="Run", exact=True).click()
    assert ": refused" in ended(tab)
    until(
        tab, "[...document.querySelectorAll('.field .bad')].some(each => each.textContent.includes('too large'))", 20.0
    )
    assert not list(window.folder.glob("**/.geocontact-*"))
    tab.close()


def test_a_form_takes_the_place_of_the_start_page(window: Window) -> None:
    """Without loading anew; address, title and focus go with it, and Back leads to the start page."""
    tab = window.tab()
    tab.evaluate("window.mark = 1")
    tab.get_by_role("link", name="try the sample of elbow design").click()
    tab.wait_for_selector(".field")
    until(tab, f"location.href === '{window.home}/form/elbow.design?sample=1'", 20.0)
    assert tab.title() == "elbow design – geocontact" and tab.evaluate("window.mark") == 1
    assert tab.evaluate("document.activeElement.textContent") == "elbow design"
    assert tab.locator('[name="limit"]').input_value() == "5" and tab.locator(".card").count() == 0
    tab.reload()
    tab.wait_for_selector(".field")
    tab.go_back()
    tab.wait_for_selector(".card")
    assert tab.title() == "geocontact" and tab.locator(".field").count() == 0
    with tab.context.expect_page() as other:  # a key of the browser keeps its meaning
        tab.get_by_role("link", name="open the form of area", exact=True).click(modifiers=["ControlOrMeta"])
    other.value.wait_for_selector(".field")
    assert other.value.url.endswith("/form/area") and tab.locator(".card").count() > 40
    other.value.close()
    tab.close()


def test_fields_are_enabled_when_they_have_an_effect(window: Window) -> None:
    tab = window.tab("form/area")
    tab.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    assert tab.locator('[name="modulus"]').is_disabled()
    tab.locator('[name="pressure"]').check()
    until(tab, "!document.querySelector('[name=modulus]').disabled", 20.0)
    tab.locator('[name="pressure"]').uncheck()
    until(tab, "document.querySelector('[name=modulus]').disabled", 20.0)
    tab.close()


def test_a_value_changed_runs_again_and_stands_beside(window: Window) -> None:
    """Two pages side by side, the words copied, and a study of them."""
    tab = window.tab("form/elbow.design?sample=1", results=False)
    tab.get_by_role("button", name="Run", exact=True).click()
    assert ": done" in ended(tab)
    first = tab.locator(".run strong").last.text_content() or ""
    tab.locator('[name="limit"]').fill("7")
    tab.locator('[name="limit"]').fill("8")  # Run follows at once
    tab.get_by_role("button", name="Run", exact=True).click()
    until(tab, "document.querySelectorAll('.run').length === 2", 20.0)
    second = ended(tab)
    assert ": done" in second and second.partition(":")[0] != first.partition(":")[0]
    tab.get_by_role("button", name=f"show {first.partition(':')[0]} beside", exact=True).click()
    until(tab, "document.querySelectorAll('.pages iframe').length === 2", 20.0)
    boxes = tab.evaluate("[...document.querySelectorAll('.pages iframe')].map(e => e.getBoundingClientRect().toJSON())")
    assert boxes[0]["y"] == boxes[1]["y"] and boxes[0]["right"] <= boxes[1]["left"]
    tab.get_by_role("button", name="copy the command line").click()
    tab.wait_for_timeout(200)
    assert tab.evaluate("navigator.clipboard.readText()") == tab.get_by_label("command line", exact=True).text_content()
    tab.get_by_role("button", name="make a study of this").click()
    until(tab, "document.querySelector('pre[aria-label=study]').textContent.includes('analysis')", 20.0)
    files = sorted(window.folder.glob("elbow-design-*-study.toml"))
    assert files and tomllib.loads(files[-1].read_text("utf-8"))["options"]["limit"] in (8, "8")
    record = json.loads((window.folder / second.partition(":")[0] / "run.json").read_text("utf-8"))
    assert float(record["options"]["limit"]) == 8.0
    tab.close()


@pytest.mark.slow
def test_a_sample_runs_behind_those_whose_results_it_reads(window: Window) -> None:
    """Run is pressed before its recording is there, in a folder where no other test has made it."""
    shutil.rmtree(samples.results_of("markers", window.folder), ignore_errors=True)
    tab = window.tab("form/ik?sample=1")
    tab.get_by_role("button", name="Run", exact=True).click()
    until(tab, "document.querySelectorAll('.run').length === 2", 20.0)
    assert ": done" in ended(tab)
    assert [": done" in each for each in tab.locator(".run strong").all_inner_texts()] == [True, True]
    tab.close()


def test_a_page_that_is_loaded_anew_is_as_before(window: Window) -> None:
    """What was filled in, its unit, and the run with its page; a mistake that is known before starts no run."""
    tab = window.tab("form/elbow.design?sample=1", results=False)
    tab.locator('[name="limit"]').fill("many")
    tab.get_by_role("button", name="Run", exact=True).click()
    until(tab, "document.activeElement.name === 'limit' && document.activeElement.ariaInvalid === 'true'", 20.0)
    assert tab.locator(".run").count() == 0
    tab.locator('[name="limit"]').fill("6")
    tab.get_by_role("button", name="Run", exact=True).click()
    first = ended(tab).partition(":")[0]
    until(tab, "document.querySelector('.pages').getBoundingClientRect().top < innerHeight / 2", 20.0)
    until(tab, "location.search.includes('filled')", 20.0)
    tab.reload()
    tab.wait_for_selector(".run")
    assert tab.locator('[name="limit"]').input_value() == "6"
    heads = "[...document.querySelectorAll('.run strong')].map(each => each.textContent)"
    until(tab, f"{heads}.some(each => each.startsWith('{first}: done'))", 20.0)
    tab.get_by_role("button", name=f"show {first}", exact=True).click()
    until(tab, "document.querySelectorAll('.pages iframe').length === 1", 20.0)
    assert tab.locator(f'iframe[title="results in {first}"]').count() == 1
    tab.close()


def test_a_file_that_was_added_is_taken_out_again(window: Window, tmp_path: Path) -> None:
    """A field for several takes the corrected file beside the first one, which one button removes; it stays after a
    reload, with its unit."""
    tab = window.tab("form/area")
    for name in ("wrong.csv", "right.csv"):
        (tmp_path / name).write_text("time [s],a [m]\n0,1\n1,2\n", encoding="utf-8")
        drop(tab, "motion", tmp_path / name)
    tab.get_by_role("button", name="remove wrong.csv from motion").click()
    until(tab, "!document.querySelector('[name=motion]').value.includes('wrong.csv')", 20.0)
    line = "document.querySelector('[aria-label=\"command line\"]').textContent"
    until(tab, f"!{line}.includes('wrong.csv') && {line}.includes('right.csv')", 20.0)
    tab.locator('[name="threshold-unit"]').select_option("cm")
    tab.locator('[name="threshold"]').fill("0.5")
    until(tab, f"{line}.includes('0.5') && {line}.includes('cm')", 20.0)
    until(tab, "location.search.includes('filled')", 20.0)
    tab.reload()
    said = "document.querySelector('.field:has([name=motion]) .content')?.textContent ?? ''"
    until(tab, f"({said}).includes('right.csv')", 60.0)
    assert tab.locator('[name="threshold-unit"]').input_value() == "cm"
    tab.close()


def test_what_is_kept_of_a_page_is_not_in_its_address(window: Window) -> None:
    """Addresses stay in the history of the browser, and the server takes 64 KiB of one."""
    tab = window.tab("form/area")
    typed = "\n".join(f"somebody/{'walk' * 200}{k:03d}.csv" for k in range(100))
    put = "(box, typed) => { box.value = typed; box.dispatchEvent(new Event('input', { bubbles: true })); }"
    tab.locator('[name="motion"]').evaluate(put, typed)
    line = "document.querySelector('[aria-label=\"command line\"]').textContent"
    until(tab, f"{line}.includes('walk099')", 60.0)
    until(tab, "location.search.includes('filled')", 60.0)
    assert "somebody" not in tab.url and len(urlsplit(tab.url).query) < 100
    tab.reload()
    tab.wait_for_selector("h1")
    assert tab.locator('[name="motion"]').input_value() == typed
    tab.close()


def test_a_file_that_is_chosen_lies_in_a_folder_of_the_run(window: Window, tmp_path: Path) -> None:
    cup = tmp_path / "a cup.stl"
    cup.write_bytes((sample_folder() / "cup_r24.stl").read_bytes())
    tab = window.tab("form/fit")
    tab.get_by_label("choose a file for mesh").set_input_files(cup)
    until(tab, "document.querySelector('[name=mesh]').value.endsWith('a cup.stl')", 20.0)
    there = Path(tab.locator('[name="mesh"]').input_value())
    assert there.read_bytes() == cup.read_bytes() and there.parent.name.endswith("-files")
    until(tab, "document.querySelector('[aria-label=\"command line\"]').textContent.includes('a cup.stl')", 20.0)
    tab.close()


def drop(tab: Page, name: str, file: Path) -> str:
    """What the page says of a file that was chosen for a field."""
    tab.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    tab.locator(f'.field:has([name="{name}"]) .pick input:not([webkitdirectory])').set_input_files(file)
    said = f"document.querySelector('.field:has([name=\"{name}\"]) .content')?.textContent ?? ''"
    until(tab, f"({said}).includes({json.dumps(file.name)})", 60.0)
    return str(tab.evaluate(said))


def test_a_surface_is_looked_at_and_its_unit_offered_not_taken(window: Window) -> None:
    """Faces and sides as the 50-byte records of the file have them; the page turns it once a unit is chosen."""
    tab = window.tab("form/fit")
    cup = sample_folder() / "cup_r24.stl"
    said = drop(tab, "mesh", cup)
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    corners = np.frombuffer(cup.read_bytes(), record, offset=84)["corners"].reshape(-1, 3)
    sides = np.ptp(corners, axis=0)
    assert f"{len(corners) // 3} triangles" in said and " × ".join(f"{side:.4g}" for side in sides) in said
    assert f"mm, then it is {np.linalg.norm(sides):.4g} mm across" in said
    unit = tab.locator('[name="unit"]')
    assert unit.input_value() == ""
    tab.get_by_role("button", name="show cup_r24.stl in 3-D").click()
    until(tab, "document.querySelector('.content').textContent.includes('choose the unit first')", 20.0)
    tab.get_by_role("button", name="use mm for cup_r24.stl").click()
    until(tab, "document.querySelector('[aria-label=\"command line\"]').textContent.includes('--unit=mm')", 20.0)
    assert unit.input_value() == "mm"
    tab.get_by_role("button", name="show cup_r24.stl in 3-D").click()
    frame = tab.frame_locator(".picture iframe")
    assert "coordinates in mm" in frame.locator("body").inner_text(timeout=60_000)
    tab.set_viewport_size({"width": 390, "height": 844})
    assert tab.evaluate("document.documentElement.scrollWidth") <= 390
    tab.close()


def test_a_relative_path_starts_where_the_window_does(window: Window) -> None:
    """Another file of that name in the folder for results is not looked at."""
    for folder, name in ((window.start, "cup_r24.stl"), (window.folder, "femoral_component_right_coarse.stl")):
        (folder / "same.stl").write_bytes((sample_folder() / name).read_bytes())
    tab = window.tab("form/fit")
    tab.locator('[name="mesh"]').fill("same.stl")
    said = "document.querySelector('.field:has([name=mesh]) .content')?.textContent ?? ''"
    until(tab, f"({said}).includes('triangles')", 60.0)
    size = (window.start / "same.stl").stat().st_size
    assert f"{(size - 84) // 50} triangles" in str(tab.evaluate(said))
    tab.close()


def test_a_unit_is_that_of_all_files_before_one_has_its_own(window: Window) -> None:
    tab = window.tab("form/area")
    drop(tab, "moving", sample_folder() / "femoral_component_right_coarse.stl")
    drop(tab, "fixed", sample_folder() / "tibial_insert_right_coarse.stl")
    line = "document.querySelector('[aria-label=\"command line\"]').textContent"
    tab.get_by_role("button", name="use mm for tibial_insert_right_coarse.stl").click()
    until(tab, f"{line}.includes('--unit=mm')", 20.0)
    assert "--unit-moving" not in str(tab.evaluate(line))
    tab.get_by_role("button", name="use cm for femoral_component_right_coarse.stl").click()
    until(tab, f"{line}.includes('--unit-moving=cm') && {line}.includes('--unit=mm')", 20.0)
    tab.close()


def test_markers_of_a_recording_are_compared_with_the_model(window: Window, tmp_path: Path) -> None:
    """A marker less than the model has, and a gap."""
    names = [f"{body}{k}" for body in ("pelvis", "femur_r", "tibia_r", "foot_r") for k in range(4)]
    rows = "\n".join(
        "\t".join([str(i + 1), f"{0.01 * i:.2f}", *("" if (i, k) == (0, 3) else f"{i + k}" for k in range(45))])
        for i in range(10)
    )
    head = (
        "PathFileType\t4\t(X/Y/Z)\tfew.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n100\t100\t10\t15\tmm\n"
    )
    named = "Frame#\tTime\t" + "\t\t\t".join(names[1:]) + "\n\t\t" + "\t".join("XYZ"[k % 3] for k in range(45)) + "\n"
    few = tmp_path / "few.trc"
    few.write_text(f"{head}{named}\n{rows}\n", encoding="utf-8")
    tab = window.tab("form/ik")
    said = drop(tab, "markers", few)
    assert (
        "10 frames, 0 to 0.09 s, 100 Hz" in said and "15 markers: pelvis1, pelvis2" in said and "pelvis2 10.0%" in said
    )
    said = drop(tab, "model", sample_folder() / "leg.osim")
    assert "4 bodies: pelvis, femur_r, tibia_r, foot_r" in said
    found = tab.locator('.field:has([name="markers"]) .content').text_content() or ""
    assert "15 of the model's 16 markers are in the recording; it lacks pelvis0" in found
    tab.close()


def test_a_mat_is_recognised_and_what_is_no_mesh_is_said_at_once(window: Window, tmp_path: Path) -> None:
    tab = window.tab("form/mat")
    said = drop(tab, "frames", sample_folder() / "mat_thigh_16x8" / "frames.csv")
    assert "recording of a pressure mat (grid)" in said and "layout" in said
    broken = tmp_path / "broken.stl"
    broken.write_bytes(b"\0" * 84)
    said = drop(tab, "surface", broken)
    assert "no triangles" in said or "no faces" in said, said
    assert tab.locator(".content .refused").count() == 1
    tab.close()


def test_a_field_for_one_file_takes_one_and_says_so(window: Window) -> None:
    tab = window.tab("form/fit")
    tab.evaluate("""() => { const data = new DataTransfer();
      for (const name of ['a.stl', 'b.stl']) data.items.add(new File(['x'], name));
      const drop = new DragEvent('drop', { dataTransfer: data, bubbles: true });
      document.querySelector('[name=mesh]').dispatchEvent(drop); }""")
    until(tab, "document.querySelector('[name=mesh]').value.endsWith('a.stl')", 20.0)
    said = tab.locator('.field:has([name="mesh"]) .failed').inner_text()
    assert said == "b.stl was not taken: one file is asked for here"
    tab.close()


def drop_folders(tab: Page, place: str, *folders: Path) -> None:
    """Let go of folders above an element, as a file manager does."""
    tab.locator(place).scroll_into_view_if_needed()
    box = tab.locator(place).bounding_box()
    assert box is not None
    at = {"x": box["x"] + 0.5 * box["width"], "y": box["y"] + 0.5 * box["height"]}
    data = {"items": [], "files": [str(each) for each in folders], "dragOperationsMask": 1}
    session = tab.context.new_cdp_session(tab)
    for kind in ("dragEnter", "dragOver", "drop"):
        session.send("Input.dispatchDragEvent", {"type": kind, **at, "data": data})
    session.detach()


def tree(folder: Path) -> dict[str, bytes]:
    return {file.relative_to(folder).as_posix(): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def test_a_folder_that_is_dropped_is_recognised_and_run(window: Window, leg: Path, tmp_path: Path) -> None:
    """Its files lie in the folder of the run as they lay; it is dropped on another field, chosen, and typed."""
    session = opencap(leg, tmp_path / "a session")
    put(leg, session, ("walk.mot", "OpenSimData/Kinematics/walk 2.mot"))
    for k in range(120):  # a browser lists a hundred at a time
        (session / "Videos" / f"note {k}.txt").write_text(str(k), encoding="utf-8")
    (session / "Videos" / "film.mp4").write_bytes(b"film")
    tab = window.tab("form/markers")
    drop_folders(tab, '.field:has([name="model"]) label', session)
    value = "document.querySelector('[name=coordinates]').value"
    until(tab, f"{value}.endsWith('a session')", 60.0)
    there = Path(str(tab.evaluate(value)))
    kept = tree(session)
    assert kept.pop("Videos/film.mp4") and tree(there) == kept and there.parent.name.endswith("-files")
    said = "document.querySelector('.field:has([name=coordinates]) .content')?.textContent ?? ''"
    until(tab, f"({said}).includes('OpenCap session')", 60.0)
    assert "3 trials: neutral (static by its name), walk 2, walk1" in str(tab.evaluate(said))
    assert "2 with markers, 2 with coordinates" in str(tab.evaluate(said))
    until(tab, "document.querySelector('[aria-label=\"Python lines\"]').textContent.includes('walk 2')", 60.0)
    tab.get_by_role("button", name="make a study of this").click()
    until(tab, "document.querySelector('[aria-label=\"study\"]').textContent.includes('[[trials]]')", 60.0)
    described = tomllib.loads(str(tab.locator('[aria-label="study"]').text_content()))
    assert [each["trial"] for each in described["trials"]] == ["walk 2", "walk1"]
    tab.get_by_label("choose a folder for coordinates").set_input_files(session)
    until(tab, f"{value} !== {json.dumps(str(there))}", 60.0)
    assert tree(Path(str(tab.evaluate(value)))) == kept
    tab.locator('[name="coordinates"]').fill(str(tmp_path))
    until(tab, f"({said}).includes('is no folder of trials')", 60.0)
    tab.close()


def test_a_folder_that_is_not_taken_says_why(window: Window, tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "a.trc").touch()
    (tmp_path / "empty").mkdir()
    for form, field, names, why in (
        ("ik", "markers", ("one", "two"), "one, two was not taken: drop one folder"),
        ("ik", "markers", ("empty",), "empty was not taken: it holds no files; type its path"),
        ("ik", "markers", ("one", "one/a.trc"), "one, a.trc was not taken: drop one folder"),
        ("fit", "mesh", ("one",), "one was not taken: this form takes files here"),
    ):
        tab = window.tab(f"form/{form}")
        drop_folders(tab, f'.field:has([name="{field}"]) label', *(tmp_path / name for name in names))
        failed = tab.locator(f'.field:has([name="{field}"]) .failed')
        failed.wait_for()
        assert failed.inner_text() == why
        assert tab.locator(f'[name="{field}"]').input_value() == ""
        tab.close()


def test_no_file_of_a_folder_is_written_outside_of_it(window: Window) -> None:
    """Names that no browser sends, and files of two folders."""
    tab = window.tab("form/ik")
    address = tab.locator("input[webkitdirectory]").get_attribute("data-to")
    before = {*window.folder.parent.rglob("*")}
    script = """async ([to, names]) => { const data = new FormData();
      for (const name of names) data.append(name, new File(['x'], 'x'));
      const answer = await fetch(to + '/folder', { method: 'POST', body: data });
      return [answer.status, await answer.text()]; }"""
    for name in ("../a.trc", "s/../../a.trc", "/a.trc", "s//a.trc", "s/..\\a.trc", "t/a.trc", "a.trc"):
        status, words = tab.evaluate(script, [address, ["s/b.trc", name]])
        assert status in (404, 422) and ("a.trc" in words or "one folder" in words), (name, words)
    made = {*window.folder.parent.rglob("*")} - before
    assert not [each for each in made if each.is_file()]
    tab.close()


def test_what_comes_later_is_not_put_into_a_folder_with_a_number_for_a_name(window: Window) -> None:
    """A subject is called 2; files of one name that belong together lie together."""
    tab = window.tab("form/ik")
    address = tab.locator("input[webkitdirectory]").get_attribute("data-to")
    folder = """async to => { const data = new FormData();
      data.append('2/b.trc', new File(['x'], 'b.trc'));
      return (await fetch(to + '/folder', { method: 'POST', body: data })).text(); }"""
    file = "async ([to, name]) => (await fetch(to + '?name=' + name, { method: 'POST', body: name })).text()"
    subject = Path(str(tab.evaluate(folder, address)))
    taken = [Path(str(tab.evaluate(file, [address, name]))) for name in ("a.trc", "c.trc", "a.trc", "c.trc", "2")]
    assert subject.name == "2" and tree(subject) == {"b.trc": b"x"}
    assert taken[0].parent == taken[1].parent != taken[2].parent == taken[3].parent
    assert all(each.read_text("utf-8") == each.name for each in taken)
    tab.close()


def test_a_window_that_was_ended_is_said(window: Window) -> None:
    """In place of the words of the library, which wait for a server that never comes back at that address."""
    tab = window.tab()
    assert not tab.locator("#popup").is_visible()
    tab.evaluate("window.socket.disconnect()")
    tab.locator("#popup").wait_for(state="visible")
    assert "start it again" in tab.locator("#popup").inner_text()
    tab.close()


def test_two_files_of_one_name_stay_two(window: Window, tmp_path: Path) -> None:
    """a/m.stl as moving and b/m.stl as fixed; a file that cannot be taken is said at its field."""
    tab = window.tab("form/area")
    kept = []
    for name in ("moving", "fixed"):
        file = tmp_path / name / "m.stl"
        file.parent.mkdir()
        file.write_text(name, encoding="utf-8")
        tab.get_by_label(f"choose a file for {name}", exact=True).set_input_files(file)
        until(tab, f"document.querySelector('[name={name}]').value.endsWith('m.stl')", 20.0)
        kept.append(Path(tab.locator(f'[name="{name}"]').input_value()))
    assert [each.read_text("utf-8") for each in kept] == ["moving", "fixed"]
    tab.route("**/upload/**", lambda route: route.abort())
    tab.get_by_label("choose a file for motion", exact=True).set_input_files(file)
    until(
        tab,
        "document.querySelector('[name=motion]').closest('.field').textContent.includes('m.stl was not taken')",
        20.0,
    )
    assert tab.locator('[name="motion"]').input_value() == ""
    tab.close()


@pytest.mark.skipif(os.name == "nt", reason="groups of processes of POSIX")
def test_cancel_leaves_nothing(window: Window) -> None:
    tab = window.tab("form/gap.benchmark?sample=1")
    tab.locator('[name="cases"]').fill("50")
    tab.wait_for_timeout(600)
    out = Path(tab.get_by_label("folder for the results").input_value())
    tab.get_by_role("button", name="Run", exact=True).click()
    until(tab, "/: running/.test(document.querySelector('.run strong')?.textContent ?? '')", 60.0)
    tab.wait_for_timeout(3000)
    tab.get_by_role("button", name=f"cancel {out.name}", exact=True).click()
    assert ": cancelled" in ended(tab)
    assert not out.exists() and not list(window.folder.glob(".geocontact-*"))
    tab.close()


def test_by_keyboard_alone(window: Window) -> None:
    """Tab reaches every field that is enabled and Run, in the order of the page; Enter runs."""
    tab = window.tab("form/markers?sample=1", results=False)
    tab.locator("body").click()
    reached = []
    for _ in range(40):
        tab.keyboard.press("Tab")
        reached.append(tab.evaluate("document.activeElement.name || document.activeElement.textContent"))
        if reached[-1] == "Run":
            break
    assert reached[-1] == "Run" and "model" in reached
    tab.keyboard.press("Enter")
    assert ": done" in ended(tab)
    tab.close()


@pytest.mark.parametrize("path", ["", "form/area?sample=1", "form/knee.settle?sample=1", "form/mat"])
def test_labels_and_no_horizontal_bar_on_a_phone(path: str, window: Window) -> None:
    tab = window.tab(path)
    tab.set_viewport_size({"width": 390, "height": 844})
    tab.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    tab.wait_for_timeout(300)
    assert tab.evaluate("document.documentElement.scrollWidth") <= 390
    nameless = "[...document.querySelectorAll('input, select, textarea')].filter(e => !e.labels.length && !e.ariaLabel)"
    assert tab.evaluate(f"{nameless}.map(e => e.outerHTML)") == []
    silent = "[...document.querySelectorAll('button, a')].filter(e => !e.textContent.trim() && !e.ariaLabel)"
    assert tab.evaluate(f"{silent}.map(e => e.outerHTML)") == []
    described = "[...document.querySelectorAll('[aria-describedby]')].every(e => e.getAttribute('aria-describedby')"
    assert tab.evaluate(f"{described}.split(' ').every(id => document.getElementById(id)))")
    tab.close()
