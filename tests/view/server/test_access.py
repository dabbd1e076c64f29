"""Access rules, by who asks: Host, Origin, token, cookie, and the page's files."""

from __future__ import annotations

import errno
import re
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.view.server import view
from robolink.view.server.access import Access, is_loopback
from robolink.view.server.view import View
from tests.support.view_clients import shown

UPGRADE = (
    "Connection: Upgrade",
    "Upgrade: websocket",
    "Sec-WebSocket-Version: 13",
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
    "Sec-WebSocket-Protocol: foxglove.sdk.v1",
)
LOCAL = Access("127.0.0.1", 8765, "secret")
OPEN = Access("0.0.0.0", 8765, "secret")


@pytest.mark.parametrize(
    "host", ["evil.example:8765", "evil.example", "192.168.1.7:8765", "", "[::1", "127.0.0.1.evil.example"]
)
@pytest.mark.parametrize("lines", [(), UPGRADE])
def test_a_foreign_host_is_refused(host: str, lines: tuple[str, ...]) -> None:
    with shown() as system:
        code, answer = system.ask("/", host or " ", *lines)
        assert code == 403
        assert "is not this server" in answer


@pytest.mark.parametrize(
    "others", ['prefs={"a": [1, 2]}; ', "a b; =; ;;", 'x="; ', "robolink_view_8766=other; ", "_xsrf=2|8f|é; "]
)
def test_the_cookies_of_other_programs_of_this_machine_do_not_hide_ours(others: str) -> None:
    own = "robolink_view_8765=secret"
    for cookies in (others + own, f"{own}; {others}"):
        assert LOCAL.judge("/", "localhost:8765", None, cookies).trusted
    assert not LOCAL.judge("/", "localhost:8765", None, others + "robolink_view_8766=secret").trusted


def test_a_token_with_any_letters_opens_the_page() -> None:
    with shown(token="a&b=#ç d;%2B+") as system:
        path = system.view.address.partition(f":{system.view.port}")[2]
        code, answer = system.ask(path)
        assert code == 303
        cookie = re.search(r"Set-Cookie: (\S+=\S+); HttpOnly", answer)
        assert cookie is not None
        assert system.view._access.judge("/", "localhost", None, cookie[1]).trusted


def test_a_port_that_windows_keeps_for_itself_is_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[int] = []
    listen = View._listen_at

    async def reserved(self: View, port: int) -> Any:
        tried.append(port)
        if len(tried) == 1:
            raise OSError(errno.EACCES, "Permission denied")
        return await listen(self, 0)

    monkeypatch.setattr(View, "_listen_at", reserved)
    monkeypatch.setattr(view, "_BUSY", {errno.EADDRINUSE, errno.EACCES})
    with shown(port=None):
        assert tried == [view.PORT, view.PORT + 1]


@pytest.mark.parametrize(
    "origin", ["https://evil.example", "null", "file://", "http://127.0.0.1:1", "http://localhost"]
)
@pytest.mark.parametrize("lines", [(), UPGRADE])
def test_a_foreign_origin_is_refused_but_with_the_token_in_the_address(origin: str, lines: tuple[str, ...]) -> None:
    with shown() as system:
        code, answer = system.ask("/", "", f"Origin: {origin}", *lines)
        assert (code, "is another site" in answer) == (403, True)
        cookie = f"Cookie: robolink_view_{system.view.port}={system.view.token}"
        assert system.ask("/", "", f"Origin: {origin}", cookie, *lines)[0] == 403
        assert system.ask("/?token=wrong", "", f"Origin: {origin}", *lines)[0] == 403
        expected = 101 if lines else 303
        assert system.ask(f"/?token={system.view.token}", "", f"Origin: {origin}", *lines)[0] == expected


def test_the_token_becomes_a_cookie_that_no_script_and_no_other_site_can_use() -> None:
    with shown() as system:
        code, answer = system.ask(f"/?token={system.view.token}")
        cookie = re.search(r"Set-Cookie: (\S+?)=(\S+?); (.*?)\r", answer)
        assert (code, cookie is not None) == (303, True)
        assert cookie is not None
        assert cookie[1] == f"robolink_view_{system.view.port}"
        assert {"HttpOnly", "SameSite=Strict"} <= set(cookie[3].split("; "))
        assert "Location: /\r" in answer


def test_the_page_is_served_with_strict_headers_and_nothing_beside_it() -> None:
    with shown() as system:
        code, answer = system.ask("/")
        assert code == 200
        assert "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self';" in answer
        assert "X-Content-Type-Options: nosniff" in answer
        for path in (
            "/../__init__.py",
            "/%2e%2e/__init__.py",
            "/..%2f",
            "//etc/passwd",
            "/panels",
            "/x.js",
            "/index.html/",
        ):
            assert system.ask(path)[0] == 404, path


@pytest.mark.parametrize("token", [True, False])
def test_a_client_knows_whether_it_may_change_something(token: bool) -> None:
    with shown() as system, system.client(token=token) as client:
        assert client.wait_for("serverInfo")["robolink"]["readOnly"] is not token


def test_nobody_may_change_anything_where_it_is_read_only() -> None:
    with shown(read_only=True) as system, system.client() as client:
        assert client.wait_for("serverInfo")["robolink"]["readOnly"]


@given(st.text(), st.text(), st.none() | st.text(), st.text())
def test_no_request_is_trusted_without_the_token(path: str, host: str, origin: str | None, cookies: str) -> None:
    if "secret" not in path + cookies:
        for access in (LOCAL, OPEN):
            assert not access.judge(path.replace("[", ""), host, origin, cookies).trusted


def test_beyond_loopback_everything_needs_the_token_and_any_address_of_the_machine_will_do() -> None:
    cookie = "robolink_view_8765=secret"
    assert "asks for its token" in OPEN.judge("/", "192.168.1.7:8765", None, "").refusal
    assert OPEN.judge("/?token=secret", "192.168.1.7:8765", None, "").trusted
    assert OPEN.judge("/", "192.168.1.7:8765", "http://192.168.1.7:8765", cookie).trusted
    assert "is not this server" in OPEN.judge("/", "evil.example", None, cookie).refusal
    assert not OPEN._replace(read_only=True).judge("/", "10.0.0.1", None, cookie).trusted


@pytest.mark.parametrize("name", ["localhost", "127.0.0.1", "127.9.9.9", "::1", "[::1]", "LOCALHOST"])
def test_own_names(name: str) -> None:
    assert is_loopback(name)


def test_the_cookie_opens_what_the_token_does() -> None:
    with shown() as system:
        cookie = {"Cookie": f"other=1; robolink_view_{system.view.port}={system.view.token}"}
        with system.client(token=False, additional_headers=cookie) as client:
            assert not client.wait_for("serverInfo")["robolink"]["readOnly"]
        origin = {"Origin": f"http://127.0.0.1:{system.view.port}"}
        with system.client(token=False, additional_headers=cookie | origin) as client:
            assert not client.wait_for("serverInfo")["robolink"]["readOnly"]
        assert system.ask("/?token=wrong", "", *UPGRADE)[0] == 403
        without = [each for each in UPGRADE if "Protocol" not in each]
        assert system.ask("/", "", *without)[0] == 400
