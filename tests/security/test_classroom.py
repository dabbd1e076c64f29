"""A class: a folder of keys for each student, who sees the robot, and drives it only when it is its turn."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.security import session
from robolink.security.keystore import Keystore
from robolink.security.policy import Rule
from robolink.security.rights import Rights, load_rights

pytest.importorskip("cryptography", reason="needs the extra `security`")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    assert main(["security", "class", str(tmp_path / "class"), "--students", "3"]) == 0
    return tmp_path / "class"


def rights(folder: Path, holder: str) -> dict[str, Rights]:
    found, mistakes = load_rights(folder / holder / "enclaves", 0)
    assert mistakes == []
    return found


def may_drive(folder: Path, holder: str = "robot") -> list[str]:
    return [name for name, each in rights(folder, holder).items() if each.allows("publish", "/cmd_vel")]


def test_everybody_hears_stop_and_who_drives_may_press_it(folder: Path) -> None:
    assert main(["security", "class", str(folder), "--turn", "2"]) == 0
    found = rights(folder, "robot")
    assert all(each.allows("subscribe", "/e_stop") for each in found.values())
    assert [name for name, each in found.items() if each.allows("publish", "/e_stop")] == may_drive(folder)


def test_each_folder_has_one_key_and_the_rights_of_all(folder: Path) -> None:
    assert {each.name for each in folder.iterdir()} == {
        *("keys", "robot", "router", "student1", "student2", "student3", "teacher"),
    }
    for holder in ("robot", "student1", "student3", "router"):
        keys = [each.relative_to(folder / holder).as_posix() for each in (folder / holder).rglob("*key.pem")]
        assert keys == [f"enclaves/{holder}/key.pem"]
        assert len(rights(folder, holder)) == 6
        assert not (folder / holder / "private").exists()
        assert f"ROS_SECURITY_ENCLAVE_OVERRIDE=/{holder}\n" in (folder / holder / "security.env").read_text("utf-8")


def test_a_handed_out_folder_opens_sessions(folder: Path) -> None:
    environ = {"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_KEYSTORE": str(folder / "student1")}
    found = session.requested(environ, 0, "/student1")
    assert found is not None
    assert session.settings(found)["transport/link/tls"]["enable_mtls"] is True


def test_a_student_sees_the_robot_and_has_its_own_namespace(folder: Path) -> None:
    own = rights(folder, "robot")["/student1"]
    for kind, name in (
        ("subscribe", "/scan"),
        ("publish", "/student1/x"),
        ("reply", "/_robolink_cli_7/get_type_description"),
    ):
        assert own.allows(kind, name)
    for kind, name in (
        *(("publish", "/scan"), ("publish", "/student2/x"), ("publish", "/student10/x"), ("subscribe", "/student2/x")),
        *(("request", "/robot/set_parameters"), ("reply", "/robot/get_parameters"), ("publish", "/cmd_vel")),
    ):
        assert not own.allows(kind, name)
    assert own.allows("request", "/robot/get_parameters")


def test_one_student_at_a_time_drives(folder: Path) -> None:
    others = ["/robot", "/router", "/teacher"]
    assert may_drive(folder) == others
    assert main(["security", "class", str(folder), "--turn", "2"]) == 0
    assert may_drive(folder) == may_drive(folder, "student1") == ["/robot", "/router", "/student2", "/teacher"]
    assert main(["security", "class", str(folder), "--turn", "3"]) == 0
    assert may_drive(folder) == ["/robot", "/router", "/student3", "/teacher"]
    assert main(["security", "class", str(folder), "--turn", "none"]) == 0
    assert may_drive(folder) == others


@pytest.mark.slow
def test_a_class_keeps_its_domain(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "class"
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    assert main(["security", "class", str(folder), "--students", "2"]) == 0
    assert capsys.readouterr().err == ""
    for domain, words, lines in (("8", "--turn 2", 1), ("8", "--students 3 --turn 1", 1), ("", "--turn none", 0)):
        monkeypatch.setenv("ROS_DOMAIN_ID", domain)
        assert main(["security", "class", str(folder), *words.split()]) == 0
        told = capsys.readouterr().err
        assert told.count("keeps its domain, 7; ROS_DOMAIN_ID is 8") == told.count("\n") == lines
        found, _ = load_rights(folder / "robot" / "enclaves", 7)
        assert all(each.allowed for each in found.values())
        assert "ROS_DOMAIN_ID=7\n" in (folder / "robot" / "security.env").read_text("utf-8")


@pytest.mark.slow
def test_no_turn_and_no_new_student_brings_back_who_was_withdrawn(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = Keystore(folder / "keys")
    store.create_enclave("/camera")
    store.permit("/camera", [Rule("publish", True, "/image")])
    store.withdraw("/student2")
    for words in ("--turn 3", "--students 4", "--turn none"):
        assert main(["security", "class", str(folder), *words.split()]) == 0
        assert rights(folder, "robot")["/student2"].is_withdrawn
        assert rights(folder, "robot")["/camera"].allows("publish", "/image")
    assert main(["security", "class", str(folder), "--turn", "2"]) == 1
    assert "'/student2' has been withdrawn: 'robolink security create_permission'" in capsys.readouterr().err


@pytest.mark.slow
def test_a_second_time_adds_students_and_keeps_keys(folder: Path) -> None:
    before = (folder / "student1" / "enclaves" / "student1" / "key.pem").read_bytes()
    assert main(["security", "class", str(folder), "--students", "4"]) == 0
    assert (folder / "student1" / "enclaves" / "student1" / "key.pem").read_bytes() == before
    assert len(rights(folder, "student1")) == 7
    assert Keystore(folder / "keys").names()[-2] == "/student4"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("--students 0 --turn 9", "no student '9'"),
        ("--students 1000", "a class has 1 to 200 students, got 1000"),
        ("--turn 1 --drive cmd_vel", "'cmd_vel': a name is /a/b"),
    ],
)
def test_mistakes_are_one_line(folder: Path, words: str, told: str, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["security", "class", str(folder), *words.split()]) == 1
    err = capsys.readouterr().err
    assert told in err
    assert err.count("\n") == 1
