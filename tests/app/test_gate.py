"""Nobody else reaches the window: not a second user, not another page, not a name that leads here, not twice."""

from __future__ import annotations

from collections.abc import MutableMapping
from typing import Any
from urllib.parse import urlsplit

import pytest

from geocontact.app.gate import Gate

PORT = 4711
HERE = f"127.0.0.1:{PORT}"
HOME = "/a-secret"
Message = MutableMapping[str, Any]


async def behind(scope: Message, receive: Any, send: Any) -> None:
    """Says that it was reached."""
    if scope["type"] == "websocket":
        await send({"type": "websocket.accept"})
        return
    own = [(b"content-security-policy", b"default-src 'none'")] if "/result/" in scope["path"] else []
    await send({"type": "http.response.start", "status": 200, "headers": own})
    await send({"type": "http.response.body", "body": b"inside"})


def asked(gate: Gate, path: str = f"{HOME}/", kind: str = "http", method: str = "GET", **headers: str) -> list[Message]:
    """What a request gets."""
    sent: list[Message] = []

    async def receive() -> Message:
        return {"type": "websocket.connect" if kind == "websocket" else "http.request"}

    async def send(message: Message) -> None:
        sent.append(message)

    parts = urlsplit(path)
    told = {"host": HERE} | headers
    scope = {
        "type": kind,
        "method": method,
        "path": parts.path,
        "query_string": parts.query.encode(),
        "headers": [(name.encode(), value.encode()) for name, value in told.items()],
    }
    with pytest.raises(StopIteration):  # nothing here waits; a loop of its own would clash with that of the browser
        next(iter(gate(scope, receive, send).__await__()))
    return sent


def entered(gate: Gate) -> str:
    """The cookie that the token is exchanged for."""
    answer = asked(gate, gate.address)
    head = dict(answer[0]["headers"])
    assert answer[0]["status"] == 200 and b"inside" not in answer[1]["body"]
    cookie = head[b"set-cookie"].decode()
    assert {"HttpOnly", "SameSite=Strict", f"Path={HOME}/"} <= set(cookie.split("; "))
    return cookie.partition(";")[0]


def refused(answer: list[Message]) -> bool:
    """403 and nothing of what is behind, or a websocket that is closed before it is accepted."""
    if answer[0]["type"] == "websocket.close":
        return len(answer) == 1
    if answer[0]["type"] == "websocket.accept":
        return False
    return answer[0]["status"] == 403 and b"inside" not in answer[1]["body"] and len(answer) == 2


def test_the_token_is_exchanged_once() -> None:
    gate = Gate(behind, PORT, HOME)
    address = gate.address
    cookie = entered(gate)
    assert asked(gate, cookie=cookie)[1]["body"] == b"inside"
    assert refused(asked(gate, address)), "the token is void after its first visitor"
    assert "None" in gate.address


@pytest.mark.parametrize("path", ["/", "/form/area", "/_nicegui/3.18.0/static/nicegui.css", "/results/1", "/upload/1"])
@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_nothing_is_served_without_the_cookie(path: str, kind: str) -> None:
    gate = Gate(behind, PORT, HOME)
    path = f"{HOME}{path}"
    for cookie in ("", f"geocontact-{PORT}=", f"geocontact-{PORT}=guess", "geocontact-1=x; a", "=;=,;\x00"):
        assert refused(asked(gate, path, kind, cookie=cookie)), cookie
    assert refused(asked(gate, f"{path}?token=", kind)) and refused(asked(gate, f"{path}?token=guess", kind))


def test_another_host_or_origin_is_refused_with_the_cookie_too() -> None:
    gate = Gate(behind, PORT, HOME)
    cookie = entered(gate)
    for kind in ("http", "websocket"):
        for host in (
            "evil.example",
            f"evil.example:{PORT}",
            "127.0.0.1",
            f"localhost:{PORT}",
            f"127.0.0.1:{PORT}.evil",
        ):
            assert refused(asked(gate, kind=kind, cookie=cookie, host=host)), host
        for origin in ("https://evil.example", "null", f"http://localhost:{PORT}", "http://127.0.0.1:1"):
            assert refused(asked(gate, kind=kind, cookie=cookie, origin=origin)), origin
        assert not refused(asked(gate, kind=kind, cookie=cookie, origin=f"http://{HERE}"))


def test_a_token_at_another_host_stays_valid() -> None:
    gate = Gate(behind, PORT, HOME)
    assert refused(asked(gate, gate.address, host="evil.example"))
    assert entered(gate)


def test_pages_may_load_nothing_from_elsewhere() -> None:
    gate = Gate(behind, PORT, HOME)
    head = dict(asked(gate, cookie=entered(gate))[0]["headers"])
    named = [each.split() for each in head[b"content-security-policy"].decode().split("; ")]
    known = {"'self'", "'none'", "'unsafe-inline'", "'unsafe-eval'", "data:", "blob:"}
    assert named[0] == ["default-src", "'self'"] and len({each[0] for each in named}) == len(named)
    for directive, *sources in named:
        assert set(sources) <= (known | {f"ws://{HERE}"} if directive == "connect-src" else known), directive


def test_a_cookie_is_worth_nothing_without_the_path() -> None:
    """A server at another port of this host gets the cookie, if at all, but not the secret below which pages lie."""
    gate = Gate(behind, PORT, HOME)
    cookie = entered(gate)
    for path in ("/", "/form/area", "/upload/1?name=a", "/_nicegui_ws/socket.io/", HOME, f"{HOME}x/", "/A-secret/"):
        for kind in ("http", "websocket"):
            assert refused(asked(gate, path, kind, cookie=cookie)), path
    head = dict(asked(gate, cookie=cookie)[0]["headers"])
    assert head[b"referrer-policy"] == b"no-referrer", "nobody hears the secret from a link"


@pytest.mark.parametrize(
    "others", ["{name}=old; {own}", "{own}; {name}=old", "alone; {own}", "a b;;{own};=", "x={own}"]
)
def test_cookies_of_others_beside_it(others: str) -> None:
    """An older one of the same name, and what is no pair, take nothing away; within a value it counts for nothing."""
    gate = Gate(behind, PORT, HOME)
    own = entered(gate)
    answer = asked(gate, cookie=others.format(name=own.partition("=")[0], own=own))
    assert refused(answer) == others.startswith("x=")


def test_results_need_no_cookie_but_this_host_and_keep_their_policy() -> None:
    gate = Gate(behind, PORT, HOME)
    answer = asked(gate, "/result/key/1/report.html")
    assert answer[1]["body"] == b"inside"
    kept = [value for name, value in answer[0]["headers"] if name == b"content-security-policy"]
    assert kept == [b"default-src 'none'"] and (b"x-content-type-options", b"nosniff") in answer[0]["headers"]
    assert refused(asked(gate, "/result/key/report.html", host="evil.example"))
    assert refused(asked(gate, "/result/key/report.html", origin="null"))
    assert refused(asked(gate, "/result/key/report.html", method="POST"))
    assert refused(asked(gate, "/result/key/report.html", "websocket"))
