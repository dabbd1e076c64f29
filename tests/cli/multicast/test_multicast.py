"""robolink multicast: a datagram to a group comes back, and what is wrong is one line."""

from __future__ import annotations

import socket
import threading

import pytest

from robolink.cli import multicast
from robolink.cli.main import main

Captured = pytest.CaptureFixture[str]


def test_a_datagram_is_received_and_shown(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    """Without a multicast route there may be none; so the datagram comes by loopback, as from another machine."""
    joined = threading.Event()

    def join(receiver: socket.socket, group: str, port: int) -> None:
        receiver.bind(("127.0.0.1", 0))
        joined.port = receiver.getsockname()[1]  # type: ignore[attr-defined]
        joined.set()

    def speak() -> None:
        joined.wait(10)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.sendto(b"Hello \x1b[2J", ("127.0.0.1", joined.port))  # type: ignore[attr-defined]

    monkeypatch.setattr(multicast, "_join", join)
    speaker = threading.Thread(target=speak)
    speaker.start()
    assert main(["multicast", "receive", "--timeout", "10"]) == 0
    speaker.join()
    out = capsys.readouterr().out
    assert out.startswith("Waiting for UDP multicast datagram...\nReceived from 127.0.0.1:")
    assert out.endswith(": 'Hello \\x1b[2J'\n")


def test_what_is_sent_goes_to_the_group(monkeypatch: pytest.MonkeyPatch) -> None:
    sent: list[tuple[bytes, tuple[str, int]]] = []

    class Sender(socket.socket):
        def sendto(self, data: bytes, address: tuple[str, int]) -> int:  # type: ignore[override]
            sent.append((data, address))
            return len(data)

    monkeypatch.setattr(socket, "socket", Sender)
    assert main(["multicast", "send"]) == 0
    assert main(["multicast", "send", "--group", "239.1.2.3", "--port", "5000", "--ttl", "2"]) == 0
    assert sent == [(b"Hello World!", ("225.0.0.1", 49150)), (b"Hello World!", ("239.1.2.3", 5000))]


@pytest.mark.parametrize(
    ("words", "code", "report"),
    [
        ("receive --timeout 0.01", 1, "nothing came within 0.01 s"),
        ("send --group 192.168.0.1", 2, "is not a multicast address"),
        ("receive --group x", 2, "'x' is not a multicast address"),
        ("send --port 0", 2, "--port"),
    ],
)
def test_what_is_wrong_is_one_line(
    words: str, code: int, report: str, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(multicast, "_join", lambda receiver, group, port: receiver.bind(("127.0.0.1", 0)))
    assert main(["multicast", *words.split()]) == code
    err = capsys.readouterr().err
    assert (report in err, err.count("\n")) == (True, 1)
