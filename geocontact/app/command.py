"""`geocontact app`: the window."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

from geocontact.data.errors import InputError

HIGHEST = 65_535


def window(*, out: Path = Path("geocontact-results"), port: int = 0, browser: bool = True) -> int:
    """Open a window in the browser: a form for every analysis, its progress and its page.

    It runs on this machine only and works without a network. The address that is printed can be used once; Ctrl-C ends.

    Parameters
    ----------
    out
        Folder for results and for files that are dropped on a form.
    port
        Port of 127.0.0.1; one that is free by default.
    browser
        Open the browser.
    """
    if not 0 <= port <= HIGHEST:
        raise InputError("", "", f"{port} is no port", f"give 0 to {HIGHEST}")
    if out.exists() and not out.is_dir():
        raise InputError(out, "", "is a file where results need a folder", "choose another one")
    if find_spec("nicegui") is None:  # before what comes with it is missed, which no extra names
        raise ModuleNotFoundError("No module named 'nicegui'", name="nicegui")
    from geocontact.app.server import serve

    out.mkdir(parents=True, exist_ok=True)
    serve(out.resolve(), port, browser, _say)
    return 0


def _say(address: str) -> None:
    print(f"{address}\nopen this address if no browser opens; Ctrl-C ends the window", flush=True)
