"""The standard types: their hashes are ROS 2 Jazzy's, their constants too, and each is found by its name."""

import importlib
import json
import pkgutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from rosbags.typesys import Stores, get_typestore

import robolink.interfaces
from robolink.exceptions import MessageError, NotFoundError
from robolink.interfaces import find, names, register
from robolink.interfaces.geometry_msgs.msg import Quaternion, Twist
from robolink.interfaces.sensor_msgs.msg import Imu, LaserScan, NavSatStatus
from robolink.interfaces.std_msgs.msg import Empty as EmptyMessage
from robolink.interfaces.std_srvs.srv import Empty as EmptyService
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import Message, float64, type_hash, type_name

HASHES: dict[str, str] = json.loads((Path(__file__).parent / "data" / "type_hashes.json").read_text())
"""Jazzy's hashes: of messages as rosbags computes them, of services as real ROS 2 nodes announce them.

Two messages differ from rosbags, which takes the char of a .msg file for IDL's: Char, and ServiceEventInfo with its
char[16]. ROS 2 Jazzy makes it a uint8 (rosidl_adapter); the announced hash of every service, which covers a
ServiceEventInfo, agrees.
"""
WITHOUT_HASH = {"tf2_msgs/srv/FrameGraph"}
"""No real node was seen to announce it."""
ALL = names("msg") + names("srv")


def find_full(name: str) -> Any:
    return find(name, name.split("/")[1])


def defined() -> Iterator[Any]:
    """Every message and service class that a module of the packages defines."""
    for package in pkgutil.iter_modules(robolink.interfaces.__path__):
        where = Path(robolink.interfaces.__path__[0]) / package.name
        for kind in ("msg", "srv"):
            if (where / f"{kind}.py").exists() or (where / kind).is_dir():
                module = importlib.import_module(f"robolink.interfaces.{package.name}.{kind}")
                for value in vars(module).values():
                    if isinstance(value, type) and value.__module__.startswith(module.__name__):
                        yield value


@pytest.mark.parametrize("name", sorted(HASHES))
def test_hash_is_that_of_ros(name: str) -> None:
    assert type_hash(find_full(name)) == HASHES[name]


def test_no_type_is_without_a_hash_to_compare_with() -> None:
    assert set(ALL) - set(HASHES) == WITHOUT_HASH


def test_frame_graph_is_an_empty_request_and_yaml() -> None:
    service: Any = find("FrameGraph", "srv")
    assert service.Request.get_fields_and_field_types() == {}
    assert service.Response.get_fields_and_field_types() == {"frame_yaml": "string"}


def test_the_table_of_names_is_what_the_modules_define() -> None:
    assert sorted(type_name(cls) for cls in defined()) == sorted(ALL)


def test_every_class_says_what_it_means() -> None:
    parts = [cls.__dict__.get(part) for cls in defined() for part in ("Request", "Response")]
    classes = [*defined(), *filter(None, parts)]
    assert len(classes) > len(ALL)
    assert [type_name(cls) for cls in classes if not cls.__dict__.get("__doc__")] == []


def test_constants_are_those_of_ros() -> None:
    store = get_typestore(Stores.ROS2_JAZZY)
    wrong = {}
    for name in names("msg"):
        constants = {key: (kind.base, value) for key, (kind, value) in find(name).__ros_constants__.items()}
        expected = {key: (kind, value) for key, kind, value in store.fielddefs[name][0]}
        if constants != expected:
            wrong[name] = constants, expected
    assert wrong == {}
    assert LaserScan.__ros_constants__ == {}
    assert NavSatStatus.STATUS_FIX == 0


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
        ("Fibonacci", "action", "no action type named 'Fibonacci'"),
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
    with pytest.raises(MessageError, match="no type name; it should look like Twist, geometry_msgs/Twist"):
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


def test_finding_one_type_imports_only_what_it_needs() -> None:
    program = (
        "import sys\n"
        "from robolink.interfaces import find\n"
        "find('Twist')\n"
        "loaded = [name for name in sys.modules if name.endswith('.msg') or name == 'numpy']\n"
        "print(*sorted(loaded))\n"
    )
    output = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert output.split() == [
        "robolink.interfaces.builtin_interfaces.msg",
        "robolink.interfaces.geometry_msgs.msg",
        "robolink.interfaces.std_msgs.msg",
    ]
