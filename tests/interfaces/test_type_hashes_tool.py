"""tools/type_hashes.py: it computes the hashes that ROS 2 announces, and notices a file of rosidl's that differs."""

from __future__ import annotations

import importlib.util
import json
import re
import shutil
from pathlib import Path
from types import ModuleType

import pytest

from tests.support.ros_test_types import PACKAGE

ROOT = Path(__file__).parents[2]
HASHES: dict[str, str] = json.loads((ROOT / "tests" / "data" / "type_hashes.json").read_text())


def _tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("type_hashes", ROOT / "tools" / "type_hashes.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


tool = _tool()


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """The tests' test_msgs, without wide text and what only .idl files define, which rosbags does not read."""
    return Path(shutil.copytree(PACKAGE, tmp_path / "test_msgs", ignore=shutil.ignore_patterns("WStrings.*", "*.idl")))


def test_the_hashes_of_test_msgs(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tool.main([package])
    found = json.loads(capsys.readouterr().out)["test_msgs"]
    assert found["hashes"] == {
        name: each
        for name, each in HASHES.items()
        if name.startswith("test_msgs/") and not any(odd in name for odd in ("WStrings", "Keyed", "NestedKey"))
    }
    assert found["constants"]["test_msgs/msg/Constants"]["INT16_CONST"] == -1000


def test_a_published_hash_that_differs_is_an_error(package: Path) -> None:
    published = {"type_hashes": [{"type_name": "test_msgs/msg/Empty", "hash_string": "RIHS01_00"}]}
    (package / "msg" / "Empty.json").write_text(json.dumps(published))
    computed = re.escape(HASHES["test_msgs/msg/Empty"])
    with pytest.raises(SystemExit, match=f"Empty.msg: {computed} is computed, RIHS01_00 is published"):
        tool.main([package])
