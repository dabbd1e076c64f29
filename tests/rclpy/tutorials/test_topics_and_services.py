"""ROS 2's tutorials on packages, publishers and subscribers, services and clients, and types of one's own."""

from __future__ import annotations

from robolink.testing import System
from tests.support.tutorial_workspace import TutorialWorkspace, edit

PUBSUB = (
    "talker = py_pubsub.publisher_member_function:main",
    "listener = py_pubsub.subscriber_member_function:main",
)
SRVCLI = ("service = py_srvcli.service_member_function:main", "client = py_srvcli.client_member_function:main")

GENERATE = """\
find_package(ament_cmake REQUIRED)
find_package(geometry_msgs REQUIRED)
find_package(rosidl_default_generators REQUIRED)

rosidl_generate_interfaces(${PROJECT_NAME}
  "msg/Num.msg"
  "msg/Sphere.msg"
  "srv/AddThreeInts.srv"
  DEPENDENCIES geometry_msgs # Sphere needs it
)
"""
DEPENDENCIES = """\
<buildtool_depend>ament_cmake</buildtool_depend>
  <depend>geometry_msgs</depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
"""
OWN_TYPES = {
    "py_pubsub/publisher_member_function.py": (
        ("from std_msgs.msg import String", "from tutorial_interfaces.msg import Num"),
        ("String", "Num"),
        ("msg.data = 'Hello World: %d' % self.i", "msg.num = self.i"),
        ("'Publishing: \"%s\"' % msg.data", "'Publishing: \"%d\"' % msg.num"),
    ),
    "py_pubsub/subscriber_member_function.py": (
        ("from std_msgs.msg import String", "from tutorial_interfaces.msg import Num"),
        ("String", "Num"),
        ("'I heard: \"%s\"' % msg.data", "'I heard: \"%d\"' % msg.num"),
    ),
    "py_srvcli/service_member_function.py": (
        ("example_interfaces.srv import AddTwoInts", "tutorial_interfaces.srv import AddThreeInts"),
        ("(AddTwoInts, 'add_two_ints'", "(AddThreeInts, 'add_three_ints'"),
        ("request.a + request.b", "request.a + request.b + request.c"),
        ("b: %d' % (request.a, request.b)", "b: %d c: %d' % (request.a, request.b, request.c)"),
    ),
    "py_srvcli/client_member_function.py": (
        ("example_interfaces.srv import AddTwoInts", "tutorial_interfaces.srv import AddThreeInts"),
        ("AddTwoInts", "AddThreeInts"),
        ("'add_two_ints'", "'add_three_ints'"),
        ("a, b)", "a, b, c)"),
        ("self.req.b = b\n", "self.req.b = b\n        self.req.c = c\n"),
        ("int(sys.argv[2]))\n    rclpy", "int(sys.argv[2]), int(sys.argv[3]))\n    rclpy"),
        ("two_ints: for %d + %d =", "three_ints: for %d + %d + %d ="),
        ("int(sys.argv[2]), response", "int(sys.argv[2]), int(sys.argv[3]), response"),
    ),
}
"""Replacements of the tutorial on types of one's own in the programs of those before it."""


def test_creating_a_package(ros2_ws: TutorialWorkspace) -> None:
    told = ros2_ws.ros2(
        "ros2 pkg create --build-type ament_python --license Apache-2.0 --node-name my_node my_package "
        "--destination-directory src"
    )
    for line in ("going to create a new package", "package name: my_package", "build type: ament_python"):
        assert f"{line}\n" in told
    package = ros2_ws.folder / "src/my_package"
    assert {each.relative_to(package).as_posix() for each in package.rglob("*") if each.is_file()} == {
        *("LICENSE", "package.xml", "setup.py", "setup.cfg", "resource/my_package"),
        *("my_package/__init__.py", "my_package/my_node.py"),
    }
    assert ros2_ws.ros2("ros2 pkg executables my_package") == "my_package my_node\n"
    assert ros2_ws.ros2("ros2 pkg xml my_package --tag license") == "Apache-2.0\n"
    assert ros2_ws.ros2("ros2 run my_package my_node") == "Hi from my_package.\n"


def test_a_publisher_and_a_subscriber(ros2_ws: TutorialWorkspace, system: System) -> None:
    ros2_ws.create("py_pubsub", *PUBSUB)
    assert ros2_ws.ros2("ros2 pkg executables py_pubsub") == "py_pubsub listener\npy_pubsub talker\n"
    system.start("py_pubsub talker")
    system.start("py_pubsub listener")
    system.run(3.0)
    heard = [each.message for each in system.logs if each.name == "minimal_subscriber"]
    assert heard[-1] == 'I heard: "Hello World: 5"'
    assert [each.message for each in system.logs if each.name == "minimal_publisher"][:2] == [
        'Publishing: "Hello World: 0"',
        'Publishing: "Hello World: 1"',
    ]


def test_a_service_and_a_client(ros2_ws: TutorialWorkspace, system: System) -> None:
    ros2_ws.create("py_srvcli", *SRVCLI, options="--dependencies rclpy example_interfaces")
    system.start("py_srvcli client", args=["2", "3"])
    system.run(2.5)
    system.expect_log("service not available, waiting again...")
    system.start("py_srvcli service")
    system.expect_log("Incoming request\na: 2 b: 3")
    system.expect_log("Result of add_two_ints: for 2 + 3 = 5")
    system.run(1.0)
    assert system.nodes == ["/minimal_service"]


def interfaces_package(ros2_ws: TutorialWorkspace) -> None:
    """Create tutorial_interfaces, with the lines of the tutorial in its CMakeLists.txt and package.xml."""
    package = ros2_ws.create("tutorial_interfaces")
    edit(package / "CMakeLists.txt", ("find_package(ament_cmake REQUIRED)\n", GENERATE))
    edit(package / "package.xml", ("<buildtool_depend>ament_cmake</buildtool_depend>\n", DEPENDENCIES))


def test_types_of_ones_own_are_shown(ros2_ws: TutorialWorkspace) -> None:
    interfaces_package(ros2_ws)
    assert ros2_ws.ros2("ros2 interface show tutorial_interfaces/msg/Num") == "int64 num\n"
    assert ros2_ws.ros2("ros2 interface show tutorial_interfaces/srv/AddThreeInts") == (
        "int64 a\nint64 b\nint64 c\n---\nint64 sum\n"
    )
    sphere = ros2_ws.ros2("ros2 interface show tutorial_interfaces/msg/Sphere")
    lines = [line for line in sphere.splitlines() if line.partition("#")[0].strip()]
    assert lines == ["geometry_msgs/Point center", "\tfloat64 x", "\tfloat64 y", "\tfloat64 z", "float64 radius"]


def test_a_message_and_a_service_of_ones_own_are_used(ros2_ws: TutorialWorkspace, system: System) -> None:
    interfaces_package(ros2_ws)
    pubsub, srvcli = ros2_ws.create("py_pubsub", *PUBSUB), ros2_ws.create("py_srvcli", *SRVCLI)
    for file, changes in OWN_TYPES.items():
        edit((pubsub if file.startswith("py_pubsub") else srvcli) / file, *changes)
    system.start("py_pubsub talker")
    system.start("py_pubsub listener")
    system.start("py_srvcli service")
    system.start("py_srvcli client", args=["2", "3", "1"])
    system.expect_log("Incoming request\na: 2 b: 3 c: 1")
    system.expect_log("Result of add_three_ints: for 2 + 3 + 1 = 6")
    system.expect_log('I heard: "3"')
    assert system.topics["/topic"] == "tutorial_interfaces/msg/Num"


def test_a_message_in_the_package_that_uses_it(ros2_ws: TutorialWorkspace, system: System) -> None:
    package = ros2_ws.create("more_interfaces", options="--node-name publish_address_book")
    assert (package / "CMakeLists.txt").read_text().count("publish_address_book") == 2
    system.start("more_interfaces publish_address_book")
    book = system.expect("address_book")
    assert (book.first_name, book.last_name, book.phone_type) == ("John", "Doe", book.PHONE_TYPE_MOBILE)
    assert ros2_ws.ros2("ros2 pkg executables more_interfaces") == "more_interfaces publish_address_book\n"
