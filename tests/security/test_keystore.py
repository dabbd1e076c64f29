"""Keystores and the commands that make them: SROS2's layout, arguments and words."""

from __future__ import annotations

import datetime
import stat
import sys
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.security import authority, files, permissions, session
from robolink.security.keystore import Keystore
from tests.support.domains import free_domain

pytest.importorskip("cryptography", reason="needs the extra `security`")

LAYOUT = [
    *("enclaves/governance.p7s", "enclaves/governance.xml", "private/ca.key.pem", "private/identity_ca.key.pem"),
    *("private/permissions_ca.key.pem", "public/ca.cert.pem", "public/identity_ca.cert.pem"),
    "public/permissions_ca.cert.pem",
]
OF_ENCLAVE = {
    *("cert.pem", "governance.p7s", "identity_ca.cert.pem", "key.pem", "permissions.p7s"),
    *("permissions.xml", "permissions_ca.cert.pem"),
}
POLICY = """<policy version="0.2.0"><enclaves><enclave path="/talk"><profiles><profile ns="/" node="talker">
<topics publish="ALLOW"><topic>chatter</topic></topics></profile></profiles></enclave></enclaves></policy>"""


@pytest.fixture
def store(tmp_path: Path) -> Path:
    assert main(["security", "create_keystore", str(tmp_path / "keys")]) == 0
    return tmp_path / "keys"


def test_the_layout_is_that_of_sros2(store: Path) -> None:
    there = sorted(each.relative_to(store).as_posix() for each in store.rglob("*") if each.is_file())
    assert there == LAYOUT
    assert main(["security", "create_enclave", str(store), "/lab/robot"]) == 0
    assert {each.name for each in (store / "enclaves" / "lab" / "robot").iterdir()} == OF_ENCLAVE
    signed = (store / "enclaves" / "lab" / "robot" / "permissions.p7s").read_text("utf-8")
    assert signed.startswith("MIME-Version: 1.0\n")
    assert 'multipart/signed; protocol="application/x-pkcs7-signature"; micalg="sha-256"' in signed


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no modes")
def test_keys_are_read_by_their_owner_alone(store: Path) -> None:
    main(["security", "create_enclave", str(store), "/a"])
    for path in (store / "private" / "ca.key.pem", store / "enclaves" / "a" / "key.pem"):
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        assert files.exposure(path) == ""
    path.chmod(0o640)
    assert f"mode 0640): chmod 600 {path}" in files.exposure(path)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no modes")
def test_files_that_others_may_change_are_told_in_one_line(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Who may write permissions may do everything, and who may write the authority's certificate lets anybody in."""
    for name in ("/a", "/b"):
        main(["security", "create_enclave", str(store), name])
    environ = {"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_KEYSTORE": str(store)}

    def told() -> list[str]:
        found = session.requested(environ, 0, "/a")
        assert found is not None
        return found.warnings

    assert told() == []
    said = f"may be changed by other users of this machine, and so what each enclave may do: chmod -R go-w {store}"
    permitted = store / "enclaves" / "b" / "permissions.xml"
    permitted.chmod(0o666)
    assert told() == [f"{permitted} {said}"]
    permitted.parent.chmod(0o777)
    (store / "public" / "ca.cert.pem").chmod(0o646)  # to which that of the enclave is a link
    assert told() == [f"{permitted} and 2 more {said}"]
    for path in (permitted, permitted.parent, store / "public" / "ca.cert.pem"):
        path.chmod(path.stat().st_mode & ~0o022)
    store.chmod(0o1777)
    assert told() == [], "nobody replaces another's file in a sticky folder"
    for is_own, lines in ((True, 0), (False, 1)):
        monkeypatch.setattr(files, "_is_own_group", lambda user, group, is_own=is_own: is_own)
        permitted.chmod(0o664)
        assert len(told()) == lines


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no modes")
def test_doctor_tells_files_that_others_may_change(
    store: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["security", "create_enclave", str(store), "/a"])
    for name, value in {"ENABLE": "true", "KEYSTORE": str(store), "ENCLAVE_OVERRIDE": "/a"}.items():
        monkeypatch.setenv(f"ROS_SECURITY_{name}", value)
    (store / "enclaves" / "governance.p7s").chmod(0o666)
    with free_domain() as domain:
        monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
        main(["doctor"])
    assert f"chmod -R go-w {store}" in capsys.readouterr().out


def test_certificates_are_those_of_sros2(store: Path) -> None:
    from cryptography import x509

    folder = Keystore(store).create_enclave("/lab/robot")
    made = x509.load_pem_x509_certificate((folder / "cert.pem").read_bytes())
    assert made.subject.rfc4514_string() == "CN=/lab/robot"
    assert made.issuer.rfc4514_string() == "CN=sros2CA"
    assert [each.critical for each in made.extensions] == [False]
    begin, end = authority.validity((folder / "cert.pem").read_bytes())
    assert end - begin == datetime.timedelta(days=3651)
    made.verify_directly_issued_by(x509.load_pem_x509_certificate((folder / "identity_ca.cert.pem").read_bytes()))


def test_a_second_time_changes_nothing_and_renew_only_the_key(store: Path) -> None:
    folder = Keystore(store).create_enclave("/a")
    Keystore(store).withdraw("/a")
    before = {name: (folder / name).read_bytes() for name in ("key.pem", "cert.pem", "permissions.xml")}
    assert main(["security", "create_enclave", str(store), "/a"]) == 0
    assert {name: (folder / name).read_bytes() for name in before} == before
    assert main(["security", "create_enclave", str(store), "/a", "--renew", "--days", "1"]) == 0
    after = {name: (folder / name).read_bytes() for name in before}
    assert [name for name in before if before[name] != after[name]] == ["key.pem", "cert.pem"]


def test_enclaves_are_listed(store: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["security", "list_enclaves", str(store)]) == 0
    assert capsys.readouterr().out == ""
    for name in ("/test_enclave", "/sky/is/the/limit"):
        main(["security", "create_enclave", str(store), name])
    main(["security", "list_enclaves", str(store)])
    assert capsys.readouterr().out == "/sky/is/the/limit\n/test_enclave\n"


def test_permissions_come_from_a_policy(store: Path, tmp_path: Path) -> None:
    policy = tmp_path / "policy.xml"
    policy.write_text(POLICY, encoding="utf-8")
    assert main(["security", "generate_artifacts", "-k", str(store), "-e", "/a", "/b", "-p", str(policy)]) == 0
    assert Keystore(store).names() == ["/a", "/b", "/talk"]
    found = permissions.load(store / "enclaves" / "talk" / "permissions.xml")
    published = {each.name for each in found if each.kind == "publish"}
    assert published == {"/chatter", "/rosout", "/parameter_events"}
    main(["security", "withdraw", str(store), "/talk"])
    assert not any(each.allows for each in permissions.load(store / "enclaves" / "talk" / "permissions.xml"))
    assert main(["security", "create_permission", str(store), "/talk", str(policy)]) == 0
    assert permissions.load(store / "enclaves" / "talk" / "permissions.xml") == found


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("create_keystore {KEYS}", "keystore '{KEYS}' already exists"),
        ("create_enclave {GONE} /a", "'{GONE}' is not a valid keystore"),
        ("list_enclaves {GONE}", "'{GONE}' is not a valid keystore"),
        ("create_enclave {KEYS} ../../a", "'../../a' is not a valid enclave name"),
        ("create_enclave {KEYS} a", "'a' is not a valid enclave name"),
        ("create_permission {KEYS} /tolk {POLICY}", "unable to find enclave \"/tolk\" (did you mean '/talk'?)"),
        ("create_permission {KEYS} /talk {POLICY}", "there is no enclave '/talk' in '{KEYS}'"),
        ("create_permission {KEYS} /talk {GONE}", "{GONE}: policy file does not exist"),
        ("withdraw {KEYS} /b", "there is no enclave '/b'"),
        ("generate_artifacts", "'ROS_SECURITY_KEYSTORE' isn't pointing at a valid keystore"),
    ],
)
def test_mistakes_are_one_line(
    words: str,
    told: str,
    store: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("ROS_SECURITY_KEYSTORE", raising=False)
    (tmp_path / "policy.xml").write_text(POLICY, encoding="utf-8")
    places = {"{KEYS}": store, "{GONE}": tmp_path / "gone", "{POLICY}": tmp_path / "policy.xml"}
    for short, place in places.items():
        told = told.replace(short, str(place))
    assert main(["security", *(str(places.get(each, each)) for each in words.split())]) == 1
    err = capsys.readouterr().err
    assert told in err
    assert err.count("\n") == 1


def test_a_broken_policy_leaves_no_keystore_behind(tmp_path: Path) -> None:
    (tmp_path / "policy.xml").write_text("<policy>", encoding="utf-8")
    assert main(["security", "generate_artifacts", "-k", str(tmp_path / "k"), "-p", str(tmp_path / "policy.xml")]) == 1
    assert not (tmp_path / "k").exists()
