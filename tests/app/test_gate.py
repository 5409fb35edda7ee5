"""Nobody else reaches the window: not a second user, not another page, not a name that leads here, not twice."""

from __future__ import annotations

from collections.abc import MutableMapping
from typing import Any
from urllib.parse import urlsplit

import pytest

from geocontact.app.gate import Gate

PORT = 4711
HERE = f"127.0.0.1:{PORT}"
Message = MutableMapping[str, Any]


async def behind(scope: Message, receive: Any, send: Any) -> None:
    """Says that it was reached."""
    if scope["type"] == "websocket":
        await send({"type": "websocket.accept"})
        return
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"inside"})


def asked(gate: Gate, path: str = "/", kind: str = "http", **headers: str) -> list[Message]:
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
    assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= set(cookie.split("; "))
    return cookie.partition(";")[0]


def refused(answer: list[Message]) -> bool:
    """403 and nothing of what is behind, or a websocket that is closed before it is accepted."""
    if answer[0]["type"] == "websocket.close":
        return len(answer) == 1
    if answer[0]["type"] == "websocket.accept":
        return False
    return answer[0]["status"] == 403 and b"inside" not in answer[1]["body"] and len(answer) == 2


def test_the_token_is_exchanged_once() -> None:
    gate = Gate(behind, PORT)
    address = gate.address
    cookie = entered(gate)
    assert asked(gate, cookie=cookie)[1]["body"] == b"inside"
    assert refused(asked(gate, address)), "the token is void after its first visitor"
    assert "None" in gate.address


@pytest.mark.parametrize("path", ["/", "/form/area", "/_nicegui/3.18.0/static/nicegui.css", "/result/1/report.html"])
@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_nothing_is_served_without_the_cookie(path: str, kind: str) -> None:
    gate = Gate(behind, PORT)
    for cookie in ("", f"geocontact-{PORT}=", f"geocontact-{PORT}=guess", "geocontact-1=x; a", "=;=,;\x00"):
        assert refused(asked(gate, path, kind, cookie=cookie)), cookie
    assert refused(asked(gate, f"{path}?token=", kind)) and refused(asked(gate, f"{path}?token=guess", kind))


def test_another_host_or_origin_is_refused_with_the_cookie_too() -> None:
    gate = Gate(behind, PORT)
    cookie = entered(gate)
    for kind in ("http", "websocket"):
        for host in (
            "evil.example",
            f"evil.example:{PORT}",
            "127.0.0.1",
            f"localhost:{PORT}",
            f"127.0.0.1:{PORT}.evil",
        ):
            assert refused(asked(gate, "/", kind, cookie=cookie, host=host)), host
        for origin in ("https://evil.example", "null", f"http://localhost:{PORT}", "http://127.0.0.1:1"):
            assert refused(asked(gate, "/", kind, cookie=cookie, origin=origin)), origin
        assert not refused(asked(gate, "/", kind, cookie=cookie, origin=f"http://{HERE}"))


def test_a_token_at_another_host_stays_valid() -> None:
    gate = Gate(behind, PORT)
    assert refused(asked(gate, gate.address, host="evil.example"))
    assert entered(gate)


def test_pages_may_load_nothing_from_elsewhere() -> None:
    gate = Gate(behind, PORT)
    head = dict(asked(gate, cookie=entered(gate))[0]["headers"])
    policy = head[b"content-security-policy"].decode()
    assert "default-src 'self'" in policy and "http" not in policy and "*" not in policy
