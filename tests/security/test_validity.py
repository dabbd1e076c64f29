"""Validity of a session's certificate: when it ends, its authority's included, and what each session reads for it."""

from __future__ import annotations

import datetime
import subprocess
import sys
from pathlib import Path

import pytest

from robolink.exceptions import SecurityError
from robolink.security import authority
from robolink.security.keystore import Keystore
from robolink.transport import certificates

pytest.importorskip("cryptography", reason="needs the extra `security`")

DAY = 86400.0


def end_of(folder: Path) -> float:
    return certificates.validity_of(
        *(str(folder / name) for name in ("cert.pem", "key.pem", "identity_ca.cert.pem"))
    ).end


def now() -> float:
    return datetime.datetime.now(datetime.timezone.utc).timestamp()


def keystore(folder: Path, monkeypatch: pytest.MonkeyPatch, days: float = authority.DAYS) -> Keystore:
    """Make a keystore whose authority is valid for so many days."""
    monkeypatch.setattr(authority, "DAYS", days)
    store = Keystore(folder / "keys")
    store.create()
    return store


def test_the_end_is_the_certificates(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = keystore(tmp_path, monkeypatch).create_enclave("/robot", days=2)
    assert end_of(folder) == pytest.approx(now() + 2 * DAY, abs=60)


def test_the_end_is_the_authoritys_where_that_comes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = keystore(tmp_path, monkeypatch, days=1).create_enclave("/robot", days=2)
    assert end_of(folder) == pytest.approx(now() + DAY, abs=60)


def test_an_authority_that_has_ended_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = keystore(tmp_path, monkeypatch, days=-1).create_enclave("/robot", days=2)
    with pytest.raises(SecurityError, match=r"^root_ca_certificate .*identity_ca\.cert\.pem has expired$"):
        end_of(folder)


def test_of_two_authorities_in_a_file_the_later_end_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    former = keystore(tmp_path / "former", monkeypatch, days=1).path / "public" / "ca.cert.pem"
    folder = keystore(tmp_path, monkeypatch, days=5).create_enclave("/robot", days=3)
    both = former.read_bytes() + (folder / "identity_ca.cert.pem").read_bytes()
    (folder / "identity_ca.cert.pem").unlink()
    (folder / "identity_ca.cert.pem").write_bytes(both)
    assert end_of(folder) == pytest.approx(now() + 3 * DAY, abs=60)


@pytest.mark.processes
def test_a_session_with_keys_imports_no_web(tmp_path: Path) -> None:
    """`xml.sax.saxutils` did, for 50 ms of each start."""
    code = "import sys, robolink.transport.secured; print([*{'http.client', 'shutil', '_strptime'} & {*sys.modules}])"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
