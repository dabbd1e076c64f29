"""The watch of permissions: a renewal that fails is tried again, and files that are gone for a moment end nothing."""

from __future__ import annotations

import threading

import pytest

from robolink.exceptions import TransportError
from robolink.transport import secured
from robolink.transport.certificates import Validity
from tests.support.waits import wait_until


class Fickle:
    """A session whose files cannot be read at first, and that fails to be renewed twice."""

    enclave, has_left = "/robot", False
    validity = Validity(0.0, float("inf"), "cert.pem")

    def __init__(self) -> None:
        self.looks = self.renewals = 0

    def fingerprint(self) -> int:
        """Return the number of a state: the first one, nothing that could be read, and then the next one."""
        self.looks += 1
        if self.looks == 2:
            raise FileNotFoundError
        return min(self.looks, 3)

    def renew(self) -> None:
        """Fail twice."""
        self.renewals += 1
        if self.renewals < 3:
            raise TransportError("the port is taken")

    def reopen(self) -> None:
        """Do nothing."""


def test_a_renewal_that_fails_is_tried_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(secured, "LOOKS_EVERY", 0.005)
    session, before = Fickle(), {*threading.enumerate()}
    try:
        secured.watch(session)
        wait_until(lambda: session.looks > 8)
    finally:
        session.has_left = True
    for thread in {*threading.enumerate()} - before:
        thread.join(60.0)  # its last line may come late
    assert session.renewals == 3
