"""Where a system is seen from a terminal: the page's address, and how it comes to a computer that has a browser."""

from __future__ import annotations

import sys

import pytest

from robolink.cli.shared import page
from robolink.extensions.optional import PAGE, is_here
from robolink.system.terminal import has_screen, ssh_tunnel

Captured = pytest.CaptureFixture[str]
BY_SSH = "10.0.0.5 50123 10.0.0.9 22"
TUNNEL = "ssh -L 8765:localhost:8765 ana@10.0.0.9"


class Server:
    """Server whose page nobody sees but who sits at its machine."""

    address = "http://127.0.0.1:8765/?token=abc"
    port = 8765
    exposed = False


@pytest.fixture(autouse=True)
def no_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    for each in ("DISPLAY", "WAYLAND_DISPLAY", "SSH_CONNECTION"):
        monkeypatch.delenv(each, raising=False)
    monkeypatch.setenv("USER", "ana")
    monkeypatch.setattr(sys, "platform", "linux")


@pytest.mark.parametrize(
    ("connection", "user", "expected"),
    [
        (BY_SSH, "ana", TUNNEL),
        ("10.0.0.5 50123 fe80::1 2222", "ana", "ssh -L 8765:localhost:8765 -p 2222 ana@fe80::1"),
        (BY_SSH, "", "ssh -L 8765:localhost:8765 10.0.0.9"),
        ("", "ana", ""),
        ("odd", "ana", ""),
    ],
)
def test_a_tunnel_leads_back_to_whom_ssh_came_from(
    connection: str, user: str, expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("LOGNAME", raising=False)
    monkeypatch.setenv("USER", user)
    monkeypatch.setenv("SSH_CONNECTION", connection)
    assert ssh_tunnel(8765) == expected


def test_a_mac_that_one_came_to_by_ssh_has_its_screen_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "darwin")
    assert has_screen()
    monkeypatch.setenv("SSH_CONNECTION", BY_SSH)
    assert not has_screen()


def test_without_a_browser_the_address_is_one_line_and_ssh_one_more(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    page.announce(Server(), browser=True, panels="")
    assert capsys.readouterr() == (f"robolink view: {Server.address}\n", "")
    monkeypatch.setenv("SSH_CONNECTION", BY_SSH)
    page.announce(Server(), browser=True, panels="")
    assert capsys.readouterr().err == (
        f"no browser here: `{TUNNEL}` on your own computer, and the address above opens there\n"
    )


def test_a_terminal_without_a_browser_is_told_where_to_look(monkeypatch: pytest.MonkeyPatch) -> None:
    if not is_here(PAGE):
        assert page.where_to_look() == ""
        return
    assert page.where_to_look() == "no browser here: to see the system, `robolink view` in another shell"
    monkeypatch.setenv("SSH_CONNECTION", BY_SSH)
    assert page.where_to_look().endswith(f"in another shell, and on your own computer `{TUNNEL}`")
    monkeypatch.setenv("DISPLAY", ":0")
    assert page.where_to_look() == ""


@pytest.mark.annex("view")
def test_the_port_is_the_pages_own() -> None:
    from robolink.view.server.view import PORT

    assert page.PORT == PORT
