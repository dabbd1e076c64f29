"""Bad input of the security commands: each mistake is one line, and nothing good is lost by it."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.security import authority
from robolink.security.keystore import Keystore

pytest.importorskip("cryptography", reason="needs the extra `security`")

POLICY = """<policy version="0.2.0"><enclaves>
<enclave path="{path}"><profiles>
<profile ns="{ns}" node="{node}">
<topics publish="ALLOW">{topics}</topics>
</profile></profiles></enclave></enclaves></policy>"""
GOOD = {"path": "/robot", "ns": "/", "node": "driver", "topics": "<topic>scan</topic>"}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("made") / "keys"
    store = Keystore(path)
    store.create()
    store.create_enclave("/robot")
    return path


@pytest.fixture
def keys(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    shutil.copytree(made, tmp_path / "keys", symlinks=True)
    return tmp_path / "keys"


def told(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """Return the one line that a command ends with."""
    capsys.readouterr()
    assert main(["security", *words]) == 1
    line = capsys.readouterr().err
    assert line.count("\n") == 1
    return line


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (("/" + "a" * 70,), "has 71 letters: the name in a certificate has at most 64"),
        (("/a", "--days", "nan"), "valid for some days, at most 1000000, got nan"),
        (("/a", "--days", "inf"), "at most 1000000, got inf"),
        (("/a", "--days", "-1e9"), "at most 1000000, got -1000000000.0"),
    ],
)
def test_a_certificate_that_cannot_be_is_told(
    keys: Path, words: tuple[str, ...], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert line in told(capsys, "create_enclave", str(keys), *words)
    assert Keystore(keys).names() == ["/robot"]
    assert not (keys / "enclaves" / words[0].strip("/")).exists()


@pytest.mark.parametrize(
    ("wrong", "line"),
    [
        ({"path": "../../evil"}, ":2: '../../evil' is not an enclave: must be absolute"),
        ({"path": "robot"}, ":2: 'robot' is not an enclave: must be absolute"),
        ({"ns": "/a b"}, ":3: ns is a namespace such as / or /arm, got '/a b': must not contain characters"),
        ({"ns": "//"}, ":3: ns is a namespace such as / or /arm, got '//': must not end with '/'"),
        ({"node": "my node"}, ":3: node is a name such as driver, got 'my node': must not contain characters"),
        ({"node": "../x"}, ":3: node is a name such as driver, got '../x'"),
        ({"node": ""}, ":3: node is a name such as driver, got '': must not be empty"),
        ({"topics": "<topic>~scan</topic>"}, ":4: <topic>~scan: behind ~, the node, comes a /"),
    ],
)
def test_a_name_that_is_none_is_told_with_its_line(
    keys: Path, wrong: dict[str, str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    policy = keys.parent / "policy.xml"
    policy.write_text(POLICY.format(**GOOD | wrong))
    before = (keys / "enclaves" / "robot" / "permissions.xml").read_bytes()
    assert f"policy.xml{line}" in told(capsys, "generate_artifacts", "-k", str(keys), "-p", str(policy))
    assert (keys / "enclaves" / "robot" / "permissions.xml").read_bytes() == before


def test_permissions_that_no_session_would_read_are_not_written(keys: Path, capsys: pytest.CaptureFixture[str]) -> None:
    policy = keys.parent / "policy.xml"
    policy.write_text(POLICY.format(**GOOD | {"topics": "".join(f"<topic>t{n:0200}</topic>" for n in range(5000))}))
    line = told(capsys, "create_permission", str(keys), "/robot", str(policy))
    assert "the permissions of '/robot' have 1," in line


@pytest.mark.slow
def test_includes_of_includes_end(keys: Path, capsys: pytest.CaptureFixture[str]) -> None:
    space = 'xmlns:xi="http://www.w3.org/2001/XInclude"'
    many = '<xi:include href="{}.xml"/>'
    for name, text in {
        "policy": f'<policy version="0.2.0" {space}>{many.format("middle") * 2}</policy>',
        "middle": f"<x {space}>{many.format('leaf') * 90}</x>",
        "leaf": f"<x>{'<enclave/>' * 5000}</x>",
    }.items():
        (keys.parent / f"{name}.xml").write_text(text)
    line = told(capsys, "create_permission", str(keys), "/robot", str(keys.parent / "policy.xml"))
    assert "middle.xml:1: xi:include of 'leaf.xml': more than 100000 elements are included" in line


@pytest.mark.parametrize("name", ["public/ca.cert.pem", "private/ca.key.pem"])
@pytest.mark.parametrize("content", [b"", b"garbage"])
def test_an_authority_that_is_none_is_told(
    keys: Path, name: str, content: bytes, capsys: pytest.CaptureFixture[str]
) -> None:
    (keys / name).write_bytes(content)
    assert "in PEM" in told(capsys, "create_enclave", str(keys), "/student")


def test_a_key_without_its_certificate_is_made_again(keys: Path) -> None:
    own = keys / "enclaves" / "robot"
    for broken in ("key.pem", "cert.pem"):
        (own / broken).write_bytes(b"")
        assert main(["security", "create_enclave", str(keys), "/robot"]) == 0
        assert authority.is_pair(authority.load(own / "cert.pem", own / "key.pem"))


def test_the_enclave_of_the_root_leaves_the_keystore_whole(keys: Path) -> None:
    assert main(["security", "create_enclave", str(keys), "/"]) == 0
    assert (keys / "enclaves" / "governance.p7s").read_bytes()
    assert Keystore(keys).names() == ["/", "/robot"]


def test_a_keystore_that_has_lost_a_link_keeps_its_authority(keys: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (keys / "public" / "ca.cert.pem").read_bytes()
    for name in ("public/identity_ca.cert.pem", "private/permissions_ca.key.pem"):
        (keys / name).unlink()
    assert main(["security", "create_keystore", str(keys)]) == 0
    assert (keys / "public" / "identity_ca.cert.pem").read_bytes() == before
    assert Keystore(keys).is_valid
    (keys / "private" / "ca.key.pem").unlink()
    line = told(capsys, "create_keystore", str(keys))
    assert "has enclaves, and private/permissions_ca.key.pem is not there: bring it back" in line
    assert (keys / "public" / "ca.cert.pem").read_bytes() == before


@pytest.mark.processes
def test_commands_at_once_do_not_mix_their_keys(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "robolink", "security", "create_keystore", str(tmp_path / "keys")]
    children = [subprocess.Popen(words, stderr=subprocess.PIPE, text=True) for _ in range(3)]
    try:
        found = sorted((child.communicate(timeout=60)[1], child.returncode) for child in children)
    finally:
        for child in children:
            child.kill()
            child.wait()
    assert found[0] == ("", 0)
    assert found[1:] == [(f"robolink: keystore '{tmp_path / 'keys'}' already exists\n", 1)] * 2
    public, private = tmp_path / "keys" / "public", tmp_path / "keys" / "private"
    assert authority.is_pair(authority.load(public / "ca.cert.pem", private / "ca.key.pem"))
