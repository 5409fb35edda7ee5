"""The window's process: how it ends, and a port that is taken."""

from __future__ import annotations

import http.client
import os
import re
import signal
import socket
import stat
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import resources
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from geocontact.app.server import _listening
from geocontact.data.errors import InputError
from tests.app.conftest import ENTRY

PATIENCE = 120.0  # s on a busy machine


@contextmanager
def served(folder: Path) -> Iterator[tuple[subprocess.Popen[str], str, int]]:
    """A window that is served, its address and its port; it is ended where a test fails while it runs."""
    command = [sys.executable, "-c", ENTRY, "app", "--no-browser", "--out", str(folder / "results")]
    process = subprocess.Popen(
        command,
        env=os.environ | {"TMPDIR": str(folder)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    with process:
        try:
            assert process.stdout is not None
            address = process.stdout.readline().strip()
            yield process, address, urlsplit(address).port or 0
        finally:
            process.kill()


def got(port: int, path: str, **headers: str) -> tuple[str, str]:
    """Cookie and text of a page."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    connection.request("GET", path, headers=headers)
    answer = connection.getresponse()
    text = answer.read().decode("utf-8")
    connection.close()
    assert answer.status == 200, text
    return answer.headers.get("set-cookie", "").partition(";")[0], text


def children(parent: int) -> list[int]:
    """Processes that a process has started and that still run."""
    found = subprocess.run(["ps", "-eo", "ppid=,pid=,stat="], capture_output=True, text=True).stdout
    rows = [line.split() for line in found.splitlines()]
    return [int(pid) for ppid, pid, state in rows if int(ppid) == parent and not state.startswith("Z")]


def running(process: int) -> bool:
    state = subprocess.run(["ps", "-o", "stat=", "-p", str(process)], capture_output=True, text=True).stdout
    return bool(state.strip()) and not state.startswith("Z")


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize(("how", "code"), [("SIGINT", 0), ("SIGTERM", 143), ("SIGHUP", 129)])
def test_it_ends_with_its_runs_and_its_folder(how: str, code: int, tmp_path: Path) -> None:
    """A form whose sample reads results of another one has begun that run."""
    if signal.getsignal(getattr(signal, how)) == signal.SIG_IGN:
        pytest.skip(f"{how} is ignored here, as under nohup")
    results = tmp_path / "results"
    with served(tmp_path) as (process, address, port):
        cookie, entrance = got(port, address.partition(str(port))[2])
        home = re.search(r"url=(/[^\"]+/)", entrance)
        assert home is not None and list(results.glob("geocontact-app-*"))
        assert [stat.S_IMODE(each.stat().st_mode) for each in results.glob("geocontact-app-*")] == [0o700]
        got(port, f"{home[1]}form/shoulder.compare?sample=1", Cookie=cookie)
        end = time.monotonic() + PATIENCE
        while not (runs := children(process.pid)):
            assert time.monotonic() < end and process.poll() is None
            time.sleep(0.02)
        process.send_signal(getattr(signal, how))
        assert process.wait(PATIENCE) == code
        said = process.stderr.read() if process.stderr is not None else ""
    assert not any(map(running, runs)) and "nothing was written" not in said and "Traceback" not in said, said
    assert not list(results.glob("geocontact-app-*")) and not list(tmp_path.rglob(".geocontact-*"))


def test_no_answer_without_the_cookie_names_the_path_of_the_pages(tmp_path: Path) -> None:
    leaks = []
    with served(tmp_path) as (process, address, port):
        cookie, entrance = got(port, address.partition(str(port))[2])
        found = re.search(r"url=/([^\"]+)/", entrance)
        assert found is not None and got(port, f"/{found[1]}/", Cookie=cookie)[1]
        for path in ("", "/", "/x", "/x/", "/x/y", "/x/y/", "/../form/area", "//", "/%2e%2e/", "/x%2fy"):
            for method in ("GET", "HEAD", "POST", "OPTIONS"):
                connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
                connection.request(method, f"/result{path}")
                answer = connection.getresponse()
                said = f"{answer.headers}{answer.read().decode()}"
                connection.close()
                if found[1] in said or answer.status < 300:
                    leaks.append((method, path, said))
        process.terminate()
    assert not leaks


def test_a_port_that_is_taken_is_said() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        with pytest.raises(InputError, match=r"port: .*cannot be used"):
            _listening(other.getsockname()[1])


@pytest.mark.skipif(os.name == "nt", reason="there it would let two listen")
def test_the_port_of_a_window_that_was_closed_is_free_at_once() -> None:
    """A connection that the server ended keeps its port for a minute."""
    with _listening(0) as here:
        port = here.getsockname()[1]
        with socket.create_connection(("127.0.0.1", port)) as client:
            there, _ = here.accept()
            there.close()
            client.recv(1)
    _listening(port).close()


def test_names_of_the_script_are_declared_once() -> None:
    """A browser takes nothing of a script that declares a name twice."""
    text = (resources.files("geocontact.app") / "script.js").read_text("utf-8")
    names = re.findall(r"^(?:const|let|class|(?:async )?function) (\w+)", text, re.MULTILINE)
    assert len(names) > 5 and len(set(names)) == len(names)
