"""Launch descriptions that ROS 2's launch has run: `tests/data/ros_launch` has them, and what it started and said.

To record anew, after a change of the descriptions or for another version of ROS 2's launch:

    python -m tests.support.launch_descriptions REAL_PYTHON [NAME...]

REAL_PYTHON is that of an environment in which `import launch_ros, launch_xml, launch_yaml, rclpy` works, sourced or
made by pip: `ros-rclpy ros-rmw-fastrtps-cpp ros-rmw-implementation ros-std-msgs ros-lifecycle-msgs osrf-pycommon
ros-ament-index-python lark pyyaml packaging`, then the folders launch, launch_xml, launch_yaml of ros2/launch and
launch_ros of ros2/launch_ros with `--no-deps`. It starts real processes, one description after the other, in minutes.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.support.ros_launch import HEAD

DATA = Path(__file__).parents[1] / "data" / "ros_launch"
RECORDED = DATA / "recorded.json"
INHERITED = {"X_FIRST": "inherited"}
"""Environment that each launch has."""
SHOW = """
def Show(**given):
    return Node(package="judge", executable="show", **given)

"""


@dataclass(frozen=True)
class Description:
    """A launch description: name of its file, launch arguments, and its text as it is in the data."""

    name: str
    arguments: tuple[str, ...]
    text: str

    @property
    def given(self) -> dict[str, str]:
        """The launch arguments by name."""
        return dict(each.split(":=", 1) for each in self.arguments)

    def write(self, folder: Path) -> Path:
        """Write it into a folder as a launch file, and return its path."""
        path = folder / self.name
        path.write_text(_whole(self.name, self.text).replace("here/", f"{folder.as_posix()}/"), encoding="utf-8")
        return path


def descriptions() -> list[Description]:
    """Return all descriptions, by name."""
    return [each for each in _sections() if "/" not in each.name]


def write_files(folder: Path) -> None:
    """Write the files that descriptions include or read into a folder."""
    for each in _sections():
        if "/" in each.name:
            Description(Path(each.name).name, (), each.text).write(folder)


def recorded() -> dict[str, Any]:
    """Return the outcome of each description by ROS 2's launch, by name."""
    found: dict[str, Any] = json.loads(RECORDED.read_text(encoding="utf-8"))
    return found


def _sections() -> list[Description]:
    text = (DATA / "descriptions.txt").read_text(encoding="utf-8")
    parts = re.split(r"^#### (?:file )?(.+)\n", text, flags=re.MULTILINE)[1:]
    heads = (each.split() for each in parts[::2])
    return [Description(head[0], tuple(head[1:]), body) for head, body in zip(heads, parts[1::2], strict=True)]


def _whole(name: str, text: str) -> str:
    """Return the text of a launch file, of which the data have what differs."""
    if name.endswith(".launch.xml"):
        return text if text.startswith(("<launch", "<?")) else f"<launch>\n{text}</launch>\n"
    if not name.endswith(".py"):
        return text
    if "def generate_launch_description" not in text:
        text = f"def generate_launch_description():\n    return LaunchDescription([\n{text}])\n"
    return HEAD + SHOW + text


# Recording


def _record(python: str, names: list[str]) -> None:
    known = recorded() if RECORDED.exists() and names else {}
    with tempfile.TemporaryDirectory() as top:
        folder = Path(top).resolve()
        write_files(folder)
        _install(folder / "prefix", python)
        for each in descriptions():
            if not names or each.name in names:
                known[each.name] = _run(each, folder, python)
                sys.stdout.write(f"{each.name} {json.dumps(known[each.name])[:200]}\n")
    lines = (f"{json.dumps(name)}: {json.dumps(known[name], sort_keys=True)}" for name in sorted(known))
    RECORDED.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def _install(prefix: Path, python: str) -> None:
    """Make the package `judge`, as an installed one."""
    program = prefix / "lib" / "judge" / "show"
    marker = prefix / "share" / "ament_index" / "resource_index" / "packages" / "judge"
    for each in (program, marker, prefix / "share" / "judge" / "package.xml"):
        each.parent.mkdir(parents=True, exist_ok=True)
        each.write_text("")
    program.write_text((DATA / "show.py").read_text().replace("/usr/bin/env python3", python, 1))
    program.chmod(0o755)


def _run(description: Description, folder: Path, python: str) -> dict[str, Any]:
    """Run a description with ROS 2's launch, and return what it started and said."""
    shown, result = folder / "shown", folder / "result"
    for each in (shown, result):
        each.unlink(missing_ok=True)
    prefixes = [
        folder / "prefix",
        Path(python).parent.parent,
        *os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep),
    ]
    env = {
        **os.environ,
        **INHERITED,
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "AMENT_PREFIX_PATH": os.pathsep.join(str(each) for each in prefixes if str(each)),
        "ROS_LOG_DIR": str(folder / "log"),
        "SHOWN": str(shown),
        "RESULT": str(result),
    }
    path = description.write(folder)
    words = ["timeout", "-s", "KILL", "60", python, str(DATA / "run_real.py"), str(path), *description.arguments]
    subprocess.run(words, env=env, cwd=folder, capture_output=True, check=False)
    nodes = [json.loads(each) for each in shown.read_text().splitlines()] if shown.exists() else []
    found = json.loads(result.read_text()) if result.exists() else {"exit": None, "said": [], "error": "never ended"}
    shutil.rmtree(folder / "log", ignore_errors=True)
    text = json.dumps({**found, "nodes": sorted(nodes, key=lambda each: str(each.get("name")))})
    done: dict[str, Any] = json.loads(text.replace(f"{folder.as_posix()}/", "here/"))
    done["error"] = _reason(done["error"])
    return done


def _reason(error: str) -> str:
    """Return the line of an error's text that has the reason: the first of those of several readers."""
    lines = [each.strip() for each in error.splitlines() if each.startswith(" - ")]
    return (lines[0][2:] if lines else error.rpartition("traceback): ")[2])[:160]


if __name__ == "__main__":
    _record(sys.argv[1], sys.argv[2:])
