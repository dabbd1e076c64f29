"""Command lines of ROS 2's beginner tutorials with turtlesim, with the output that these print, in this process.

Not compared: the services `get_type_description`, which ROS 2 has since Jazzy, and the comments of `interface show`.
Different: nodes in Python have no parameters `qos_overrides`, and the types' package is turtlesim, as until Kilted.
"""

from __future__ import annotations

import re
import shlex
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from robolink import Context
from robolink.cli.main import main
from robolink.cli.topic import meters, pub
from robolink.counterparts.turtlesim.turtle_teleop_key import TurtleTeleop
from robolink.counterparts.turtlesim.turtlesim_node import TurtleSim
from robolink.impl.log_output import Record
from robolink.interfaces.geometry_msgs.msg import Twist
from tests.support.seen_by_commands import a_context_that_commands_see, made, press_ctrl_c, spinning, when_said
from tests.support.systems import Typed
from tests.support.waits import wait_until

Captured = pytest.CaptureFixture[str]

SERVICES = """\
  Service Servers:
    /clear: std_srvs/srv/Empty
    /kill: turtlesim/srv/Kill
    /reset: std_srvs/srv/Empty
    /spawn: turtlesim/srv/Spawn
    /turtle1/set_pen: turtlesim/srv/SetPen
    /turtle1/teleport_absolute: turtlesim/srv/TeleportAbsolute
    /turtle1/teleport_relative: turtlesim/srv/TeleportRelative
    /turtlesim/describe_parameters: rcl_interfaces/srv/DescribeParameters
    /turtlesim/get_parameter_types: rcl_interfaces/srv/GetParameterTypes
    /turtlesim/get_parameters: rcl_interfaces/srv/GetParameters
    /turtlesim/list_parameters: rcl_interfaces/srv/ListParameters
    /turtlesim/set_parameters: rcl_interfaces/srv/SetParameters
    /turtlesim/set_parameters_atomically: rcl_interfaces/srv/SetParametersAtomically
  Service Clients:

"""
TURTLESIM = f"""\
/turtlesim
  Subscribers:
    /parameter_events: rcl_interfaces/msg/ParameterEvent
    /turtle1/cmd_vel: geometry_msgs/msg/Twist
  Publishers:
    /parameter_events: rcl_interfaces/msg/ParameterEvent
    /rosout: rcl_interfaces/msg/Log
    /turtle1/color_sensor: turtlesim/msg/Color
    /turtle1/pose: turtlesim/msg/Pose
{SERVICES}\
  Action Servers:
    /turtle1/rotate_absolute: turtlesim/action/RotateAbsolute
  Action Clients:

"""
TOPICS = """\
/parameter_events [rcl_interfaces/msg/ParameterEvent]
/rosout [rcl_interfaces/msg/Log]
/turtle1/cmd_vel [geometry_msgs/msg/Twist]
/turtle1/color_sensor [turtlesim/msg/Color]
/turtle1/pose [turtlesim/msg/Pose]
"""
SHOWN = {
    "geometry_msgs/msg/Twist": "".join(
        f"Vector3 {name}\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n" for name in ("linear", "angular")
    ),
    "std_srvs/srv/Empty": "---\n",
    "turtlesim/srv/Spawn": "float32 x\nfloat32 y\nfloat32 theta\nstring name\n---\nstring name\n",
    "turtlesim/action/RotateAbsolute": "float32 theta\n---\nfloat32 delta\n---\nfloat32 remaining\n",
}
DRIVE = "{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"
DRIVEN = (
    "publishing #1: geometry_msgs.msg.Twist(linear=geometry_msgs.msg.Vector3(x=2.0, y=0.0, z=0.0), "
    "angular=geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=1.8))\n\n"
)


class Desk(NamedTuple):
    """The terminals of somebody who follows a tutorial: turtlesim in one, turtle_teleop_key in another."""

    context: Context
    turtlesim: TurtleSim
    keyboard: Typed
    capsys: Captured

    def ros2(self, line: str, code: int = 0) -> str:
        """Type a command in the third terminal; return what it prints."""
        self.capsys.readouterr()
        assert main(shlex.split(line)[1:]) == code
        return self.capsys.readouterr().out

    @property
    def pose(self) -> tuple[float, float, float]:
        turtle = self.turtlesim.turtles["turtle1"].turtle
        return turtle.x, turtle.y, turtle.theta

    @contextmanager
    def typing(self, keys: str, when: Callable[[], Any]) -> Iterator[None]:
        """Type keys in the terminal of turtle_teleop_key as soon as something holds."""

        def type_then() -> None:
            wait_until(when)
            self.keyboard.text += keys

        thread = threading.Thread(target=type_then)
        thread.start()
        yield
        thread.join()


@pytest.fixture
def desk(monkeypatch: pytest.MonkeyPatch, capsys: Captured, tmp_path: Path) -> Iterator[Desk]:
    monkeypatch.chdir(tmp_path)
    keyboard = Typed()
    with ExitStack() as stack:
        context = stack.enter_context(a_context_that_commands_see(monkeypatch))
        turtlesim = TurtleSim(context=context)
        stack.enter_context(spinning(turtlesim, TurtleTeleop(keyboard, context=context)))
        yield Desk(context, turtlesim, keyboard, capsys)


def without_types(text: str) -> str:
    """Leave out what nodes have since Jazzy."""
    return re.sub(r".*get_type_description.*\n", "", text)


# Understanding nodes


def test_nodes(desk: Desk) -> None:
    assert desk.ros2("ros2 node list") == "/teleop_turtle\n/turtlesim\n"
    assert without_types(desk.ros2("ros2 node info /turtlesim")) == TURTLESIM
    teleop = desk.ros2("ros2 node info /teleop_turtle")
    assert "    /turtle1/cmd_vel: geometry_msgs/msg/Twist\n" in teleop.partition("Publishers:")[2]
    assert teleop.endswith("  Action Clients:\n    /turtle1/rotate_absolute: turtlesim/action/RotateAbsolute\n")


def test_a_node_with_another_name(desk: Desk) -> None:
    args = shlex.split("--ros-args --remap __node:=my_turtle")
    with spinning(TurtleSim(context=desk.context, cli_args=args)):
        assert desk.ros2("ros2 node list") == "/my_turtle\n/teleop_turtle\n/turtlesim\n"
        told = without_types(desk.ros2("ros2 node info /my_turtle"))
        assert sorted(told.splitlines()) == sorted(TURTLESIM.replace("/turtlesim", "/my_turtle").splitlines())


# Understanding topics


def test_lists_of_topics(desk: Desk) -> None:
    assert desk.ros2("ros2 topic list -t") == TOPICS
    assert desk.ros2("ros2 topic list") == re.sub(r" \[.*", "", TOPICS)
    assert desk.ros2("ros2 topic find geometry_msgs/msg/Twist") == "/turtle1/cmd_vel\n"


@pytest.mark.parametrize("name", SHOWN)
def test_types_are_shown(desk: Desk, name: str) -> None:
    lines = desk.ros2(f"ros2 interface show {name}").splitlines(keepends=True)
    assert "".join(each for each in lines if each.strip() and not each.startswith("#")) == SHOWN[name]


def test_an_arrow_is_echoed(desk: Desk) -> None:
    sim = desk.turtlesim
    with desk.typing("\x1b[A", when=lambda: sim.count_subscribers("/turtle1/cmd_vel") > 1):
        told = desk.ros2("ros2 topic echo --once /turtle1/cmd_vel")
    assert told == "linear:\n  x: 2.0\n  y: 0.0\n  z: 0.0\nangular:\n  x: 0.0\n  y: 0.0\n  z: 0.0\n---\n"
    wait_until(lambda: desk.pose[0] > 6.0)  # 7.5 in the end, where no step is lost


def test_a_command_is_published_once(desk: Desk) -> None:
    listener = made(desk.context, "listener")
    listener.create_subscription(Twist, "/turtle1/cmd_vel", print, 10)
    assert desk.ros2("ros2 topic info /turtle1/cmd_vel") == (
        "Type: geometry_msgs/msg/Twist\nPublisher count: 1\nSubscription count: 2\n"
    )
    told = desk.ros2(f"ros2 topic pub --once -w 2 /turtle1/cmd_vel geometry_msgs/msg/Twist '{DRIVE}'")
    assert told.replace("Waiting for at least 2 matching subscription(s)...\n", "") == (
        f"publisher: beginning loop\n{DRIVEN}"
    )
    wait_until(lambda: desk.pose[2] > 0.5)


@pytest.mark.slow
def test_a_stream_of_commands_and_its_meters(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    when_said(monkeypatch, pub, "say", lambda text: press_ctrl_c(text) if "#2" in text else None)
    told = desk.ros2(f"ros2 topic pub -r 20 /turtle1/cmd_vel geometry_msgs/msg/Twist '{DRIVE}'", code=130)
    assert DRIVEN in told
    when_said(monkeypatch, meters, "say", press_ctrl_c)
    rate = desk.ros2("ros2 topic hz /turtle1/pose", code=130)
    found = re.fullmatch(r"average rate: ([\d.]+)\n\tmin: [\d.]+s max: [\d.]+s std dev: [\d.]+s window: \d+\n", rate)
    assert found is not None, rate
    assert 20.0 < float(found[1]) < 80.0
    bandwidth = desk.ros2("ros2 topic bw /turtle1/pose", code=130)
    assert "Message size mean: 0.02 KB min: 0.02 KB max: 0.02 KB\n" in bandwidth


def test_the_wall_is_told(desk: Desk, log_lines: list[Record]) -> None:
    desk.ros2("ros2 service call /turtle1/teleport_absolute turtlesim/srv/TeleportAbsolute '{x: 11.0, y: 5.0}'")
    straight = DRIVE.replace("1.8", "0.0")
    desk.ros2(f"ros2 topic pub --once -w 1 /turtle1/cmd_vel geometry_msgs/msg/Twist '{straight}'")
    wait_until(lambda: any(each.message.startswith("Oh no! I hit the wall! (Clamping from") for each in log_lines))


# Understanding services


def test_lists_of_services(desk: Desk) -> None:
    listed = without_types(desk.ros2("ros2 service list -t"))
    for line in ("/clear [std_srvs/srv/Empty]", "/spawn [turtlesim/srv/Spawn]"):
        assert f"{line}\n" in listed
    names = without_types(desk.ros2("ros2 service list")).splitlines()
    parameters = [name for name in names if "parameter" in name]
    assert len(parameters) == 12
    assert [name for name in names if name not in parameters] == [
        *("/clear", "/kill", "/reset", "/spawn"),
        *("/turtle1/set_pen", "/turtle1/teleport_absolute", "/turtle1/teleport_relative"),
    ]
    assert desk.ros2("ros2 service type /clear") == "std_srvs/srv/Empty\n"
    assert desk.ros2("ros2 service info /clear") == "Type: std_srvs/srv/Empty\nClients count: 0\nServices count: 1\n"
    assert desk.ros2("ros2 service find std_srvs/srv/Empty") == "/clear\n/reset\n"


def test_services_are_called(desk: Desk) -> None:
    assert desk.ros2("ros2 service call /clear std_srvs/srv/Empty") == (
        "requester: making request: std_srvs.srv.Empty_Request()\n\nresponse:\nstd_srvs.srv.Empty_Response()\n\n"
    )
    call = """ros2 service call /spawn turtlesim/srv/Spawn "{x: 2, y: 2, theta: 0.2, name: ''}" """
    assert desk.ros2(call) == (
        "requester: making request: turtlesim.srv.Spawn_Request(x=2.0, y=2.0, theta=0.2, name='')\n\n"
        "response:\nturtlesim.srv.Spawn_Response(name='turtle2')\n\n"
    )
    desk.ros2("ros2 service call /turtle1/set_pen turtlesim/srv/SetPen '{r: 255, g: 0, b: 0, width: 5}'")
    assert desk.turtlesim.turtles["turtle1"].turtle.pen == (255, 0, 0, 5, False)


# Understanding parameters


def test_parameters(desk: Desk, log_lines: list[Record]) -> None:
    listed = desk.ros2("ros2 param list").splitlines()
    assert [each for each in listed if "type_description" not in each] == [
        *("/teleop_turtle:", "  scale_angular", "  scale_linear", "  use_sim_time"),
        *("/turtlesim:", "  background_b", "  background_g", "  background_r", "  holonomic", "  use_sim_time"),
    ]
    for channel, value in (("r", 69), ("g", 86), ("b", 255)):
        assert desk.ros2(f"ros2 param get /turtlesim background_{channel}") == f"Integer value is: {value}\n"
    assert desk.ros2("ros2 param set /turtlesim background_r 150") == "Set parameter successful\n"
    wait_until(lambda: desk.turtlesim.canvas.colour_at(9.0, 9.0) == (150, 86, 255))
    dumped = desk.ros2("ros2 param dump /turtlesim")
    assert dumped.startswith(
        "/turtlesim:\n  ros__parameters:\n    background_b: 255\n    background_g: 86\n    background_r: 150\n"
    )
    Path("turtlesim.yaml").write_text(dumped.replace("86", "20"))
    loaded = desk.ros2("ros2 param load /turtlesim turtlesim.yaml")
    for name in ("background_b", "background_g", "background_r", "use_sim_time"):
        assert f"Set parameter {name} successful\n" in loaded
    assert desk.turtlesim.background() == (150, 20, 255)
    args = shlex.split("--ros-args --params-file turtlesim.yaml")
    assert TurtleSim(context=desk.context, cli_args=args).background() == (150, 20, 255)


# Understanding actions


def test_actions(desk: Desk) -> None:
    assert desk.ros2("ros2 action list") == "/turtle1/rotate_absolute\n"
    assert desk.ros2("ros2 action list -t") == "/turtle1/rotate_absolute [turtlesim/action/RotateAbsolute]\n"
    assert desk.ros2("ros2 action type /turtle1/rotate_absolute") == "turtlesim/action/RotateAbsolute\n"
    assert desk.ros2("ros2 action info /turtle1/rotate_absolute") == (
        "Action: /turtle1/rotate_absolute\nAction clients: 1\n    /teleop_turtle\nAction servers: 1\n    /turtlesim\n"
    )


def test_goals(desk: Desk) -> None:
    send = "ros2 action send_goal /turtle1/rotate_absolute turtlesim/action/RotateAbsolute"
    told = desk.ros2(f'{send} "{{theta: 0.3}}"')
    assert re.fullmatch(
        r"Waiting for an action server to become available\.\.\.\nSending goal:\n     theta: 0\.3\n\n"
        r"Goal accepted with ID: [0-9a-f]{32}\n\nResult:\n    delta: -0\.[23]\d+\n\n"
        r"Goal finished with status: SUCCEEDED\n",
        told,
    ), told
    told = desk.ros2(f'{send} "{{theta: -0.1}}" --feedback')
    remaining = [float(each) for each in re.findall(r"Feedback:\n    remaining: (\S+)\n", told)]
    assert remaining == sorted(remaining)
    assert len(remaining) > 10
    assert desk.pose[2] == pytest.approx(-0.1, abs=0.02)


def test_keys_send_goals_and_cancel_them(desk: Desk, log_lines: list[Record]) -> None:
    def told(words: str) -> bool:
        return any(each.message == words for each in log_lines)

    desk.keyboard.text = "t"
    wait_until(lambda: told("Rotation goal completed successfully"))
    desk.keyboard.text = "c"
    wait_until(lambda: desk.turtlesim.turtles["turtle1"].turtle.heading is not None)
    desk.keyboard.text = "f"
    wait_until(lambda: told("Rotation goal canceled"))
    desk.keyboard.text = "d"
    wait_until(lambda: desk.turtlesim.turtles["turtle1"].turtle.heading is not None)
    desk.keyboard.text = "g"
    wait_until(lambda: told("Rotation goal received before a previous goal finished. Aborting previous goal"))
