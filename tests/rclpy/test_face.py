"""The face of the package: its names, what a bare import gives, and how little that costs."""

from __future__ import annotations

import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

import robolink

HEAVY = ("zenoh", "numpy", "yaml", "pymunk", "rich", "typer", "msgspec", "asyncio")


def run(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_the_list_of_names_is_the_table_of_homes() -> None:
    assert sorted(robolink._HOMES) == sorted(robolink.__all__) == list(robolink.__all__)


@pytest.mark.parametrize("name", robolink.__all__)
def test_each_name_is_there_and_lives_where_it_is_said_to(name: str) -> None:
    home = importlib.import_module(f"robolink.{robolink._HOMES[name]}")
    assert getattr(robolink, name) is getattr(home, name)
    assert name in dir(robolink)


@pytest.mark.parametrize("name", sorted(robolink._ROOMS))
def test_each_module_is_an_attribute_after_a_bare_import(name: str) -> None:
    assert getattr(robolink, name) is importlib.import_module(f"robolink.{name}")
    assert (Path(robolink.__file__).parent / f"{name}.py").is_file() or (
        Path(robolink.__file__).parent / name / "__init__.py"
    ).is_file()


def test_what_type_checkers_see_is_what_is_there() -> None:
    text = Path(robolink.__file__).read_text()
    seen = text.partition("if TYPE_CHECKING:")[2].partition("_HOMES")[0]
    assert [name for name in robolink.__all__ if name not in seen] == []


@pytest.mark.processes
def test_a_bare_import_imports_nothing_heavy() -> None:
    code = f"import sys, robolink; print([name for name in {HEAVY} if name in sys.modules])"
    assert run(code) == "[]"


@pytest.mark.processes
def test_a_node_in_memory_needs_no_network() -> None:
    code = (
        "import sys, robolink\n"
        "context = robolink.Context(transport='memory://'); context.init([])\n"
        "robolink.Node('node', context=context); context.shutdown()\n"
        "print([name for name in ('zenoh', 'yaml', 'pymunk', 'rich', 'typer') if name in sys.modules])"
    )
    assert run(code) == "[]"


@pytest.mark.processes
def test_attributes_that_programs_use_without_importing_them() -> None:
    code = (
        "import robolink as rclpy\n"
        "rclpy.time.Time; rclpy.time.Duration; rclpy.qos.QoSProfile; rclpy.executors.SingleThreadedExecutor\n"
        "rclpy.logging.get_logger('x'); rclpy.task.Future; rclpy.callback_groups.ReentrantCallbackGroup\n"
        "rclpy.Parameter; rclpy.duration.Duration; rclpy.node.Node; print(rclpy.__version__)"
    )
    assert run(code)[0].isdigit()


# In a process of their own: once this one has imported rclpy, modules answer by that name.

WRONG = """
import importlib
module = importlib.import_module({package!r})
assert {{{name!r}, *module.__all__}} <= set(dir(module)), dir(module)
assert all(hasattr(module, each) for each in module.__all__)
try:
    module.{wrong}
except AttributeError as error:
    print(error)
try:
    from {package} import {wrong}
except ImportError as error:
    print(error)
"""


@pytest.mark.processes
@pytest.mark.parametrize(
    ("package", "name"),
    [("robolink", "spin"), ("robolink.action", "ActionClient"), ("robolink.tf2", "TransformListener")],
)
def test_a_package_gives_its_names_and_says_what_is_near_one_that_it_has_not(package: str, name: str) -> None:
    wrong = name.replace("i", "y")
    lines = run(WRONG.format(package=package, name=name, wrong=wrong)).splitlines()
    said = re.compile(rf"robolink [0-9.]+ has no {re.escape(f'{package}.{wrong}')} \(did you mean '{name}'\?\)")
    assert len(lines) == 2
    assert all(said.fullmatch(each) for each in lines), lines
