"""Names and arguments of rclpy 9: names as written, /rosout's profile, content filters, publishers' ids, brackets."""

from __future__ import annotations

import sys
import warnings
from typing import Any

import pytest

import robolink
from robolink import Context, Node, init
from robolink.action import ActionClient, ActionServer
from robolink.action.client import ClientGoalHandle
from robolink.action.server import ServerGoalHandle
from robolink.client import Client
from robolink.exceptions import InvalidNamespaceException, RCLError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.qos import QoSPresetProfiles, qos_profile_rosout_default
from robolink.service import Service
from robolink.subscription_content_filter_options import ContentFilterOptions
from robolink.waitable import Waitable
from tests.support.spins import spin_until


def test_names_are_kept_as_they_were_written(context: Context) -> None:
    with Node("n", namespace="arm", context=context) as node:
        publisher, subscription = node.create_publisher(Int32, "a", 1), node.create_subscription(Int32, "~/a", print, 1)
        service, client = node.create_service(Trigger, "~/s", print), node.create_client(Trigger, "/s")
        assert (publisher.topic, publisher.topic_name) == ("a", "/arm/a")
        assert (subscription.topic, subscription.topic_name) == ("~/a", "/arm/n/a")
        assert (service.srv_name, service.service_name) == ("~/s", "/arm/n/s")
        assert (client.srv_name, client.service_name) == ("/s", "/s")


def test_the_profile_of_rosout_is_given(context: Context) -> None:
    with Node("n", context=context, rosout_qos_profile=7) as node:
        (info,) = node.get_publishers_info_by_topic("/rosout")
        assert info.qos_profile.depth == 7
    with pytest.raises(TypeError, match="Expected QoSProfile or int"):
        Node("m", context=context, rosout_qos_profile="x")  # type: ignore[arg-type]  # the point of the test
    assert QoSPresetProfiles.ROSOUT_DEFAULT.value == qos_profile_rosout_default


def test_a_content_filter_is_told_to_have_no_effect(context: Context, capsys: pytest.CaptureFixture[str]) -> None:
    with Node("n", context=context) as node:
        options = ContentFilterOptions("data > %0", ["3"])
        subscription = node.create_subscription(Int32, "a", print, 1, content_filter_options=options)
        assert "/a: the content filter 'data > %0' has no effect" in capsys.readouterr().err
        assert not subscription.is_cft_enabled
        for use in (lambda: subscription.set_content_filter("data > 3", []), subscription.get_content_filter):
            with pytest.raises(RCLError, match="no content filters"):
                use()


def test_a_message_says_which_publisher_sent_it(context: Context, executor: SingleThreadedExecutor) -> None:
    node, heard = Node("n", context=context), list[Any]()
    executor.add_node(node)

    def take(message: Int32, info: Any) -> None:
        heard.append(info["publisher_gid"])

    node.create_subscription(Int32, "a", take, 5)
    publishers = [node.create_publisher(Int32, "a", 5) for _ in range(2)]
    for each in (publishers[0], publishers[0], publishers[1]):
        each.publish(Int32())
    spin_until(executor, lambda: len(heard) == 3)
    assert [each["implementation_identifier"] for each in heard] == ["rmw_zenoh_cpp"] * 3
    assert heard[0] == heard[1] != heard[2]
    assert len(heard[0]["data"]) == 16


def test_a_node_in_the_root_may_be_named_without_a_namespace(context: Context) -> None:
    with Node("n", context=context) as node:
        node.create_publisher(Int32, "a", 1)
        assert ("/a", ["std_msgs/msg/Int32"]) in node.get_publisher_names_and_types_by_node("n", "")


@pytest.mark.parametrize("namespace", ["//a", "/a//b", "a/"])
def test_a_namespace_is_not_mended(context: Context, namespace: str) -> None:
    with pytest.raises(InvalidNamespaceException):
        Node("n", namespace=namespace, context=context)


@pytest.mark.parametrize(
    ("cls", "count"),
    [
        (Client, 2),
        (Service, 2),
        (ActionClient, 3),
        (ActionServer, 3),
        (ServerGoalHandle, 3),
        (ClientGoalHandle, 3),
        (Waitable, 1),
    ],
)
def test_classes_take_their_types_in_brackets(cls: Any, count: int) -> None:
    assert cls[(int,) * count].__origin__ is cls
    with pytest.raises(TypeError, match=f"has {count} types, got {count + 1}"):
        cls[(int,) * (count + 1)]


@pytest.mark.parametrize("args", ["--ros-args", [1, 2], [None]])
def test_arguments_of_init_are_a_list_of_texts(args: Any) -> None:
    with pytest.raises(TypeError, match="args: expected a list of str"):
        init(args=args)


@pytest.mark.parametrize("package", ["robolink", "rclpy"])
@pytest.mark.parametrize(
    "program", ["from {} import Duration", "import {}\n{}.Duration()", "import {} as r\nr.Duration()"]
)
def test_a_name_that_only_robolink_has_is_told_to_programs_of_rclpy(
    program: str, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "rclpy", robolink)
    monkeypatch.delitem(vars(robolink), "Duration", raising=False)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        exec(compile(program.replace("{}", package), "program.py", "exec"), {"__name__": "program"})
    line = "ROS 2 has no rclpy.Duration: write `from rclpy.duration import Duration`"
    assert [str(each.message) for each in told] == ([line] if package == "rclpy" else [])
