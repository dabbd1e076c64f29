"""A workspace's .msg, .srv and .action files are types like any other: found by name, and imported in nodes."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robolink import interfaces
from robolink.exceptions import DefinitionError, MessageError, NotFoundError
from robolink.interfaces import find, names
from robolink.interfaces.geometry_msgs.msg import Point, Pose, Vector3
from robolink.message import Action, Service, decode, encode, type_hash
from robolink.message.text import text_of
from robolink.workspace import VARIABLE, InterfaceImportError, load_module, load_node, use_interfaces
from robolink.workspace import find_node as find_node_file
from robolink.workspace.interfaces import DEEPEST, WORKSPACE_TYPES, WorkspaceTypes
from robolink.workspace.modules import FINDER
from tests.support.zoo import Write, imported


@pytest.mark.usefixtures("zoo")
def test_types_are_importable() -> None:
    use_interfaces()
    message, service, action = (imported(f"zoo_msgs.{kind}") for kind in ("msg", "srv", "action"))
    animal = message.Animal(place=Point(x=2.0))
    assert (animal.name, animal.BIRD, animal.place.x) == ("Ada", 1, 2.0)
    cage = message.Cage(animals=[animal], open=True)
    assert decode(message.Cage, encode(cage)) == cage
    assert issubclass(service.Feed, Service)
    assert service.Feed.Request().animal == message.Animal()
    assert issubclass(action.Catch, Action)
    assert action.Catch.Result(caught=[animal]).caught[0] is animal


@pytest.mark.usefixtures("zoo")
def test_a_module_lists_its_types_and_makes_each_once() -> None:
    use_interfaces()
    module = imported("zoo_msgs.msg")
    assert module.__all__ == ["Animal", "Cage"]
    assert {"Animal", "Cage"} <= set(dir(module))
    assert "Animal" not in vars(module)
    assert module.Animal is module.Animal is find("zoo_msgs/msg/Animal")
    assert module.Animal.__module__ == "zoo_msgs.msg"
    scope: dict[str, Any] = {}
    exec("from zoo_msgs.msg import *", scope)
    assert scope["Cage"] is module.Cage


@pytest.mark.usefixtures("zoo")
def test_a_name_that_a_module_has_not_is_an_ordinary_import_error(home: Path) -> None:
    use_interfaces()
    module = imported("zoo_msgs.msg")
    assert not hasattr(module, "Animl")
    with pytest.raises(AttributeError, match="did you mean 'Animal'"):
        _ = module.Animl
    with pytest.raises(ImportError, match="Animl") as caught:
        exec("from zoo_msgs.msg import Animl", {})
    assert str(home / "interfaces/zoo_msgs/msg") in str(caught.value)
    with pytest.raises(ModuleNotFoundError):
        imported("zoo_msgs.idl")
    with pytest.raises(ModuleNotFoundError):
        imported("zoo_msgs.msg.Animal")


@pytest.mark.usefixtures("zoo")
@pytest.mark.parametrize("name", ["Animal", "zoo_msgs/Animal", "zoo_msgs/msg/Animal", "zoo_msgs.msg.Animal"])
def test_types_are_found_by_name(name: str) -> None:
    with pytest.raises(NotFoundError):
        find(name)
    interfaces.add_source(WORKSPACE_TYPES)
    assert find(name).__ros_type__ == "zoo_msgs/msg/Animal"
    assert "zoo_msgs/msg/Animal" in names()
    assert ("zoo_msgs/srv/Feed" in names("srv"), "zoo_msgs/action/Catch" in names("action")) == (True, True)
    with pytest.raises(NotFoundError, match=r"named 'Animals' in zoo_msgs .did you mean 'Animal'"):
        find("zoo_msgs/Animals")
    with pytest.raises(NotFoundError, match="no service type named 'Animal' in zoo_msgs"):
        find("zoo_msgs/Animal", "srv")
    interfaces.remove_source(WORKSPACE_TYPES)
    with pytest.raises(NotFoundError):
        find(name)


def test_finding_and_listing_reads_no_file(write: Write, monkeypatch: pytest.MonkeyPatch) -> None:
    write("zoo_msgs/msg/Animal.msg", "not a line of a message file at all")
    interfaces.add_source(WORKSPACE_TYPES)

    def refuse(self: Path, *_: Any, **__: Any) -> str:
        raise AssertionError(f"{self} was read")

    monkeypatch.setattr(Path, "read_text", refuse)
    assert find("Twist").__ros_type__ == "geometry_msgs/msg/Twist"
    assert "zoo_msgs/msg/Animal" in names()


def test_a_standard_package_is_added_to(write: Write) -> None:
    write("geometry_msgs/msg/Circle.msg", "Point centre\nfloat64 radius\n")
    use_interfaces()
    module = imported("geometry_msgs.msg")
    assert module.Pose is Pose
    assert isinstance(module.Circle().centre, Point)
    assert find("geometry_msgs/msg/Circle") is module.Circle
    assert "geometry_msgs/msg/Twist" in names()


def test_the_workspaces_version_of_a_standard_type_wins_and_a_copy_changes_nothing(write: Write) -> None:
    write("geometry_msgs/msg/Point.msg", "float64 x\nfloat64 y\n")
    write("geometry_msgs/msg/Vector3.msg", "float64 x\nfloat64 y\nfloat64 z # the very same\n")
    interfaces.add_source(WORKSPACE_TYPES)
    flat: Any = find("Point")
    assert flat.get_fields_and_field_types() == {"x": "double", "y": "double"}
    assert type_hash(flat) != type_hash(Point)
    assert find("Vector3") is Vector3
    assert find("Pose") is Pose


def test_what_is_no_name_is_no_type(write: Write) -> None:
    for name in (
        "zoo_msgs/msg/.Hidden.msg",
        "zoo_msgs/msg/Two words.msg",
        "zoo_msgs/msg/README.md",
        "zoo-msgs/msg/A.msg",
    ):
        write(name, "bool a")
    write("zoo_msgs/msg/Tiger.msg", "bool a")
    (Path("interfaces/zoo_msgs/msg/Folder.msg")).mkdir()
    interfaces.add_source(WORKSPACE_TYPES)
    assert [name for name in names() if "zoo" in name and "Folder" not in name] == ["zoo_msgs/msg/Tiger"]
    with pytest.raises(NotFoundError):  # also where file names have no case
        find("zoo_msgs/msg/tiger")
    with pytest.raises(DefinitionError, match=r"Folder.msg:1:1: cannot be read"):
        find("zoo_msgs/msg/Folder")


def test_a_circle_of_files_names_them(write: Write) -> None:
    a, b = write("zoo_msgs/msg/Cat.msg", "Dog foe"), write("zoo_msgs/msg/Dog.msg", "\nCat[] foes")
    use_interfaces()
    with pytest.raises(DefinitionError) as caught:
        find("zoo_msgs/Cat")
    assert str(caught.value).startswith(f"{b}:2:1: ")
    assert f"{a} -> {b} -> {a}" in str(caught.value)
    with pytest.raises(ImportError, match="cannot contain itself"):
        _ = imported("zoo_msgs.msg").Dog
    write("zoo_msgs/msg/Dog.msg", "bool barks")
    assert find("zoo_msgs/Cat")().foe.barks is False


@pytest.mark.parametrize(
    ("text", "place", "said"),
    [
        ("float speed", "1:1", "did you mean 'float32'"),
        ("# ok\nPoynt p", "2:1", "no message type named 'Poynt' in zoo_msgs"),
        ("geometry_msgs/Poynt p", "1:1", "did you mean 'Point'"),
        ("nowhere_msgs/Point p", "1:1", "no interface package named 'nowhere_msgs'"),
        ("bool a\nbool a", "2:6", "a second 'a'"),
    ],
)
def test_a_wrong_definition_is_an_error_with_its_place(write: Write, text: str, place: str, said: str) -> None:
    path = write("zoo_msgs/msg/Wrong.msg", text)
    use_interfaces()
    with pytest.raises(DefinitionError) as caught:
        find("zoo_msgs/Wrong")
    assert str(caught.value).startswith(f"{path}:{place}: ")
    assert said in str(caught.value)
    with pytest.raises(InterfaceImportError) as refused:
        exec("from zoo_msgs.msg import Wrong", {})
    assert str(refused.value) == str(caught.value)
    assert isinstance(refused.value, ImportError)


def test_what_is_no_text_is_refused(write: Write) -> None:
    path = write("zoo_msgs/msg/Wrong.msg", "")
    path.write_bytes(b"int32 age\nstring name # \xff\xfe")
    interfaces.add_source(WORKSPACE_TYPES)
    with pytest.raises(DefinitionError, match=r"Wrong\.msg:2:1: not UTF-8 text"):
        find("zoo_msgs/Wrong")


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_file_as_windows_writes_it_is_read(write: Write, encoding: str) -> None:
    write("zoo_msgs/msg/Marked.msg", "").write_bytes("int32 x  # é\n".encode(encoding))  # `echo > FILE` in PowerShell 5
    interfaces.add_source(WORKSPACE_TYPES)
    assert text_of(find("zoo_msgs/Marked")) == "int32 x  # é\n"


@pytest.mark.parametrize("kind", ["pipe", "endless"])
def test_what_never_ends_is_not_read(write: Write, kind: str) -> None:
    if sys.platform == "win32":
        pytest.skip("Windows has neither")
    path = write("zoo_msgs/msg/Odd.msg", "")
    path.unlink()
    if kind == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/dev/zero")
    interfaces.add_source(WORKSPACE_TYPES)
    with pytest.raises(DefinitionError, match=r"Odd\.msg:1:1: cannot be read: it is a (FIFO|device), and no file"):
        find("zoo_msgs/Odd")


def test_a_file_that_is_too_large_is_refused_unread(write: Write, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write("zoo_msgs/msg/Large.msg", "")
    with path.open("wb") as file:
        file.truncate(10**12)  # no byte of it is on the disk
    interfaces.add_source(WORKSPACE_TYPES)
    with pytest.raises(DefinitionError, match=r"Large\.msg:1:1: cannot be read: it is longer than 16 MB"):
        find("zoo_msgs/Large")


def test_messages_too_deep_within_each_other_are_refused(write: Write) -> None:
    for number in range(2 * DEEPEST):
        write(f"zoo_msgs/msg/M{number}.msg", f"M{number + 1} inner")
    write(f"zoo_msgs/msg/M{2 * DEEPEST}.msg", "bool a")
    interfaces.add_source(WORKSPACE_TYPES)
    with pytest.raises(DefinitionError, match="deep"):
        find("zoo_msgs/M0")
    assert find(f"zoo_msgs/M{2 * DEEPEST}")


@pytest.mark.slow
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.text("ABM[]<=3 #'.-\n/float64boolstringx_", max_size=30) | st.binary(max_size=40), max_size=3))
def test_any_files_make_types_or_errors_with_a_place(tmp_path: Path, files: list[str | bytes]) -> None:
    folder = tmp_path / "interfaces" / "zoo_msgs" / "msg"
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in zip("ABM", files, strict=False):
        (folder / f"{name}.msg").write_bytes(content.encode() if isinstance(content, str) else content)
    types = WorkspaceTypes()
    types.add(tmp_path)
    interfaces.add_source(types)
    try:
        for name in types.names("msg").get("zoo_msgs", []):
            assert makes_a_type(types, name) or refusal(types, name).startswith(str(folder))
    finally:
        interfaces.remove_source(types)


def makes_a_type(types: WorkspaceTypes, name: str) -> bool:
    try:
        found: Any = types.get("zoo_msgs", "msg", name)
    except MessageError:
        return False
    return bool(decode(found, encode(found())) == found())


def refusal(types: WorkspaceTypes, name: str) -> str:
    with pytest.raises(DefinitionError) as caught:
        types.get("zoo_msgs", "msg", name)
    return str(caught.value)


def test_a_node_file_finds_the_types_of_its_own_workspace(
    home: Path, write: Write, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    write("plain/msg/Flag.msg", "bool up")
    path = write("nodes/flagger.py", "from plain.msg import Flag\nimport plain.msg\nWHERE = plain.msg.Flag().up\n")
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    monkeypatch.chdir(elsewhere)
    module = load_module(path)
    assert module.WHERE is False
    assert find("plain/msg/Flag") is module.Flag


def test_a_script_finds_them_too(write: Write, capsys: pytest.CaptureFixture[str]) -> None:
    write("plain/srv/Wave.srv", "---\nbool waved")
    path = write("nodes/waver.py", "from plain.srv import Wave\nprint(Wave.Response())\n")
    run: Any = load_node(find_node_file(str(path)))
    run()
    assert capsys.readouterr().out == "plain.srv.Wave_Response(waved=False)\n"


def test_the_nearest_workspace_goes_before_others(
    home: Path, write: Write, tmp_path_factory: pytest.TempPathFactory
) -> None:
    write("plain/msg/Flag.msg", "bool here")
    other = tmp_path_factory.mktemp("other")
    (other / "interfaces/plain/msg").mkdir(parents=True)
    (other / "interfaces/plain/msg/Flag.msg").write_text("bool there")
    (other / "interfaces/plain/msg/Pole.msg").write_text("bool there")
    use_interfaces()
    assert find("plain/Flag")().here is False
    use_interfaces(other)
    assert find("plain/Flag")().there is False
    assert find("plain/Pole")().there is False


def test_a_workspace_that_is_gone_breaks_no_import(monkeypatch: pytest.MonkeyPatch, home: Path) -> None:
    use_interfaces()
    monkeypatch.setenv(VARIABLE, str(home / "gone"))
    assert FINDER.find_spec("numpy_is_not_ours", None) is None
    with pytest.raises(NotFoundError, match="no workspace folder"):
        find("zoo_msgs/Animal")
    with pytest.raises(NotFoundError, match="no workspace folder"):
        use_interfaces(home / "gone")
