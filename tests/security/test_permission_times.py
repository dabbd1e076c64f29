"""Validity of permissions: outside of it an enclave has no rights, which is told, and sessions that run follow it."""

from __future__ import annotations

import os
import re
import time
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest

from robolink.exceptions import DocumentError, SecurityError
from robolink.security import permissions, session
from robolink.security.keystore import PERMISSIONS, Keystore
from robolink.security.policy import Rule
from robolink.security.rights import load_rights
from robolink.system import clocks
from robolink.transport import secured
from robolink.transport.certificates import Validity

pytest.importorskip("cryptography", reason="needs the extra `security`")

HOUR = timedelta(hours=1)


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Keystore:
    store = Keystore(tmp_path / "keys")
    store.create()
    for name in ("/robot", "/student"):
        store.create_enclave(name)
    for name, value in {"ENABLE": "true", "STRATEGY": "Enforce", "KEYSTORE": str(store.path)}.items():
        monkeypatch.setenv(f"ROS_SECURITY_{name}", value)
    monkeypatch.delenv("ROS_SECURITY_ENCLAVE_OVERRIDE", raising=False)
    return store


def now() -> datetime:
    return datetime.now(timezone.utc)


def limit(store: Keystore, name: str, begin: datetime, end: datetime) -> Path:
    """Write permissions for everything that hold between two times."""
    path = store.folder(name) / PERMISSIONS
    path.write_bytes(permissions.write(name, [Rule("publish", True, "/*")], 0, (begin, end)))
    return path


def test_permissions_that_have_ended_or_not_begun_give_no_rights_and_a_line(store: Keystore) -> None:
    for begin, end, word, when in (
        (now() - 2 * HOUR, now() - HOUR, "ended", now() - HOUR),
        (now() + HOUR, now() + 2 * HOUR, "begin", now() + HOUR),
    ):
        path = limit(store, "/student", begin, end)
        found, mistakes = load_rights(store.enclaves, 0)
        assert not found["/student"].allows("publish", "/a")
        assert found["/robot"].allows("publish", "/a")
        [line] = mistakes
        assert line.startswith(f"{path}: these permissions {word} at {when:%Y-%m-%d %H:}")
        own = session.requested(os.environ, 0, "/robot")
        assert own is not None
        assert own.warnings == [f"{line}: this enclave has no rights"]
        with pytest.raises(SecurityError, match=re.escape(f"enclave '/student': {line}")):
            session.requested(os.environ, 0, "/student")


def test_a_denial_holds_at_any_time(store: Keystore) -> None:
    rules = [Rule("publish", True, "/*"), Rule("publish", False, "/a")]
    path = store.folder("/student") / PERMISSIONS
    path.write_bytes(permissions.write("/student", rules, 0, (now() - 2 * HOUR, now() - HOUR)))
    found, _ = load_rights(store.enclaves, 0)
    assert [each.name for each in found["/student"].denied] == ["/a"]
    assert found["/student"].allowed == []


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("2026-01-01T00:00:00", 0.0),
        ("2026-01-01T00:00:00.25Z", 0.0),
        ("2026-01-01T02:00:00+02:00", 0.0),
        ("2025-12-31T23:00:00-01:00", 0.0),
        ("2026-02-31T00:00:00", None),
        ("tomorrow", None),
        ("", None),
        ("2026-01-01T00:00:00+99:00", None),
    ],
)
def test_times_are_those_of_xml(store: Keystore, text: str, seconds: float | None) -> None:
    day = datetime(2026, 1, 1, tzinfo=timezone.utc)
    path = limit(store, "/student", day, day + HOUR)
    path.write_text(path.read_text("utf-8").replace("2026-01-01T00:00:00", text, 1), encoding="utf-8")
    if seconds is None:
        with pytest.raises(DocumentError, match="<not_before> is a time such as 2036-01-31T12:00:00, got"):
            permissions.load(path)
    else:
        assert {each.begin for each in permissions.load(path)} == {day.timestamp() + seconds}


def test_without_a_validity_permissions_always_hold(store: Keystore) -> None:
    path = limit(store, "/student", now() - 2 * HOUR, now() - HOUR)
    path.write_text(re.sub(r"<validity>.*</validity>", "", path.read_text("utf-8"), flags=re.DOTALL), encoding="utf-8")
    found, mistakes = load_rights(store.enclaves, 0)
    assert found["/student"].allows("publish", "/a")
    assert mistakes == []


def test_permissions_outlive_a_short_certificate(store: Keystore) -> None:
    """A renewal of it leaves them alone: all sessions would have to go on with other rights."""
    store.create_enclave("/brief", days=0.0)
    found = permissions.load(store.folder("/brief") / PERMISSIONS)
    assert all(each.end > time.time() + 3600 for each in found)


class Session:
    """A session that is renewed by its watch alone."""

    has_left, enclave, validity = False, "/robot", Validity(0.0, float("inf"), "cert.pem")

    def __init__(self, security: session.Security) -> None:
        self.security, self.renewals = security, 0

    def fingerprint(self) -> object:
        """Return the state of the files."""
        return session.fingerprint(self.security)

    def renew(self) -> None:
        """Read the files."""
        self.security = session.read(self.security)
        self.renewals += 1

    def reopen(self) -> None:
        """Do nothing."""


def test_sessions_follow_the_end_of_anothers_permissions(store: Keystore, monkeypatch: pytest.MonkeyPatch) -> None:
    """No file changes then."""
    limit(store, "/student", now() - HOUR, now() + HOUR)
    security = session.requested(os.environ, 0, "/robot")
    assert security is not None
    robot = Session(security)
    watch = secured.Watch(robot)
    assert watch.look()
    assert robot.renewals == 0
    assert robot.security.everybody["/student"].allows("publish", "/a")
    later = time.time() + 2 * HOUR.total_seconds()
    monkeypatch.setattr(clocks, "time_of_day", lambda: later)
    assert watch.look()
    assert robot.renewals == 1
    assert not robot.security.everybody["/student"].allows("publish", "/a")
    assert watch.look()
    assert robot.renewals == 1
