"""The programs of the judge, copied to a folder where they can be run, and what the real rclpy printed."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

HERE = Path(__file__).parent
PROGRAMS = HERE / "programs"
RECORDINGS = HERE / "recordings"
TEST_MSGS = HERE.parent / "data" / "workspace" / "src" / "test_msgs"

OURS = [sys.executable, "-m", "robolink", "run"]
"""The command that runs a program by robolink."""

_UNSTEADY = "--- unsteady\n"


def names() -> list[str]:
    """Return the names of the programs."""
    return sorted(path.stem for path in PROGRAMS.glob("*.py") if path.stem != "probe")


def copied_to(folder: Path) -> Path:
    """Copy the programs into a folder, beside ROS 2's test_msgs, which the real rclpy has in a package of its own."""
    shutil.copytree(PROGRAMS, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(TEST_MSGS, folder / "interfaces" / "test_msgs", dirs_exist_ok=True)
    return folder


def recording(name: str) -> tuple[str, list[str]]:
    """Return the output of the real rclpy, and the lines that were not the same each time; of a new program nothing."""
    if not (RECORDINGS / f"{name}.txt").exists():
        return "", []
    text, _, unsteady = (RECORDINGS / f"{name}.txt").read_text(encoding="utf-8").partition(_UNSTEADY)
    return text, unsteady.splitlines()


def record(name: str, text: str, unsteady: list[str]) -> None:
    """Keep what the real rclpy printed."""
    foot = _UNSTEADY + "".join(line + "\n" for line in unsteady) if unsteady else ""
    (RECORDINGS / f"{name}.txt").write_text(text + foot, encoding="utf-8")
