"""A request for a page or a websocket -> let through, or refused: its token, Host and Origin.

A page of another site may send requests to a port of this machine, and open websockets there. So a
request needs the token of this start, which only the address that was printed has; its `Host` must
be this machine's (a name that leads here is refused), and its `Origin`, where it names one, too.
It stands before everything, websockets included: a middleware for pages alone does not see those.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any
from urllib.parse import parse_qs, urlsplit

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Asgi = Callable[[Scope, Receive, Send], Awaitable[None]]

NAMES = ("127.0.0.1", "localhost")
FORBIDDEN = 403
POLICY_VIOLATION = 1008  # the code with which a websocket is closed
LARGEST_HEADER = 4096  # bytes of one that is read
OF_PAGES = (
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),  # the token is in the address
    (b"x-frame-options", b"DENY"),
    (b"cross-origin-resource-policy", b"same-origin"),
)


def new_token() -> str:
    """A token of 128 bits."""
    return secrets.token_urlsafe(16)


class Guard:
    """An ASGI application that passes on what it lets through.

    Args:
        app: what is guarded.
        token: that the first address has.
        port: that is listened at.
    """

    def __init__(self, app: Asgi, token: str, port: int) -> None:
        self._app = app
        self._token = token
        self._hosts = {f"{name}:{port}" for name in NAMES}
        self._cookie = f"dqpaint_studio_{port}"  # ports share cookies

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal:
            await _refuse(scope, receive, send, refusal)
            return

        async def marked(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", ()), *OF_PAGES, self._set_cookie()]
            await send(message)

        await self._app(scope, receive, marked)

    def _refusal(self, scope: Scope) -> str:
        """Why a request is refused, a sentence; empty if it is not."""
        headers: dict[bytes, list[str]] = {}
        for name, value in scope["headers"]:
            headers.setdefault(name.lower(), []).append(value[:LARGEST_HEADER].decode("latin-1"))
        hosts, origins = headers.get(b"host", []), headers.get(b"origin", [])
        if len(hosts) != 1 or hosts[0].lower() not in self._hosts:
            return "this host name is not the studio's"
        websocket = scope["type"] == "websocket"
        if (websocket and not origins) or any(not self._is_own(origin) for origin in origins):
            return "a page of another site may not use the studio"
        if not self._has_token(scope, headers.get(b"cookie", [])):
            return "the address lacks the token of this start: open the one that was printed"
        return ""

    def _is_own(self, origin: str) -> bool:
        parts = urlsplit(origin)
        return parts.scheme == "http" and parts.netloc.lower() in self._hosts

    def _has_token(self, scope: Scope, cookies: list[str]) -> bool:
        query = parse_qs(scope.get("query_string", b"")[:LARGEST_HEADER].decode("latin-1"))
        pairs = [one.strip().partition("=") for line in cookies for one in line.split(";")]
        given = query.get("token", []) + [value for name, _, value in pairs if name == self._cookie]
        expected = self._token.encode()
        return any(hmac.compare_digest(one.encode(), expected) for one in given)

    def _set_cookie(self) -> tuple[bytes, bytes]:
        text = f"{self._cookie}={self._token}; Path=/; HttpOnly; SameSite=Strict"
        return b"set-cookie", text.encode()


async def _refuse(scope: Scope, receive: Receive, send: Send, reason: str) -> None:
    if scope["type"] == "websocket":
        await receive()  # the request to connect
        await send({"type": "websocket.close", "code": POLICY_VIOLATION, "reason": reason})
        return
    headers = [(b"content-type", b"text/plain; charset=utf-8"), *OF_PAGES]
    await send({"type": "http.response.start", "status": FORBIDDEN, "headers": headers})
    await send({"type": "http.response.body", "body": f"dqpaint studio: {reason}\n".encode()})
