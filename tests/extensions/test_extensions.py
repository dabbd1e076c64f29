"""Extensions: commands, verbs and nodes of other packages are found by entry points, and their faults are told."""

from __future__ import annotations

import math
import pickle
import re
import subprocess
import sys
import zipfile
from importlib import import_module
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.cli.shared.commands import COMMANDS
from robolink.companions.rosidl_runtime import get_interface_path
from robolink.exceptions import DocumentError
from robolink.extensions import ExtensionError
from robolink.interfaces import find
from robolink.interfaces.std_msgs.msg import Float64
from robolink.message import type_hash
from robolink.message.building import build
from robolink.message.definition import parse
from robolink.scaffold.stubs import write_stubs
from robolink.sim import load_world
from robolink.sim.schema import world_schema
from robolink.testing import System
from robolink.workspace import built_in_workspace, component, find_node, list_nodes, load_node, program, programs_of
from robolink.workspace.programs import PROGRAMS

CODE = """\
import typer
from robolink.node import Node

app = typer.Typer()
number = 7


@app.command()
def hello(name: str = "you") -> None:
    '''Greet somebody.'''
    print("hello", name)


def nodes(topic: str) -> None:
    '''List who uses a topic.'''
    print("nodes of", topic)


class Shop(Node):
    def __init__(self) -> None:
        super().__init__("shop")


def drive() -> None:
    print("driving")


def odd(thing: object) -> None:
    pass


weather = typer.Typer(help="Tell the weather.", no_args_is_help=True)


@weather.command("today")
def today() -> None:
    '''Tell today's.'''
    print("sunny")


@weather.command("tomorrow")
def tomorrow() -> None:
    '''Tell tomorrow's.'''
    raise typer.Exit(3)
"""
ENTRY_POINTS = """\
[robolink.commands]
hello = demo_extension:app
weather = demo_extension:weather
topic.nodes = demo_extension:nodes
topic.list = demo_extension:nodes
topic.odd = demo_extension:odd
broken = demo_extension:lacking
number = demo_extension:number
leaving = demo_leaving:app

[robolink.sensors]
compass = demo_compass:COMPASS
lost = demo_compass:LOST
other = demo_compass:COMPASS

[robolink.nodes]
shop-node = demo_extension:Shop
world = demo_extension:drive
gone = demo_gone

[robolink.interfaces]
demo_msgs = demo_types.demo_msgs
empty_msgs = demo_types
odd-msgs = demo_types.demo_msgs

[robolink.programs]
demo_robot.drive = demo_extension:drive
demo_robot::Driver = demo_extension:drive
demo_nodes_py.talker = demo_extension:drive
demo_robot.gone = demo_gone:main
nameless = demo_extension:drive
"""
TYPES = {
    "msg": {
        "Heading.msg": "# Where a robot looks.\nuint8 NORTH = 0\nfloat64 degrees 90.0\n",
        "Headings.msg": "std_msgs/Header header\nHeading[] headings\n",
        "Loop.msg": "Round round\n",
        "Round.msg": "Loop loop\n",
    },
    "srv": {"Turn.srv": "Heading heading\n---\nbool success\n"},
}

COMPASS = """\
import math
from msgspec import Struct
from robolink.interfaces.std_msgs.msg import Float64
from robolink.sim.quantities import Rate
from robolink.sim.sensors import Sensor, SensorKind


class Compass(Sensor, Struct, frozen=True, forbid_unknown_fields=True):
    compass: str
    rate: Rate = 10.0


class CompassDevice:
    def __init__(self, description, carrier):
        self.description, self._carrier = description, carrier

    def measure(self):
        return self._carrier.pose(self.description).theta


def message(value, header, description):
    return Float64(data=math.degrees(value))


class Lost(Sensor, Struct, frozen=True, forbid_unknown_fields=True):
    lost: str
    rate: Rate = 10.0


COMPASS = SensorKind(Compass, CompassDevice, Float64, message)
LOST = SensorKind(Lost, "demo_lost:Device", Float64, message)
"""


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An installed package that adds commands."""
    info = tmp_path / "demo_extension-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: demo-extension\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRY_POINTS)
    (tmp_path / "demo_extension.py").write_text(CODE)
    (tmp_path / "demo_leaving.py").write_text("raise SystemExit('I \\x1b[2J leave')\n")
    (tmp_path / "demo_compass.py").write_text(COMPASS)
    types = tmp_path / "demo_types/demo_msgs"
    for kind, files in TYPES.items():
        (types / kind).mkdir(parents=True)
        for name, text in files.items():
            (types / kind / name).write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    for each in ("demo_extension", "demo_compass"):
        monkeypatch.delitem(sys.modules, each, raising=False)
    return tmp_path


@pytest.mark.usefixtures("package")
@pytest.mark.parametrize(
    ("words", "output"),
    [
        (["hello"], "hello you\n"),
        (["hello", "--name", "Ada"], "hello Ada\n"),
        (["topic", "nodes", "/scan"], "nodes of /scan\n"),
        (["weather", "today"], "sunny\n"),
    ],
)
def test_commands_of_other_packages_run(words: list[str], output: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 0
    assert capsys.readouterr().out == output


@pytest.mark.usefixtures("package")
def test_their_exit_codes_are_handed_on() -> None:
    assert main(["weather", "tomorrow"]) == 3


@pytest.mark.usefixtures("package")
def test_help_lists_them_with_those_that_cannot_be_loaded(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    _, _, listed = capsys.readouterr().out.partition("Commands of other packages:\n")
    assert [line.split()[0] for line in listed.splitlines() if line[2:3].strip()] == [
        "broken", "hello", "leaving", "number", "weather"
    ]  # fmt: skip
    assert "Greet somebody." in listed
    assert r"SystemExit: I \x1b[2J leave" in " ".join(listed.split())
    assert main(["topic", "--help"]) == 0
    listed = capsys.readouterr().out
    assert re.search(r"nodes +List who uses a topic\.", listed)
    assert re.search(r"odd +demo-extension adds 'topic\.odd'", listed)


@pytest.mark.usefixtures("package")
@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (
            ["broken"],
            "demo-extension adds 'broken' (robolink.commands), which cannot be loaded from demo_extension:lacking",
        ),
        (
            ["number"],
            "demo-extension adds 'number' (robolink.commands), which cannot be loaded from demo_extension:number: a ",
        ),
        (
            ["topic", "odd", "--word", "x"],
            "demo-extension adds 'topic.odd' (robolink.commands), which cannot be loaded from demo_extension:odd: Run",
        ),
        (
            ["leaving"],
            "demo-extension adds 'leaving' (robolink.commands), which cannot be loaded from demo_leaving:app: System",
        ),
        (["helo"], "no command named 'helo' (did you mean 'hello'?)"),
        (["topic", "nodez"], "no command named 'topic nodez' (did you mean 'nodes'?)"),
    ],
)
def test_faults_are_one_line(words: list[str], reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) != 0
    told = capsys.readouterr().err
    assert told.startswith(f"robolink: {reason}")
    assert told.count("\n") == 1


@pytest.mark.usefixtures("package")
def test_a_command_of_robolinks_own_goes_first(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["topic", "list", "--help"]) == 0
    assert "List the topics that have publishers or subscriptions." in capsys.readouterr().out


@pytest.mark.usefixtures("package")
def test_a_sensor_of_another_package_measures_in_a_world(system: System, tmp_path: Path) -> None:
    world = tmp_path / "world.yaml"
    world.write_text("robots: [{name: ada, pose: [1, 1, 0.5], sensors: [{compass: heading, rate: 5}]}]\n")
    system.start("world", parameters={"world": str(world)})
    heard: list[float] = []
    system.node.create_subscription(Float64, "/heading", lambda message: heard.append(message.data), 10)
    system.run(1.0)
    assert heard == pytest.approx([math.degrees(0.5)] * 5)
    assert "Compass" in world_schema()["definitions"]


@pytest.mark.usefixtures("package")
def test_a_misspelt_sensor_is_answered_with_those_of_other_packages(tmp_path: Path) -> None:
    world = tmp_path / "world.yaml"
    world.write_text("robots: [{name: ada, sensors: [{compas: heading}]}]\n")
    with pytest.raises(DocumentError, match=r"did you mean 'compass'\?.*one of its keys must be lidar.*, compass"):
        load_world(str(world))


@pytest.mark.usefixtures("package")
@pytest.mark.parametrize(
    ("sensor", "reason"),
    [
        ("lost", "the sensor 'lost' cannot load its device from demo_lost:Device: ModuleNotFoundError: No module"),
        ("other", "cannot be loaded from demo_compass:COMPASS: the first field of Compass must be 'other'"),
    ],
)
def test_a_broken_sensor_is_one_line(
    sensor: str, reason: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world = tmp_path / "world.yaml"
    world.write_text(f"robots: [{{name: ada, pose: [1, 1, 0], sensors: [{{{sensor}: heading}}]}}]\n")
    assert main(["run", "world", "-p", f"world:={world}"]) != 0
    told = capsys.readouterr().err
    assert reason in told
    assert told.count("\n") == 1


@pytest.mark.usefixtures("package")
def test_programs_of_other_packages_run(capsys: pytest.CaptureFixture[str]) -> None:
    assert programs_of("demo_robot") == ["drive", "gone"]
    assert main(["run", "demo_robot", "drive"]) == 0
    assert capsys.readouterr().out == "driving\n"
    driver, talker = component("demo_robot::Driver"), program("demo_nodes_py", "talker")
    assert driver is not None
    assert talker is not None
    assert (driver.module, driver.attribute) == ("demo_extension", "drive")
    assert talker.attribute == "Talker"  # robolink's own goes first


@pytest.mark.usefixtures("package")
def test_a_program_that_is_not_there_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "demo_robot", "gone"]) != 0
    place = "demo-extension adds 'demo_robot.gone' (robolink.programs), which cannot be loaded from demo_gone:main"
    assert capsys.readouterr().err == f"robolink: {place}: no module named 'demo_gone'\n"
    assert main(["pkg", "executables"]) == 0  # no other command is broken by it
    listed = capsys.readouterr().out
    assert "demo_robot drive\n" in listed
    assert "gone" not in listed


@pytest.mark.usefixtures("package")
def test_nodes_of_other_packages_are_found_after_robolinks_own() -> None:
    assert "shop-node" in [each.name for each in list_nodes()]
    source = find_node("shop_node")
    assert (source.module, source.attribute) == ("demo_extension", "Shop")
    assert load_node(find_node(source.spec)).__name__ == "Shop"
    assert find_node("world").path == built_in_workspace() / "nodes/world.py"
    with pytest.raises(ExtensionError, match=r"'gone' \(robolink\.nodes\).* no module named 'demo_gone'"):
        find_node("gone")


@pytest.mark.usefixtures("package")
def test_types_of_other_packages_are_as_robolinks_own(capsys: pytest.CaptureFixture[str]) -> None:
    heading, turn = find("demo_msgs/msg/Heading"), find("Turn", "srv")
    assert heading is import_module("robolink.interfaces.demo_msgs.msg").Heading
    assert heading is import_module("demo_msgs.msg").Heading is import_module("demo_msgs.msg._heading").Heading
    assert (heading().degrees, heading.NORTH, heading.DEGREES__DEFAULT) == (90.0, 0, 90.0)
    assert pickle.loads(pickle.dumps(heading(degrees=1.0))) == heading(degrees=1.0)
    assert turn.Request().heading == heading()
    assert find("Headings")(headings=[heading()]).headings[0].degrees == 90.0
    assert type_hash(heading) == type_hash(build(parse(TYPES["msg"]["Heading.msg"], "demo_msgs/msg/Heading"), find))
    assert main(["interface", "package", "demo_msgs"]) == 0
    assert capsys.readouterr().out.splitlines()[:2] == ["demo_msgs/msg/Heading", "demo_msgs/msg/Headings"]
    assert main(["interface", "show", "demo_msgs/msg/Heading"]) == 0
    assert "float64 degrees 90.0" in capsys.readouterr().out
    assert get_interface_path("demo_msgs/msg/Heading").endswith("demo_types/demo_msgs/msg/Heading.msg")


@pytest.mark.usefixtures("package")
def test_types_that_are_wrong_are_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["interface", "show", "demo_msgs/msg/Loop"]) == 1
    assert "a message cannot contain itself" in capsys.readouterr().err
    assert main(["interface", "show", "empty_msgs/msg/Any"]) == 1
    place = "demo-extension adds 'empty_msgs' (robolink.interfaces), which cannot be loaded from demo_types: "
    assert capsys.readouterr().err.startswith(f"robolink: {place}")
    assert main(["interface", "packages"]) == 0
    assert "demo_msgs\n" in capsys.readouterr().out
    assert main(["interface", "list"]) == 0  # no type of a package whose name no program could import
    listed = capsys.readouterr().out
    assert "demo_msgs/msg/Heading\n" in listed
    assert "odd-msgs" not in listed


@pytest.mark.usefixtures("package")
def test_stubs_have_types_of_other_packages(tmp_path: Path) -> None:
    (tmp_path / "home").mkdir()
    write_stubs(tmp_path / "home")
    assert "class Heading(" in (tmp_path / "home/typings/demo_msgs/msg.pyi").read_text()


@pytest.mark.usefixtures("package")
def test_problems_name_what_is_broken_and_what_is_there_twice() -> None:
    found = list(PROGRAMS.problems())
    assert found[1].endswith("from demo_gone:main: no module named 'demo_gone'")
    assert found[2].endswith("a program's name is PACKAGE.EXECUTABLE, or PACKAGE::CLASS for a component")
    assert found[0] == (
        "demo-extension adds 'demo_nodes_py.talker' (robolink.programs), which robolink has: that one is taken"
    )


@pytest.mark.usefixtures("package")
def test_a_verb_that_robolink_has_is_a_problem() -> None:
    taken = "demo-extension adds 'topic.list' (robolink.commands), which robolink has: that one is taken"
    assert [each for each in COMMANDS.problems() if "'topic.nodes'" in each or "'topic.list'" in each] == [taken]


def test_entry_points_are_those_of_the_path_of_now(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "hello" in COMMANDS.added()
    monkeypatch.setattr(sys, "path", [each for each in sys.path if each != str(package)])
    assert "hello" not in COMMANDS.added()
    assert COMMANDS.get("hello") is None


@pytest.mark.usefixtures("package")
def test_what_cannot_be_loaded_is_an_import_error() -> None:
    with pytest.raises(ExtensionError, match="AttributeError") as caught:
        COMMANDS.get("broken")
    assert isinstance(caught.value, ImportError)


@pytest.mark.processes
def test_a_known_command_reads_no_entry_points(package: Path) -> None:
    program = (
        "import sys\nfrom robolink.cli.main import main\nmain(['topic', 'list', '--help'])\n"
        "assert 'importlib.metadata' not in sys.modules, 'read'"
    )
    subprocess.run([sys.executable, "-c", program], check=True, env={"PYTHONPATH": str(package)}, capture_output=True)


@pytest.mark.processes
def test_help_reads_no_entry_points_where_nobody_adds_a_command() -> None:
    program = (
        "import sys\nfrom robolink.cli.main import main\nmain(['--help'])\n"
        "assert 'importlib.metadata' not in sys.modules, 'read'"
    )
    subprocess.run([sys.executable, "-c", program], check=True, env={}, capture_output=True)


def test_what_is_not_a_folder_may_add_something(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A zip file with a package, for instance, which `importlib.metadata` reads too."""
    with zipfile.ZipFile(tmp_path / "demo.zip", "w") as packed:
        packed.writestr("zipped-1.0.dist-info/METADATA", "Metadata-Version: 2.1\nName: zipped\nVersion: 1.0\n")
        packed.writestr("zipped-1.0.dist-info/entry_points.txt", "[robolink.commands]\nzipped = zipped:app\n")
    monkeypatch.syspath_prepend(tmp_path / "demo.zip")
    assert "zipped" in COMMANDS.added()
