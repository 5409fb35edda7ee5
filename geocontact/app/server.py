"""The server of the window: on this machine only, behind its gate, until it is interrupted."""

from __future__ import annotations

import logging
import os
import socket
import tempfile
import webbrowser
from collections.abc import Callable
from html import escape
from pathlib import Path

from geocontact.app.gate import HOST, Application, Gate
from geocontact.app.runs import Queue

TITLE = "geocontact"
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
    queue = Queue(folder)
    application = _application(queue)
    import uvicorn  # comes with nicegui, whose absence is said before

    with _listening(port) as here, tempfile.TemporaryDirectory(prefix="geocontact-app-") as private:
        gate = Gate(application, here.getsockname()[1])
        say(gate.address)
        config = uvicorn.Config(gate, log_level="error", access_log=False, server_header=False, lifespan="on")
        logging.getLogger("uvicorn.error").addFilter(_is_no_departure)
        try:
            if opens:
                webbrowser.open(_door(Path(private), gate.address).as_uri())
            uvicorn.Server(config).run(sockets=[here])
        finally:
            queue.close()


def _application(queue: Queue) -> Application:
    """All pages, without a gate."""
    import fastapi

    os.environ.update(NO_TELEMETRY)
    from nicegui import ui

    from geocontact.app.pages import add_pages

    application = fastapi.FastAPI(openapi_url=None, docs_url=None, redoc_url=None)
    add_pages(queue)
    ui.run_with(application, title=TITLE, tailwind=False, dark=None, show_welcome_message=False, language="en-US")
    return application


def _is_no_departure(record: logging.LogRecord) -> bool:
    """Whether a message is of more than a browser that went on before the answer came."""
    error = record.exc_info[1] if record.exc_info else None
    return not (isinstance(error, RuntimeError) and str(error) == "No response returned.")


def _listening(port: int) -> socket.socket:
    """A socket of the loopback interface."""
    here = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    here.bind((HOST, port))
    here.listen()
    return here


def _door(private: Path, address: str) -> Path:
    """A page that leads to the address, which others would see among the words of the browser's process.

    The folder is for its owner only, as `tempfile` makes it.
    """
    page = private / "open.html"
    refresh = f'<meta http-equiv="refresh" content="0;url={escape(address)}">'
    page.write_text(f'<!doctype html><meta charset="utf-8">{refresh}<title>{TITLE}</title>\n', encoding="utf-8")
    page.chmod(0o600)
    return page
