"""Every name that public rclpy programs were counted to use is there, and a test shows what it does."""

from __future__ import annotations

import importlib
import inspect
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import robolink
from robolink.message import Message, decode, encode
from tests.support.rclpy_use import OTHERS, OUT_OF_SCOPE, SHOWN, USE, rows

CLASSES = {
    "Node": "node.Node",
    "Publisher": "publisher.Publisher",
    "Subscription": "subscription.Subscription",
    "Client": "client.Client",
    "Service": "service.Service",
    "Timer": "timer.Timer",
    "Rate": "timer.Rate",
    "Clock": "clock.Clock",
    "Time": "time.Time",
    "Duration": "duration.Duration",
    "Parameter": "parameter.Parameter",
    "Future": "task.Future",
    "Executor": "executors.Executor",
    "ActionClient": "action.ActionClient",
    "ClientGoalHandle": "action.client.ClientGoalHandle",
    "ActionServer": "action.ActionServer",
    "ServerGoalHandle": "action.server.ServerGoalHandle",
    "Logger": "impl.rcutils_logger.RcutilsLogger",
    "Context": "context.Context",
    "LifecycleNodeMixin": "lifecycle.LifecycleNodeMixin",
    "AsyncParameterClient": "parameter_client.AsyncParameterClient",
}
OWN_ATTRIBUTES = {"Subscription.callback", "Timer.clock", "ClientGoalHandle.stamp"}
"""What an object has and its class does not."""

FUNCTIONS = {
    **{name: name for name in ("init", "spin", "spin_once", "spin_until_future_complete", "shutdown", "create_node")},
    **{name: f"node.Node.{name}" for name in ("create_subscription", "create_publisher", "create_timer")},
    **{name: f"node.Node.{name}" for name in ("create_service", "create_client")},
    **{name: f"node.Node.{name}" for name in ("declare_parameter", "declare_parameters")},
    **{name: f"impl.rcutils_logger.RcutilsLogger.{name}" for name in ("info", "debug", "warn", "error", "log")},
    "Node.__init__": "node.Node",
    "QoSProfile": "qos.QoSProfile",
    "Duration": "duration.Duration",
    "Time": "time.Time",
    "Parameter": "parameter.Parameter",
    "wait_for_service": "client.Client.wait_for_service",
    "send_goal_async": "action.ActionClient.send_goal_async",
    "wait_for_server": "action.ActionClient.wait_for_server",
    "ActionServer": "action.ActionServer",
    "ActionClient": "action.ActionClient",
    "MultiThreadedExecutor": "executors.MultiThreadedExecutor",
    "SingleThreadedExecutor": "executors.SingleThreadedExecutor",
    "ParameterDescriptor": "interfaces.rcl_interfaces.msg.ParameterDescriptor",
    "SetParametersResult": "interfaces.rcl_interfaces.msg.SetParametersResult",
    "FloatingPointRange": "interfaces.rcl_interfaces.msg.FloatingPointRange",
}
FILTERS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")
"""A logger's methods take these as any keywords."""


def found(name: str) -> Any:
    """What is at this place of robolink, imported as far as need be."""
    value: Any = robolink
    for part in name.split("."):
        if not hasattr(value, part):
            importlib.import_module(f"{value.__name__}.{part}")
        value = getattr(value, part)
    return value


def takes(function: Callable[..., Any], keyword: str) -> bool:
    """Whether a function, or what a class is made with, takes this keyword."""
    if isinstance(function, type) and issubclass(function, Message):
        return keyword in function.get_fields_and_field_types()
    return keyword in inspect.signature(function).parameters


# --- The walk ---------------------------------------------------------------------------------------------------------


def test_what_programs_take_from_the_module_is_there() -> None:
    for name in USE["module"]:
        found(name.removeprefix("rclpy."))


def test_what_programs_import_is_there() -> None:
    for name in USE["imports"]:
        if name != "import rclpy":
            found(name.removeprefix("import ").removeprefix("rclpy."))


def test_what_programs_use_of_an_object_is_there() -> None:
    used = {(owner, name) for owner, names in USE["attributes"].items() if owner in CLASSES for name in names}
    lacking = {f"{owner}.{name}" for owner, name in used if not hasattr(found(CLASSES[owner]), name)}
    assert lacking - {*OTHERS, *OWN_ATTRIBUTES} == set()


def test_what_programs_pass_by_keyword_is_taken() -> None:
    passed = [
        (function, keyword)
        for function, keywords in USE["keywords"].items()
        for keyword in keywords
        if f"{function}({keyword}=)" not in OTHERS and keyword not in FILTERS and function != "lookup_transform"
    ]
    assert [
        f"{function}({keyword}=)" for function, keyword in passed if not takes(found(FUNCTIONS[function]), keyword)
    ] == []


@pytest.mark.parametrize("keyword", USE["keywords"]["lookup_transform"])
def test_what_programs_ask_of_a_buffer_is_taken(keyword: str) -> None:
    buffer = found("tf2.Buffer")
    assert any(takes(each, keyword) for each in (buffer.lookup_transform, buffer.lookup_transform_full))


def test_every_type_that_programs_use_crosses_the_wire() -> None:
    for name in USE["types"]:
        crosses_the_wire(name)


def crosses_the_wire(name: str) -> None:
    made = found(f"interfaces.{name}")
    messages = {"msg": [made], "srv": [], "action": []}[name.split(".")[1]]
    messages += [
        getattr(made, part) for part in ("Request", "Response", "Goal", "Result", "Feedback") if hasattr(made, part)
    ]
    assert messages
    for each in messages:
        assert decode(each, encode(each())) == each()


@pytest.mark.parametrize("row", [*OTHERS])
def test_what_is_said_to_be_of_others_is_in_the_tables_and_not_here(row: str) -> None:
    assert row in set(rows())
    function, _, keyword = row.removesuffix("=)").partition("(")
    assert not keyword or not takes(found(FUNCTIONS[function]), keyword)


# --- The tests --------------------------------------------------------------------------------------------------------


def test_a_test_shows_each_row() -> None:
    for each in Path(__file__).parents[1].glob("test_rclpy_use_*.py"):
        importlib.import_module(f"tests.{each.stem}")
    wanted = set(rows()) - OTHERS.keys()
    assert sorted(wanted - SHOWN.keys()) == [], "no test shows these"
    assert sorted(SHOWN.keys() - wanted) == [], "these are in no table"


# --- By the names that programs import --------------------------------------------------------------------------------

IMPORTS = """
import importlib, json, sys
import robolink.compat

def missing(line):
    if line.startswith("import ") or "." not in line:
        try:
            exec(line if line.startswith("import ") else f"import {line}", {})
        except ImportError as error:
            return str(error)
        return None
    module, _, name = line.rpartition(".")
    try:
        exec(f"from {module} import {name}", {})
    except ImportError as error:
        return str(error)

print(json.dumps({line: missing(line) for line in json.load(sys.stdin)}))
"""


def is_ours(name: str) -> bool:
    """Whether it is robolink that has to make this importable."""
    package = name.removeprefix("import ").partition(".")[0]
    return package not in OUT_OF_SCOPE and package not in sys.stdlib_module_names


@pytest.fixture(scope="module")
def imported() -> dict[str, str | None]:
    """By what programs import: why it cannot be. All in one process, where `robolink.compat` is at work."""
    wanted = [each for kind in ("imports", "other_packages", "types", "modules") for each in USE[kind] if is_ours(each)]
    done = subprocess.run(
        [sys.executable, "-c", IMPORTS], input=json.dumps(wanted), capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found: dict[str, str | None] = json.loads(done.stdout)
    return found


@pytest.mark.processes
@pytest.mark.parametrize("kind", ["imports", "other_packages", "types", "modules"])
def test_programs_find_it_by_its_name_in_ros_2(kind: str, imported: dict[str, str | None]) -> None:
    assert {name: imported[name] for name in USE[kind] if is_ours(name) and imported[name]} == {}


def test_what_is_out_of_scope_is_in_the_tables() -> None:
    named = {each.partition(".")[0] for kind in ("other_packages", "modules") for each in USE[kind]}
    assert OUT_OF_SCOPE.keys() <= named
