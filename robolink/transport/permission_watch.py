"""Watch of a keystore: permissions and certificates that change count while all runs, and the end of one is told.

Zenoh reads its rules and keys once. So a session whose keystore has changed goes on in a new one, behind the same
handles: who was withdrawn is out, whose turn it is may go on, and a renewed certificate is in use before the old one
ends. A session whose certificate has ended goes on alone, since it would keep others from the port that it holds.
"""

from __future__ import annotations

import contextlib
import datetime
import threading
import time
import weakref
from typing import Protocol

from robolink.exceptions import TransportError
from robolink.logging import get_logger
from robolink.security.session import AUTHORITY
from robolink.system import clocks
from robolink.transport.certificates import Validity

LOOKS_EVERY = 1.0
"""Interval of the looks at the files, in seconds; a look at 30 enclaves takes 1.3 ms."""

SETTLES = 0.1
"""Time in seconds for which files stay as they are before they count: a key and its certificate are two."""

WARNS_BEFORE = datetime.timedelta(days=30).total_seconds()
"""Time in seconds before the end of a certificate from which on there is a warning; a tenth of a short validity."""


class Renewable(Protocol):
    """A session that can go on with other permissions and keys."""

    enclave: str

    @property
    def has_left(self) -> bool:
        """True once it is closed."""

    @property
    def validity(self) -> Validity:
        """Time in which its certificate counts."""

    def fingerprint(self) -> object:
        """Return something that differs as soon as permissions or keys have changed."""

    def renew(self) -> None:
        """Go on with what the files say now.

        Raises SecurityError for mistakes in the files, and TransportError if nobody is met with them.
        """

    def reopen(self) -> None:
        """Go on in a new session; alone, if the certificate has ended. Raises TransportError."""


def watch(session: Renewable) -> None:
    """Call `session.renew` when its files have changed, on a background thread, for as long as it is open."""
    watched = Watch(session)
    thread = threading.Thread(target=watched.run, name="robolink permissions", daemon=True)
    with contextlib.suppress(RuntimeError):  # Python 3.12 starts no threads any more at exit
        thread.start()


class Watch:
    """The looks at the files of one session, which it does not keep alive."""

    def __init__(self, session: Renewable) -> None:
        self._session = weakref.ref(session)
        self._seen = session.fingerprint()
        self._told = ""
        self._warned_of: Validity | None = None
        self._has_ended = False

    def run(self) -> None:
        """Look until the session is closed, or nobody has it any more."""
        while self.look():
            time.sleep(LOOKS_EVERY)

    def look(self) -> bool:
        """Look once, and renew the session if its files have changed; return False once it is closed."""
        session = self._session()
        if session is None or session.has_left:
            return False
        with contextlib.suppress(OSError):  # files that come and go just now: the next look sees them
            now = session.fingerprint()
            if now != self._seen:
                while now != (now := _later(session)):
                    pass
                if self._renew(session):
                    self._seen = now  # else who was withdrawn would stay in for good: the next look tries again
        self._judge(session)
        return True

    def _renew(self, session: Renewable) -> bool:
        """Renew a session; return whether it could be. Why it cannot be is told once."""
        logger = get_logger("security")
        try:
            session.renew()
        except TransportError as error:
            if (why := str(error)) != self._told and not session.has_left:
                logger.error(f"permissions or keys have changed, and do not count yet: {why}")
            self._told = why
            return False
        self._told, self._has_ended = "", clocks.time_of_day() >= session.validity.end
        logger.info(f"enclave '{session.enclave}': permissions or keys have changed, and count from now on")
        return True

    def _judge(self, session: Renewable) -> None:
        """Warn some time before the end of the certificate, and take the session out of the others' way after it."""
        valid, now = session.validity, clocks.time_of_day()
        has_ended = now >= valid.end
        if has_ended != self._has_ended:
            self._has_ended = has_ended
            if has_ended:
                get_logger("security").error(
                    f"{_of(session)} has ended, and nobody lets it in any more: {_remedy(session)}"
                )
            with contextlib.suppress(TransportError):  # a host that does not answer: nobody is in its way
                session.reopen()
        elif valid != self._warned_of and now >= valid.end - min(WARNS_BEFORE, (valid.end - valid.begin) / 10):
            self._warned_of = valid
            get_logger("security").warning(f"{_of(session)} ends at {_spelled(valid.end)}: {_remedy(session)}")


def _later(session: Renewable) -> object:
    time.sleep(SETTLES)
    return session.fingerprint()


def _of(session: Renewable) -> str:
    return f"enclave '{session.enclave}': {session.validity.file}"


def _remedy(session: Renewable) -> str:
    if session.validity.file.endswith(AUTHORITY):
        return "make a new keystore"
    return f"'robolink security create_enclave KEYSTORE {session.enclave} --renew', and no restart is needed"


def _spelled(when: float) -> str:
    return f"{datetime.datetime.fromtimestamp(when, datetime.timezone.utc):%Y-%m-%d %H:%M:%S} UTC"
