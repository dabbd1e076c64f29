"""Certificates: what is wrong with their files is named, and so is why another side refuses them."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any

import pytest
import zenoh

from robolink.cli.main import main
from robolink.exceptions import TransportError
from robolink.transport import certificates
from robolink.transport.zenoh import ZenohTransport
from tests.support.authority import can_make, make_authority, make_certificate
from tests.support.ports import free_port, stranger
from tests.support.transports import GRAPH, until

pytestmark = [
    pytest.mark.processes,  # `openssl` makes the certificates
    pytest.mark.skipif(not can_make(), reason="there is no `openssl` to make certificates"),
]


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two authorities, lab and other, and a certificate of each: robot and stranger."""
    folder = tmp_path_factory.mktemp("certificates")
    for authority, name in (("lab", "robot"), ("other", "stranger")):
        make_authority(folder, authority)
        make_certificate(folder, name, authority)
    return folder


class Lab:
    """Configurations with these files."""

    def __init__(self, files: Path, folder: Path) -> None:
        self.files, self._folder, self.port = files, folder, free_port()

    def settings(self, mode: str = "client", certificate: str = "robot", **changed: Any) -> dict[str, Any]:
        own = {f"{use}_certificate": str(self.files / f"{certificate}.pem") for use in ("listen", "connect")}
        own |= {f"{use}_private_key": str(self.files / f"{certificate}.key") for use in ("listen", "connect")}
        tls = own | {"enable_mtls": True, "root_ca_certificate": str(self.files / "lab.pem")} | changed
        where = f"tls/127.0.0.1:{self.port}"
        return {
            "mode": mode,
            "listen": {"endpoints": [where] if mode == "peer" else []},
            "connect": {"endpoints": [where] if mode == "client" else []},
            "scouting": {"multicast": {"enabled": False}},
            "transport": {"link": {"protocols": ["tls"], "tls": tls}},
        }

    def config(self, *given: str, **changed: Any) -> zenoh.Config:
        found: zenoh.Config = zenoh.Config.from_json5(json.dumps(self.settings(*given, **changed)))
        return found

    def file(self, *given: str, **changed: Any) -> str:
        path = self._folder / f"{len(list(self._folder.iterdir()))}.json5"
        path.write_text(json.dumps(self.settings(*given, **changed)))
        return str(path)


@pytest.fixture
def lab(files: Path, tmp_path: Path) -> Lab:
    return Lab(files, tmp_path)


@pytest.fixture
def robot(lab: Lab) -> Iterator[ZenohTransport]:
    """A session that listens and wants certificates."""
    with closing(ZenohTransport(0, lab.file("peer"), {})) as session:
        yield session


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({}, ""),
        ({"connect_certificate": "/nowhere.pem"}, "connect_certificate /nowhere.pem is not there"),
        ({"connect_certificate": "."}, "connect_certificate . cannot be read"),
        ({"connect_certificate": "robot.key"}, "robot.key holds no certificate in PEM"),
        ({"connect_private_key": "robot.pem"}, "robot.pem holds no private key in PEM for"),
        ({"connect_private_key": "lab.key"}, "lab.key is not the key of"),
        ({"root_ca_certificate": "/nowhere.pem"}, "root_ca_certificate /nowhere.pem is not there"),
        ({"root_ca_certificate": "names"}, "names holds no certificate in PEM"),
    ],
)
def test_a_file_that_will_not_do_is_named(
    lab: Lab, changed: dict[str, str], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(lab.files)
    found = certificates.faults(lab.config("client", **changed))
    assert (said in " ".join(found), len(found)) == (True, bool(said))


def test_an_expired_certificate_is_named(lab: Lab) -> None:
    try:
        make_certificate(lab.files, "old", "lab", days="-1")
    except subprocess.CalledProcessError:
        pytest.skip("this openssl makes no certificates that have expired")
    assert certificates.faults(lab.config("client", "old")) == [
        f"connect_certificate {lab.files / 'old.pem'} has expired"
    ]
    with pytest.raises(TransportError, match=r"old\.pem has expired; connect_certificate .*old\.pem has expired$"):
        ZenohTransport(0, lab.file("peer", "old"), {})


def test_an_authority_of_ones_own_is_a_doubt_only(lab: Lab) -> None:
    found = lab.config("client", "stranger")
    assert certificates.faults(found) == []
    assert "stranger.pem is not signed by root_ca_certificate" in " ".join(certificates.doubts(found))
    assert certificates.doubts(lab.config("peer")) == []


def test_without_tls_there_is_nothing_to_check() -> None:
    for found in (zenoh.Config(), zenoh.Config.from_json5('{connect: {endpoints: ["tcp/127.0.0.1:1"]}}')):
        assert certificates.faults(found) == certificates.doubts(found) == certificates.refusals(found) == []


@pytest.mark.usefixtures("robot")
@pytest.mark.parametrize(
    ("certificate", "changed", "said"),
    [
        ("stranger", {}, "it does not trust the authority that signed "),
        ("robot", {"root_ca_certificate": "other.pem"}, "its certificate is not signed by "),
        ("robot", {"enable_mtls": False}, "it asks for a certificate"),
    ],
)
def test_a_refusal_says_why(
    lab: Lab, certificate: str, changed: dict[str, Any], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(lab.files)
    with pytest.raises(TransportError) as caught:
        ZenohTransport(0, lab.file("client", certificate, **changed), {})
    assert f"; tls/127.0.0.1:{lab.port}: {said}" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.usefixtures("robot")
def test_a_name_that_a_certificate_has_not_is_said(lab: Lab) -> None:
    (said,) = certificates.refusals(lab.config("client"), [f"tls/localhost:{lab.port}"])
    assert "its certificate is not for localhost" in said
    assert (
        certificates.refusals(lab.config("client", verify_name_on_connect=False), [f"tls/localhost:{lab.port}"]) == []
    )
    assert certificates.refusals(lab.config("client")) == []


def test_who_speaks_no_tls_says_so_or_nothing(lab: Lab) -> None:
    with stranger(lab.port, b"HTTP/1.1 400 Bad Request\r\n\r\n"):
        (said,) = certificates.refusals(lab.config("client"))
    assert said == f"tls/127.0.0.1:{lab.port}: it does not speak TLS"
    with stranger(
        lab.port, b"", hears=True
    ):  # as a session without TLS: it hangs up, and says nothing of our certificate
        assert certificates.refusals(lab.config("client")) == []
    assert certificates.refusals(lab.config("client"), ["tls/127.0.0.1:9", "tls/no.such.host.invalid:9", "tls/x"]) == []


@pytest.mark.usefixtures("patient_looks")
@pytest.mark.parametrize("host", ["127.0.0.1", "0.0.0.0"])
def test_one_file_with_certificates_serves_all_processes(lab: Lab, host: str) -> None:
    """Each is linked to each, though the certificate names the loopback's address only."""
    path = Path(lab.file("peer"))
    path.write_text(path.read_text().replace("tls/127.0.0.1", f"tls/{host}"))
    all_of_them = [f"@ros2_lv/0/{number}" for number in range(4)]
    with ExitStack() as stack:
        sessions = [stack.enter_context(closing(ZenohTransport(0, str(path), {}))) for _ in all_of_them]
        for session, token in zip(sessions, all_of_them, strict=True):
            session.announce(token)
        until(lambda: all(session.tokens(GRAPH) == all_of_them for session in sessions))


def test_a_process_that_is_not_let_in_says_why(
    robot: ZenohTransport, lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("robolink.transport.joining.LINK_WITHIN", 0.1)
    with pytest.raises(TransportError, match=f"tls/127.0.0.1:{lab.port} is taken, .*: it does not trust the authority"):
        ZenohTransport(0, lab.file("peer", "stranger"), {})


@pytest.mark.usefixtures("robot")
def test_doctor_tells_of_certificates(
    lab: Lab, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("robolink.transport.joining.LINK_WITHIN", 0.1)

    def verdict(path: str) -> dict[str, Any]:
        monkeypatch.setenv("ROBOLINK_NETWORK", path)
        main(["doctor", "--json"])
        (found,) = [each for each in json.loads(capsys.readouterr().out)["checks"] if each["name"] == "certificates"]
        return dict(found)

    assert verdict(lab.file("client"))["summary"] == "sound, and nobody refuses them"
    assert "it does not trust the authority" in verdict(lab.file("client", "stranger"))["errors"][0]
    assert "stranger.pem is not signed by" in verdict(lab.file("peer", "stranger"))["warnings"][0]
    assert verdict("localhost")["summary"] == "none are used with these settings"
