"""The guard: what it lets through, of pages and of websockets."""

import asyncio

import pytest

from dqpaint.studio.guard import Guard, new_token

PORT, TOKEN = 8470, "a-token-of-this-start"
OWN = f"127.0.0.1:{PORT}"


def asked(kind="http", host=OWN, origin=None, token=TOKEN, cookie=None, port=PORT):
    """Whether a request gets through, and what is sent where it does not."""
    headers = [(b"host", host.encode())] if host is not None else []
    headers += [(b"origin", origin.encode())] if origin is not None else []
    headers += [(b"cookie", cookie.encode())] if cookie is not None else []
    query = f"token={token}".encode() if token is not None else b""
    scope = {"type": kind, "headers": headers, "query_string": query}
    passed, sent = [], []

    async def app(_scope, _receive, send):
        passed.append(True)
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def receive():
        return {"type": "websocket.connect"}

    async def send(message):
        sent.append(message)

    asyncio.run(Guard(app, TOKEN, port)(scope, receive, send))
    return bool(passed), sent


def test_its_own_page_and_websocket_get_through():
    assert asked()[0]
    assert asked(host=f"localhost:{PORT}")[0]
    assert asked("websocket", origin=f"http://{OWN}")[0]
    assert asked(token=None, cookie=f"x=1; dqpaint_studio_{PORT}={TOKEN}")[0]


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize(
    "wrong",
    [
        {"host": "evil.example"},
        {"host": f"evil.example:{PORT}"},
        {"host": "127.0.0.1:1"},
        {"host": None},
        {"origin": "http://evil.example"},
        {"origin": f"https://{OWN}"},
        {"origin": "null"},
        {"origin": f"http://{OWN}.evil.example"},
        {"token": None},
        {"token": "another"},
        {"token": ""},
        {"token": None, "cookie": f"dqpaint_studio_{PORT}=another"},
        {"token": None, "cookie": f"dqpaint_studio_{PORT + 1}={TOKEN}"},
    ],
)
def test_others_do_not(kind, wrong):
    given = {"origin": f"http://{OWN}", **wrong}
    passed, sent = asked(kind, **given)

    assert not passed
    expected = {"http": ("status", 403), "websocket": ("code", 1008)}[kind]
    assert sent[0][expected[0]] == expected[1]


def test_a_websocket_must_say_where_it_comes_from():
    assert not asked("websocket")[0]


def test_pages_are_marked():
    _, sent = asked()
    names = dict(sent[0]["headers"])

    assert names[b"x-frame-options"] == b"DENY"
    assert b"HttpOnly" in names[b"set-cookie"]
    assert b"SameSite=Strict" in names[b"set-cookie"]


def test_tokens_differ():
    assert len({new_token() for _ in range(100)}) == 100
    assert len(new_token()) >= 20
