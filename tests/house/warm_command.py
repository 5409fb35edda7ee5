"""The command `geocontact` from a process that has its libraries loaded: what each start takes is spent once.

A server loads the libraries, then makes a copy of itself (fork) for every call. The copy takes over folder, variables,
arguments and streams of the caller, runs the command line and ends with its exit code. Each call so begins in a process
that has run no command before. Starts from nothing are tested in tests/cli/test_process.py.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STREAMS = 3
MOST = 1 << 20
"""Bytes of one call: arguments and variables."""

CLIENT = """\
import json, os, socket, sys
with socket.socket(socket.AF_UNIX) as line:
    line.connect(sys.argv[1])
    told = json.dumps([os.getcwd(), sys.argv[2:], dict(os.environ)]).encode()
    socket.send_fds(line, [len(told).to_bytes(4, "big")], [0, 1, 2])
    line.sendall(told)
    answer = line.recv(1)
    sys.exit(answer[0] if answer else 1)
"""
LOADED = (
    "geocontact.cli.main",
    "geocontact.analyses.area.result",
    "geocontact.dynamics.equations",
    "geocontact.view.page.write",
    "matplotlib.backends.backend_agg",
    "matplotlib.backends.backend_svg",
    "matplotlib.figure",
    "pandas",
    "scipy.interpolate",
    "scipy.optimize",
    "scipy.signal",
    "scipy.stats",
)
"""Modules that most commands need; no command has run when copies are made."""


@contextmanager
def warm_command(folder: Path) -> Iterator[str]:
    """Shell words that start the command, as long as the block lasts; the server keeps its socket in `folder`."""
    address, client = folder / "line", folder / "client.py"
    client.write_text(CLIENT, encoding="utf-8")
    command = [sys.executable, "-m", "tests.house.warm_command", str(address)]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE) as server:
        assert server.stdout is not None
        assert server.stdout.readline() == b"ready\n", "the server of commands did not start"
        try:
            yield f'"{sys.executable}" -I -S "{client}" "{address}"'
        finally:
            server.terminate()


def serve(address: str) -> None:
    """Answer calls until the process is ended."""
    from importlib import import_module

    from tests.one_core import one_core

    for name in LOADED:
        import_module(name)
    one_core()
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # copies that ended leave nothing behind
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(address)
        listening.listen()
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        while True:
            line, _ = listening.accept()
            if os.fork() == 0:
                listening.close()
                attend(line)
            line.close()


def attend(line: socket.socket) -> None:
    """In a copy: run the call in a copy of its own, and tell its exit code."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    head, streams, _, _ = socket.recv_fds(line, 4, STREAMS)
    told = b""
    while len(told) < int.from_bytes(head, "big"):
        told += line.recv(MOST)
    folder, arguments, variables = json.loads(told)
    runner = os.fork()
    if runner == 0:
        line.close()
        run(folder, arguments, variables, streams)
    _, status = os.waitpid(runner, 0)
    line.sendall(bytes([os.waitstatus_to_exitcode(status) % 256]))
    os._exit(0)


def run(folder: str, arguments: list[str], variables: dict[str, str], streams: list[int]) -> None:
    """The call itself, at the caller's place."""
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
    sys.stdin = os.fdopen(0, encoding="utf-8", closefd=False)
    sys.stdout, sys.stderr = (os.fdopen(number, "w", buffering=1, encoding="utf-8", closefd=False) for number in (1, 2))
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(variables)
    sys.argv[:] = ["geocontact", *arguments]
    from geocontact.cli.main import main

    code: object = 1
    try:
        main()
    except SystemExit as end:
        code = end.code
    except Exception:  # noqa: BLE001 - nobody is above to show it
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code if isinstance(code, int) else 1)


if __name__ == "__main__":
    serve(sys.argv[1])
