"""Names find nodes, launch files and worlds, the user's before those that come with robolink; files are loaded."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink import Node
from robolink.exceptions import NotFoundError
from robolink.workspace import (
    VARIABLE,
    NodeLoadError,
    built_in_workspace,
    find_launch,
    find_node,
    find_world,
    list_launches,
    list_nodes,
    list_worlds,
    load_module,
    load_node,
    own_process_needed,
    user_workspace,
    workspace_of,
)

NODE = """
from robolink import Node

class Talker(Node):
    def __init__(self) -> None:
        super().__init__("talker")
"""


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A workspace of the user's, with the working directory somewhere below it."""
    for folder in ("nodes", "configs/worlds", "src/deep"):
        (tmp_path / folder).mkdir(parents=True)
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path / "src/deep")
    before = list(sys.path)
    yield tmp_path.resolve()
    sys.path[:] = before


@pytest.fixture
def write(home: Path) -> Callable[[str, str], Path]:
    def write(name: str, text: str = NODE) -> Path:
        path = home / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    return write


Write = Callable[..., Path]


def test_a_users_node_is_found_from_below_its_workspace(write: Write) -> None:
    path = write("nodes/line_follower.py")
    assert find_node("line_follower").path == path
    assert find_node("line-follower").path == path
    assert find_node("line_follower.py").path == path
    assert find_node("nodes/line_follower.py").path == path
    assert find_node("../../nodes/line_follower.py").path == path
    assert find_node(str(path)).spec == str(path)
    assert find_node("line_follower:main").spec == f"{path}:main"
    assert find_node(f"{path}:main").attribute == "main"


@pytest.mark.parametrize(("other", "is_one"), [("configs", True), ("interfaces", True), ("src", False)])
def test_what_makes_a_folder_a_workspace(tmp_path: Path, other: str, is_one: bool) -> None:
    for part in ("nodes", f"{other}/deep"):
        (tmp_path / part).mkdir(parents=True)
    assert workspace_of(tmp_path / other / "deep") == (tmp_path if is_one else None)


def test_a_users_file_shadows_a_built_in_one(write: Write, home: Path) -> None:
    assert find_node("wall_follower").path == built_in_workspace() / "nodes/wall_follower.py"
    ours = write("nodes/wall-follower.py")
    assert find_node("wall_follower").path == ours
    assert [each.path for each in list_nodes() if "wall" in each.name] == [ours]
    world = write("configs/worlds/empty-room.yml", "")
    assert find_world("empty_room") == find_world("empty_room.yaml") == world
    assert [each for each in list_worlds() if "empty" in each.name] == [world]
    assert find_world("corners") == built_in_workspace() / "configs/worlds/corners.yaml"


def test_everything_is_listed_but_private_files(write: Write) -> None:
    write("nodes/mine.py")
    write("nodes/_shared.py")
    write("configs/lap.yaml", "nodes: []")
    names = [each.name for each in list_nodes()]
    assert {"mine", "world", "teleop"} <= set(names)
    assert "_shared" not in names
    assert names == sorted(names)
    assert "lap" in [each.stem for each in list_launches()]


@pytest.mark.skipif(sys.platform == "win32", reason="Windows keeps a folder that is a working directory")
def test_a_working_directory_that_is_gone_is_no_workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "gone").mkdir()
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    try:
        assert user_workspace() is None
        assert find_node("world").path == built_in_workspace() / "nodes/world.py"
    finally:
        os.chdir(tmp_path)


def test_a_workspace_can_be_asked_for(
    write: Write, home: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write("nodes/mine.py")
    monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
    with pytest.raises(NotFoundError):
        find_node("mine")
    assert find_node("mine", workspace=home).path == path
    monkeypatch.setenv(VARIABLE, str(home))
    assert find_node("mine").path == path
    with pytest.raises(NotFoundError, match="no workspace folder named '/no/such/place'"):
        find_node("mine", workspace="/no/such/place")


@pytest.mark.parametrize(
    ("name", "report"),
    [
        ("minee", "no node named 'minee' in {home} or robolink itself (did you mean 'mine'?)"),
        ("wander_around_in_a_circle", "no node named 'wander_around_in_a_circle' in {home} or robolink itself"),
        ("../nodes/mine.py", "no file named '../nodes/mine.py'"),
        ("../../nodes/min.py", "no file named '../../nodes/min.py' (did you mean '../../nodes/mine.py'?)"),
        ("min.py", "no node named 'min.py' in {home} or robolink itself (did you mean 'mine'?)"),
        ("talker", "no node named 'talker' in {home} or robolink itself (did you mean 'talker.py'?)"),
        ("at", "no node named 'at' in {home} or robolink itself (did you mean 'at.py'?)"),
        ("", "no node named '' in {home} or robolink itself"),
    ],
)
def test_an_unknown_node_is_reported_with_the_nearest(name: str, report: str, write: Write, home: Path) -> None:
    write("nodes/mine.py")
    write("talker.py")
    write("at.py")
    with pytest.raises(NotFoundError) as caught:
        find_node(name)
    assert str(caught.value) == report.format(home=home)


def test_unknown_launch_files_and_worlds_too(write: Write) -> None:
    write("configs/two_laps.yaml")
    with pytest.raises(NotFoundError, match=r"no launch file named 'to_laps'.*did you mean 'two_laps'"):
        find_launch("to_laps")
    with pytest.raises(NotFoundError, match=r"no world named 'corner'.*did you mean 'corners'"):
        find_world("corner")
    write("meu_mundo.wbt")
    for name in ("meu_mundo", "meu_mundo.wb"):
        with pytest.raises(NotFoundError, match=r"did you mean 'meu_mundo\.wbt'"):
            find_world(name)


@pytest.mark.parametrize("name", ["careful", "carefull", "carefull.py"])
def test_a_file_in_the_working_directory_is_near_too(name: str, write: Write) -> None:
    write("careful.py")
    with pytest.raises(NotFoundError, match=r"did you mean 'careful\.py'"):
        find_node(name)


# --- loading --------------------------------------------------------------------------------------------------


def loaded(path: Path, attribute: str = "") -> Any:
    return load_node(find_node(f"{path}:{attribute}" if attribute else str(path)))


def test_the_only_node_class_of_a_file_is_its_node(write: Write) -> None:
    path = write("a.py")
    found = loaded(path)
    assert issubclass(found, Node)
    assert found.__module__ == str(path)
    assert loaded(path) is found


def test_a_class_that_only_serves_as_a_base_does_not_count(write: Write) -> None:
    path = write("a.py", NODE + "class Loud(Talker): pass\nclass Helper: pass\n")
    assert loaded(path).__name__ == "Loud"
    assert loaded(path, "Talker").__name__ == "Talker"


def test_main_goes_before_classes(write: Write) -> None:
    path = write("a.py", NODE + "class Other(Node): pass\ndef main(args=None): return 7\n")
    assert loaded(path)() == 7


def test_a_script_is_run_as_python_does(write: Write, capsys: pytest.CaptureFixture[str]) -> None:
    write("neighbour.py", "word = 'hello'")
    guarded = write("a.py", NODE + "import neighbour\nif __name__ == '__main__': print(neighbour.word, __file__)")
    loaded(guarded)()
    assert capsys.readouterr().out == f"hello {guarded}\n"
    plain = write("b.py", "import neighbour\nprint(neighbour.word, __name__)")
    run = loaded(plain)
    assert capsys.readouterr().out == ""
    run()
    assert capsys.readouterr().out == "hello __main__\n"


@pytest.mark.parametrize(
    "text",
    [
        NODE + "import robolink\ndef go(): print('ran')\ngo()\n",
        NODE + "def main(): print('ran')\nmain()\n",
        NODE + "async def go(): print('ran')\nimport asyncio\nasyncio.run(go())\n",
        NODE + "from types import SimpleNamespace\nrclpy = SimpleNamespace(init=print)\nrclpy.init('ran')\n",
        NODE + "import contextlib\ndef init(): return contextlib.nullcontext()\nwith init():\n    print('ran')\n",
        NODE + "def main(): pass\nfor each in range(1):\n    create_node = print\n    create_node('ran')\n",
    ],
)
def test_a_script_that_acts_as_it_is_read_is_run_once(
    text: str, write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    run = loaded(write("a.py", text))
    assert capsys.readouterr().out == ""
    run()
    assert capsys.readouterr().out == "ran\n"


@pytest.mark.parametrize(
    "bases",
    ["", "(object)", "(Exception)", "(dict[str, int])", "(Enum)", "(enum.Enum)", "(NamedTuple)", "(Path)"],
)
def test_a_plain_script_with_a_class_is_run_as_python_runs_it(
    bases: str, write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    imports = "import enum\nfrom enum import Enum\nfrom pathlib import Path\nfrom typing import NamedTuple\n"
    run = loaded(write("a.py", f"{imports}class A{bases}: pass\nclass B(A): pass\nb = str(A)\nprint(__name__)\n"))
    assert capsys.readouterr().out == ""
    run()
    assert capsys.readouterr().out == "__main__\n"


def test_a_script_whose_class_could_have_been_a_node_has_run_to_its_end(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    text = "import msgspec\nclass A(msgspec.Struct): pass\nprint('ran')\n"
    assert loaded(write("a.py", text))() is None
    assert capsys.readouterr().out == "ran\n"


def test_what_a_file_only_prepares_makes_it_no_script(write: Write) -> None:
    text = "import logging\ndef made(): return 3\nlogging.getLogger('x').setLevel(30)\nCOUNT = made()\n"
    assert issubclass(loaded(write("a.py", NODE + text)), Node)


def test_structs_of_a_node_file_know_their_annotations(write: Write) -> None:
    path = write(
        "a.py",
        "from __future__ import annotations\nimport msgspec\n"
        "class A(msgspec.Struct):\n    b: B\nclass B(msgspec.Struct):\n    x: int = 0\n",
    )
    import msgspec

    module = load_module(path)
    assert msgspec.convert({"b": {"x": 3}}, module.A).b.x == 3


@pytest.mark.parametrize(
    ("text", "report"),
    [
        ("def x(:\n", r":1:\d+: invalid syntax"),
        ("x = 1\n  y = 2\n", r":2:\d+: unexpected indent"),
        ("x = '\0'", r".* source code .*null bytes"),
        ("x = " + "(" * 1000, r":.*"),
        (NODE + "class Other(Node): pass", r" holds 2 nodes: say which, a\.py:Talker or a\.py:Other"),
        ("", r" holds no program: is it saved\?"),
        ("# all of it is a comment", r" holds no program: is it saved\?"),
        (
            NODE.partition("class ")[0] + "class A:\n pass",
            r" holds no node: the class A is none; write class A\(Node\):",
        ),
        ("class A: pass", r" holds no node: no Node class, no main\(\) and no `if __name__ == '__main__'`"),
    ],
)
def test_a_file_that_holds_no_node_is_one_line(text: str, report: str, write: Write) -> None:
    path = write("a.py", text)
    with pytest.raises(NodeLoadError) as caught:
        loaded(path)
    assert re.fullmatch(re.escape(str(path)) + report, str(caught.value))


@pytest.mark.parametrize(
    ("attribute", "report"),
    [
        ("Talkr", r"no class or function named 'Talkr' in .*a.py \(did you mean 'Talker'\?\)"),
        ("word", "a.py:word is neither a Node class nor a function"),
        ("Helper", "a.py:Helper is a class, but no subclass of Node"),
    ],
)
def test_an_attribute_that_is_no_node_is_one_line(attribute: str, report: str, write: Write) -> None:
    path = write("a.py", NODE + "word = 'x'\nclass Helper: pass\n")
    with pytest.raises((NotFoundError, NodeLoadError), match=report):
        loaded(path, attribute)


def test_an_error_in_the_users_file_stays_as_it_is(write: Write) -> None:
    path = write("a.py", "class A: pass\nraise KeyError('mine')")
    for _ in range(2):
        with pytest.raises(KeyError, match="mine"):
            loaded(path)
    assert str(path) not in sys.modules


def test_who_runs_itself_is_named_by_its_node_classes(write: Callable[[str, str], Path]) -> None:
    path = write(
        "nodes/robot.py",
        """
import rclpy.node
from robolink.lifecycle import LifecycleNode

class Pose(tuple): ...
class Limits: ...
class Base(rclpy.node.Node): ...
class Robot(Base): ...
class Arm(LifecycleNode): ...

def main(): ...
""",
    )
    reason = own_process_needed(find_node(str(path)))
    assert reason.endswith("name its class, robot.py:Robot or robot.py:Arm, or leave `process` out")
    path.write_text("class Pose: ...\n\ndef main(): ...\n")
    assert own_process_needed(find_node(str(path))).endswith("a process of its own: leave `process` out")
