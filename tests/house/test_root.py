"""The root of the package holds rclpy's modules and nothing else; each room has a folder of tests."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import robolink

ROOT = Path(robolink.__file__).parent
TESTS = Path(__file__).parents[1]
RCLPY = TESTS / "data" / "rclpy_api.json"
OWN = {
    "__main__": "python -m robolink",
    "endpoint_info": "a module of rclpy of 2026",
    "spinning": "what stands in rclpy's own __init__: init, spin, shutdown",
    "subscription_content_filter_options": "a module of rclpy 9",
    "type_lookup": "types that other nodes describe: it belongs to no room below the node, and has no sister",
}
"""The modules in the root that rclpy 8 does not have, each with the reason."""
MOST = 53
"""Largest number of files in the root."""


def test_a_file_in_the_root_is_a_module_of_rclpys() -> None:
    modules = json.loads(RCLPY.read_text(encoding="utf-8"))["modules"]
    rclpys = {name.partition(".")[0] or "__init__" for name in modules}
    files = {path.stem for path in ROOT.glob("*.py")}
    assert files - rclpys == set(OWN), "a module of robolink's own belongs into a room, not into the root"
    assert len(files) <= MOST


def rooms() -> list[Path]:
    return [each.parent for each in ROOT.glob("*/__init__.py")]


@pytest.mark.parametrize("room", rooms(), ids=lambda room: room.name)
def test_a_room_says_what_it_is_and_has_a_folder_of_tests(room: Path) -> None:
    first = (room / "__init__.py").read_text(encoding="utf-8").partition("\n")[0]
    assert first.startswith(('"""', 'r"""'))
    assert any((TESTS / room.name).rglob("test_*.py")), "tests/ mirrors robolink/"
