"""Watch of permissions: who was withdrawn is out, and whose turn it is may go on, without a restart by hand.

Zenoh reads its rules once. So a session whose keystore has changed goes on in a new one, behind the same handles.
"""

from __future__ import annotations

import contextlib
import threading
import time
import weakref
from typing import Protocol

from robolink.exceptions import TransportError
from robolink.logging import get_logger

LOOKS_EVERY = 1.0
"""Interval of the looks at the files, in seconds; a look at 30 enclaves takes 1.3 ms."""


class Renewable(Protocol):
    """A session that can go on with other permissions."""

    enclave: str

    @property
    def has_left(self) -> bool:
        """True once it is closed."""

    def fingerprint(self) -> object:
        """Return something that differs as soon as permissions or keys have changed."""

    def renew(self) -> None:
        """Go on with what the files say now; raises TransportError, and changes nothing, if it cannot."""


def watch(session: Renewable) -> None:
    """Call `session.renew` when its files have changed, on a background thread, for as long as it is open."""
    seen = session.fingerprint()
    thread = threading.Thread(target=_look, args=(weakref.ref(session), seen), name="robolink permissions", daemon=True)
    with contextlib.suppress(RuntimeError):  # Python 3.12 starts no threads any more at exit
        thread.start()


def _look(wanted: weakref.ref[Renewable], seen: object) -> None:
    told = ""
    while True:
        time.sleep(LOOKS_EVERY)
        session = wanted()
        if session is None or session.has_left:
            return
        with contextlib.suppress(OSError):  # files that come and go just now: the next look sees them
            now = session.fingerprint()
            if now != seen:
                told = _renew(session, told)
                seen = seen if told else now  # else who was withdrawn would stay in for good: the next look tries again
        del session  # not kept alive while this sleeps


def _renew(session: Renewable, told: str) -> str:
    """Renew a session; return why it cannot be, '' if it can. What has been told is not told again."""
    logger = get_logger("security")
    try:
        session.renew()
    except TransportError as error:
        if (why := str(error)) != told and not session.has_left:
            logger.error(f"permissions have changed, and this session goes on with the former ones: {why}")
        return why
    logger.info(f"enclave '{session.enclave}': permissions have changed, and count from now on")
    return ""
