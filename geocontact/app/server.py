"""The server of the window: on this machine only, behind its gate, until it is interrupted."""

from __future__ import annotations

import logging
import os
import signal
import socket
import tempfile
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape
from pathlib import Path
from typing import Any

from geocontact.app import files
from geocontact.app.gate import HOST, Application, Gate, secret
from geocontact.app.runs import Queue
from geocontact.data.errors import InputError

TITLE = "geocontact"
ENDING = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")
LONGEST_GOODBYE = 3
"""s that requests have to end after the server was asked to."""
NO_TELEMETRY = {"FASTAPI_OTEL_AUTO_CONFIGURE": "false", "OTEL_SDK_DISABLED": "true"}
"""Whatever the environment says, nothing is sent to a collector of traces."""


def serve(folder: Path, port: int, opens: bool, say: Callable[[str], None]) -> None:
    """Serve the window until it is interrupted; `say` gets the address before that.

    Parameters
    ----------
    folder
        For results.
    port
        0 for any that is free.
    opens
        Whether the browser is opened.
    """
    home = f"/{secret()}"
    queue = Queue(folder)
    with _ended_by_signals(queue) as stopped_by:
        application = _application(queue, home)
        import uvicorn  # comes with nicegui, whose absence is said before

        with _listening(port) as here, _private(folder) as private:
            gate = Gate(application, here.getsockname()[1], home)
            config = uvicorn.Config(
                gate,
                log_level="error",
                access_log=False,
                server_header=False,
                lifespan="on",
                timeout_graceful_shutdown=LONGEST_GOODBYE,
            )
            logging.getLogger("uvicorn.error").addFilter(_is_no_departure)
            server = uvicorn.Server(config)
            stopped_by.append(server)
            say(gate.address)
            if opens:
                webbrowser.open(_door(private, gate.address).as_uri())
            server.run(sockets=[here])


@contextmanager
def _ended_by_signals(queue: Queue) -> Iterator[list[Any]]:
    """Signals end the server that is appended to the list, or the program where there is none yet, then all runs.

    uvicorn raises those that it got once more when it has ended, and knows nothing of SIGHUP. An interruption is how a
    window ends: code 0.
    """
    servers: list[Any] = []
    code = 0

    def end(number: int, _: object) -> None:
        nonlocal code
        code = 0 if number == signal.SIGINT else 128 + number
        if not servers or servers[0].should_exit:
            raise SystemExit(code)
        servers[0].should_exit = True

    known = [getattr(signal, name) for name in ENDING if hasattr(signal, name)]
    known = [each for each in known if signal.getsignal(each) is not signal.SIG_IGN]  # nohup
    before = {each: signal.signal(each, end) for each in known}
    try:
        yield servers
    finally:
        for each in known:
            signal.signal(each, signal.SIG_IGN)  # ending the runs is not to be interrupted
        queue.close()
        files.close()
        for each in known:
            signal.signal(each, before[each])
    if code:
        raise SystemExit(code)


def _application(queue: Queue, home: str) -> Application:
    """All pages, below the path `home`, without a gate."""
    import fastapi

    os.environ.update(NO_TELEMETRY)
    from nicegui import ui

    from geocontact.app.pages import add_pages

    application = fastapi.FastAPI(openapi_url=None, docs_url=None, redoc_url=None)
    add_pages(queue, application)
    ui.run_with(
        application,
        mount_path=home,
        title=TITLE,
        tailwind=False,
        dark=None,
        show_welcome_message=False,
        language="en-US",
    )
    return application


def _is_no_departure(record: logging.LogRecord) -> bool:
    """Whether a message is of more than a browser that went on before the answer came."""
    error = record.exc_info[1] if record.exc_info else None
    return not (isinstance(error, RuntimeError) and str(error) == "No response returned.")


def _listening(port: int) -> socket.socket:
    """A socket of the loopback interface."""
    here = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if os.name != "nt":  # there it would let two programs listen at one port; here it frees that of a closed window
        here.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        here.bind((HOST, port))
        here.listen()
    except OSError as error:
        here.close()
        remedy = "choose another one, or leave it out for one that is free"
        raise InputError("", "port", f"{port} cannot be used ({error.strerror})", remedy) from error
    return here


@contextmanager
def _private(folder: Path) -> Iterator[Path]:
    """A folder below that of the results, for its owner only, as `tempfile` makes it; removed at the end.

    A browser that is a snap sees neither /tmp nor what is hidden.
    """
    with tempfile.TemporaryDirectory(prefix="geocontact-app-", dir=folder) as private:
        yield Path(private)


def _door(private: Path, address: str) -> Path:
    """A page that leads to the address, which others would see among the words of the browser's process."""
    page = private / "open.html"
    refresh = f'<meta http-equiv="refresh" content="0;url={escape(address)}">'
    page.write_text(f'<!doctype html><meta charset="utf-8">{refresh}<title>{TITLE}</title>\n', encoding="utf-8")
    page.chmod(0o600)
    return page
