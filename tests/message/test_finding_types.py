"""Messages and services of the standard packages: how each is found by its name, and what is said of others."""

import subprocess
import sys
from typing import Any

import pytest

import robolink.interfaces
from robolink.exceptions import MessageError, NotFoundError
from robolink.interfaces import find, names, register
from robolink.interfaces.geometry_msgs.msg import Quaternion, Twist
from robolink.interfaces.sensor_msgs.msg import Imu, LaserScan, NavSatStatus
from robolink.interfaces.std_msgs.msg import Empty as EmptyMessage
from robolink.interfaces.std_srvs.srv import Empty as EmptyService
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import (
    Message,
    Sequence,
    float32,
    float64,
    int32,
    string,
    uint8,
)


def test_constants_of_a_response() -> None:
    load_map: Any = find("LoadMap", "srv")
    assert load_map.Response.RESULT_UNDEFINED_FAILURE == 255


def test_defaults_are_those_of_ros() -> None:
    assert (Quaternion().x, Quaternion().w) == (0.0, 1.0)
    assert NavSatStatus().status == NavSatStatus.STATUS_UNKNOWN == -2
    assert Imu().orientation.w == 1.0
    assert list(Imu().orientation_covariance) == [0.0] * 9


def test_two_messages_share_no_default() -> None:
    first, second = Twist(), Twist()
    first.linear.x = 0.3
    assert second.linear.x == 0.0
    one, other = LaserScan(), LaserScan()
    one.ranges.append(1.0)
    assert list(other.ranges) == []


@pytest.mark.parametrize(
    ("annotation", "default", "report"),
    [
        (int32, "x", "a default that does not fit: .*Odd.size: expected int32, got 'x'"),
        (uint8, 300, "expected uint8, got 300"),
        (float32, 1e300, "expected float32, got 1e[+]300"),
        (string, 5, "expected string, got 5"),
        (string, "\ud800", "is not valid Unicode"),
        (Sequence[int32], [1, "x"], "expected int32, got 'x'"),
        (Twist, Twist(), "can have no default: only primitive types"),
        (Sequence[Twist], [Twist()], "can have no default: only primitive types"),
    ],
)
def test_a_default_that_does_not_fit_is_refused_with_the_class(annotation: Any, default: Any, report: str) -> None:
    with pytest.raises(MessageError, match=report):

        class Odd(Message):
            size: annotation = default


@pytest.mark.parametrize(
    "name",
    [
        "Twist",
        "geometry_msgs/Twist",
        "geometry_msgs/msg/Twist",
        "geometry_msgs.msg.Twist",
        "geometry_msgs.Twist",
    ],
)
def test_find_takes_every_spelling(name: str) -> None:
    assert find(name) is Twist


def test_find_services() -> None:
    assert find("SetBool", "srv") is SetBool
    assert find("std_srvs/srv/SetBool", "srv") is SetBool
    assert find("Empty", "srv") is EmptyService
    assert find("Empty") is EmptyMessage


@pytest.mark.parametrize(
    ("name", "kind", "text"),
    [
        ("Twst", "msg", "no message type named 'Twst' (did you mean 'Twist'?)"),
        ("twist", "msg", "no message type named 'twist' (did you mean 'Twist'?)"),
        ("Twist", "srv", "no service type named 'Twist'"),
        (
            "geometry_msgs/Twits",
            "msg",
            "no message type named 'Twits' in geometry_msgs (did you mean 'Twist'?)",
        ),
        (
            "geometry_msg/msg/Twist",
            "msg",
            "no interface package named 'geometry_msg' (did you mean 'geometry_msgs'?)",
        ),
        ("geometry_msgs/srv/Twist", "srv", "no service type named 'Twist' in geometry_msgs"),
        ("Fetch", "action", "no action type named 'Fetch'"),
        (
            "nav2_msgs/NavigateTo",
            "action",
            "no action type named 'NavigateTo' in nav2_msgs (did you mean 'NavigateToPose'?)",
        ),
    ],
)
def test_find_what_is_not_there(name: str, kind: str, text: str) -> None:
    with pytest.raises(NotFoundError) as raised:
        find(name, kind)
    assert str(raised.value) == text


@pytest.mark.parametrize(
    "name", ["", "/", "Twist ", "/Twist", "geometry_msgs/", "a/b/c/d", "a/foo/B", "1st", "Twist\n", "Größe"]
)
def test_find_refuses_what_is_no_name(name: str) -> None:
    with pytest.raises(MessageError, match="not a type name; it should look like Twist, geometry_msgs/Twist"):
        find(name)


def test_find_says_when_the_name_is_of_another_kind() -> None:
    with pytest.raises(MessageError, match="'std_srvs/srv/SetBool' is the name of a service type; a message"):
        find("std_srvs/srv/SetBool")


@pytest.fixture
def registry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robolink.interfaces, "_registered", {})


class Wheels(Message, type_name="my_robot_msgs/msg/Wheels"):
    left: float64
    right: float64


class OtherWheels(Message, type_name="their_robot_msgs/msg/Wheels"):
    front: float64


class OtherEmpty(Message, type_name="their_robot_msgs/msg/Empty"):
    pass


@pytest.mark.usefixtures("registry")
def test_a_registered_type_is_found_and_listed() -> None:
    register(Wheels)
    assert find("Wheels") is find("my_robot_msgs/Wheels") is Wheels
    assert "my_robot_msgs/msg/Wheels" in names()
    with pytest.raises(NotFoundError, match=r"'Wheel' in my_robot_msgs .did you mean 'Wheels'"):
        find("my_robot_msgs/msg/Wheel")


@pytest.mark.usefixtures("registry")
def test_a_name_that_several_packages_have() -> None:
    for each in (Wheels, OtherWheels, OtherEmpty):
        register(each)
    assert find("Empty") is EmptyMessage
    assert find("their_robot_msgs/Empty") is OtherEmpty
    with pytest.raises(MessageError) as raised:
        find("Wheels")
    assert str(raised.value) == (
        "several message types are named 'Wheels': say my_robot_msgs/msg/Wheels or their_robot_msgs/msg/Wheels"
    )


@pytest.mark.processes
@pytest.mark.parametrize(
    ("name", "kind", "packages"),
    [
        ("Twist", "msg", ["geometry_msgs.msg"]),
        ("turtlesim/RotateAbsolute", "action", ["turtlesim.action"]),
        (
            "NavigateToPose",
            "action",
            [
                "builtin_interfaces.msg",
                "geometry_msgs.msg",
                "nav2_msgs.action",
                "std_msgs.msg",
            ],
        ),
    ],
)
def test_finding_one_type_makes_only_what_it_needs(name: str, kind: str, packages: list[str]) -> None:
    program = (
        "import sys\n"
        "from robolink.interfaces import find, standard\n"
        f"find('{name}', '{kind}')\n"
        "print(*sorted({f'{package}.{kind}' for package, kind, _ in standard._made}), *{'numpy'} & set(sys.modules))\n"
    )
    output = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert output.split() == packages
