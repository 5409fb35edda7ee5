"""Who may use the window: whoever opened the address that was printed, once, in one browser of this machine.

The address holds a token. Its first visitor gets a cookie in exchange, and the token is void. Everything else is 403:
pages, static files and websockets without the cookie, a Host that is not this address (a name that somebody else's
server resolves to 127.0.0.1), an Origin of another page. Cookies know no ports: that of the window is for the path
below which all its pages lie, a secret as well, so a server at another port gets neither. Results have an address of
their own, not to be guessed, without the cookie, which pages in a sandbox do not send for their links; it lies beside
the secret path, so that no answer to a request for it knows that path. Written for ASGI 3.0, in front of the whole
application.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any
from urllib.parse import parse_qs

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
Application = Callable[[Scope, Receive, Send], Awaitable[None]]

HOST = "127.0.0.1"
BYTES = 32
NO_REFERRER = (b"referrer-policy", b"no-referrer")
REFUSED = b"403: open the address that geocontact app printed; it can be used once"
RESULT = "/result/"
"""Where results are, each below a word that cannot be guessed."""
ENTER = (
    '<!doctype html><meta charset="utf-8"><meta http-equiv="refresh" content="0;url={home}"><title>geocontact</title>'
)
"""A page of its own, not a redirection: the cookie is SameSite=Strict, and the visitor may come from a file."""
POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; font-src 'self' data:; connect-src 'self' ws://{here}; frame-src 'self'; "
    "object-src 'none'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'self'"
)
"""Nothing is loaded from elsewhere, whatever a page asks for."""


def secret() -> str:
    """A word that cannot be guessed."""
    return secrets.token_urlsafe(BYTES)


class Gate:
    """An application that only its own browser reaches.

    Parameters
    ----------
    application
        What is behind it.
    port
        That it listens at.
    home
        Path below which its pages lie: "/" and a secret.
    """

    def __init__(self, application: Application, port: int, home: str) -> None:
        self.app = application
        self._home = f"{home}/"
        self._here = f"{HOST}:{port}"
        self._token: str | None = secret()
        self._secret = secret()
        self._cookie = f"geocontact-{port}"

    @property
    def address(self) -> str:
        """Where it is opened, once."""
        return f"http://{self._here}/?token={self._token}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request pass, exchange its token, or refuse it."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        if not self._is_here(headers):
            await _refuse(scope, receive, send)
        elif _of_results(scope) or (scope["path"].startswith(self._home) and self._known(headers.get("cookie", ""))):
            await self.app(scope, receive, self._with_policy(send))
        elif scope["type"] == "http" and self._exchanged(scope):
            cookie = f"{self._cookie}={self._secret}; Path={self._home}; HttpOnly; SameSite=Strict"
            head = [(b"content-type", b"text/html"), (b"set-cookie", cookie.encode()), (b"cache-control", b"no-store")]
            await _answer(send, 200, [*head, NO_REFERRER], ENTER.format(home=self._home).encode())
        else:
            await _refuse(scope, receive, send)

    def _is_here(self, headers: dict[str, str]) -> bool:
        """Whether a request was sent to this address, by a page of it or by none."""
        origin = headers.get("origin", "")
        return headers.get("host") == self._here and origin in ("", f"http://{self._here}")

    def _known(self, header: str) -> bool:
        """Whether one of the cookies is the secret: others may have its name, or be no pair."""
        pairs = [each.strip().partition("=") for each in header.split(";")]
        given = [value for name, _, value in pairs if name == self._cookie]
        return any(hmac.compare_digest(value.encode(), self._secret.encode()) for value in given)

    def _exchanged(self, scope: Scope) -> bool:
        """Whether the request brings the token, which is void from now on."""
        query = parse_qs(scope.get("query_string", b"").decode("latin-1"))
        given = query.get("token", [""])[0]
        if scope["path"] != "/" or self._token is None or not hmac.compare_digest(given.encode(), self._token.encode()):
            return False
        self._token = None
        return True

    def _with_policy(self, send: Send) -> Send:
        """Answers with the policy of contents, that of the window where a page has none of its own."""

        async def sent(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                more = [(b"x-content-type-options", b"nosniff"), NO_REFERRER]
                if not any(name.lower() == b"content-security-policy" for name, _ in message["headers"]):
                    more.append((b"content-security-policy", POLICY.format(here=self._here).encode()))
                message = {**message, "headers": [*message["headers"], *more]}
            await send(message)

        return sent


def _of_results(scope: Scope) -> bool:
    return scope["type"] == "http" and scope["method"] in ("GET", "HEAD") and str(scope["path"]).startswith(RESULT)


async def _refuse(scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008})  # before it is accepted: HTTP 403
        return
    await _answer(send, 403, [(b"content-type", b"text/plain; charset=utf-8")], REFUSED)


async def _answer(send: Send, status: int, headers: list[tuple[bytes, bytes]], body: bytes) -> None:
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body})
