"""Tries robolink without one of its annexes: the rest of the fast tests pass in a copy whose folders of it are deleted.

    python -m tools.without_annex view                     # or several names, or --all
    python -m tools.without_annex --all --together         # in one copy, which has none of them
    python -m tools.without_annex view -- tests/cli -x     # words after -- are pytest's: some tests, other options

An annex is what people can do without. No other room imports it: each finds it by a name in a registry, or a table of
`REGISTRIES`, and says in one line that it is not there (`tests/house/test_annexes.py`). A test of another room
that needs one says so: `@pytest.mark.annex("view")`.
"""

from __future__ import annotations

import argparse
import fnmatch
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

ANNEXES = {
    "dds": [
        "robolink/cli/bridge",
        "robolink/dds",
        "robolink/rtps",
        "tests/cli/bridge",
        "tests/dds",
        "tests/rtps",
        "tests/support/dds_others.py",
        "tests/support/fake_rtps.py",
        "tests/support/mirrored.py",
    ],
    "learn": [
        "robolink/learn",
        "robolink/cli/learn",
        "tests/learn",
        "tests/cli/learn",
        "tests/view/*/test_*learn*.py",
        "tests/docs/test_learn_*.py",
        "tests/support/lines_left_out.py",
    ],
    "nav2": [
        "robolink/counterparts/nav2_*",
        "robolink/counterparts/slam_toolbox",
        "configs/map_it.yaml",
        "configs/navigate.yaml",
        "robolink/navigation",
        "tests/counterparts/test_nav2_*",
        "tests/counterparts/test_slam_toolbox.py",
        "tests/navigation",
        "tests/support/localization_lives.py",
        "tests/support/navigation_lives.py",
        "tests/support/navigation_worlds.py",
        "tests/support/mapping_drives.py",
        "tests/support/scanned_rooms.py",
    ],
    "race": ["robolink/race", "robolink/cli/race", "tests/race", "tests/cli/race"],
    "turtlesim": [
        "robolink/counterparts/turtlesim",
        "robolink/counterparts/turtle_tf2_py",
        "tests/counterparts/turtlesim",
        "tests/counterparts/test_turtle_tf2_py.py",
        "tests/view/page/test_page_turtlesim.py",
    ],
    "view": [
        "robolink/view",
        "robolink/cli/view",
        "tests/view",
        "tests/cli/view",
        "tests/cli/learn/test_learn_view.py",
        "tests/counterparts/turtlesim/test_window.py",
        "tests/support/pages.py",
        "tests/support/view_clients.py",
    ],
    "webots": [
        "robolink/sim/webots",
        "robolink/webots_controller",
        "robolink/launch/ros/webots_ros2_driver.py",
        "robolink/counterparts/webots_ros2_driver",
        "tests/sim/webots",
        "tests/webots_controller",
        "tests/counterparts/test_webots_ros2_driver.py",
        "tests/support/webots_package.py",
    ],
}
"""Folders and files of each annex, as patterns: its code first, then its tests."""

REGISTRIES = (
    "robolink/cli/shared/commands.py",
    "robolink/compat/hooks.py",
    "robolink/compat/names.py",
    "robolink/extensions/optional.py",
    "robolink/networks/kinds.py",
    "robolink/sim/worldfile.py",
)
"""Files whose tables name modules of annexes; rows without their module are not there."""

FAST = ["-q", "-n", "2", "--tb", "no", "-r", "fE", "-m", "not processes and not slow", "--hypothesis-profile", "quick"]
"""Options of pytest for the fast tests, with a line for each test that fails."""


def modules_of(annex: str) -> list[str]:
    """Return the modules and packages that are an annex's, by the names that an import has."""
    paths = [path for pattern in ANNEXES[annex] if pattern.startswith("robolink/") for path in ROOT.glob(pattern)]
    return [".".join(each.relative_to(ROOT).with_suffix("").parts) for each in paths]


def is_here(annex: str) -> bool:
    """Return whether the code of an annex is in this checkout."""
    return any(ROOT.glob(ANNEXES[annex][0]))


def is_of_missing(path: str) -> bool:
    """Return whether a path is in an annex that is not in this checkout."""
    gone = [pattern for annex in ANNEXES if not is_here(annex) for pattern in ANNEXES[annex]]
    return any(fnmatch.fnmatch(path, pattern) or fnmatch.fnmatch(path, f"{pattern}/*") for pattern in gone)


def copied(to: Path) -> None:
    """Copy the files that git tracks, as they are now, into a folder."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, check=True
    )
    for name in filter(None, listed.stdout.decode().split("\0")):
        if (ROOT / name).is_file():  # a file that is deleted and not committed is listed, too
            (to / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, to / name)


def delete(annexes: Iterable[str], folder: Path) -> None:
    """Delete annexes from a copy."""
    for pattern in (pattern for annex in annexes for pattern in ANNEXES[annex]):
        for each in list(folder.glob(pattern)):
            shutil.rmtree(each) if each.is_dir() else each.unlink()


def tried(annexes: list[str], options: list[str]) -> int:
    """Run the fast tests without some annexes; return pytest's exit code."""
    with tempfile.TemporaryDirectory(prefix="without-annex-", ignore_cleanup_errors=True) as name:
        folder = Path(name)
        copied(folder)
        delete(annexes, folder)
        # The virtual environment has the original's path: this one goes first.
        environ = {**os.environ, "PYTHONPATH": name, "PYTHONDONTWRITEBYTECODE": ""}
        where = "import sys, robolink; sys.exit(not robolink.__file__.startswith(sys.argv[1]))"
        subprocess.run([sys.executable, "-c", where, name], cwd=folder, env=environ, check=True)
        there = [each for each in options if not (ROOT / each).exists() or (folder / each).exists()]  # others are gone
        return subprocess.call([sys.executable, "-m", "pytest", *FAST, *there], cwd=folder, env=environ)


def say(line: str) -> None:
    """Write a line to standard output, before what pytest writes there."""
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def main(words: list[str]) -> int:
    """Try what a command line requests; return the highest of pytest's exit codes."""
    own, options = (words[: words.index("--")], words[words.index("--") + 1 :]) if "--" in words else (words, [])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("annex", nargs="*", choices=[*ANNEXES, []], help=", ".join(ANNEXES))
    parser.add_argument("--all", action="store_true", help="each annex in turn")
    parser.add_argument("--together", action="store_true", help="delete all that are named from one copy")
    requested = parser.parse_args(own)
    names = list(ANNEXES) if requested.all else requested.annex
    codes = []
    for each in [names] if requested.together else [[name] for name in names]:
        say(f"--- without {', '.join(each)}")
        codes.append(tried(each, options))
        outcome = f"failed (pytest ended with {codes[-1]})" if codes[-1] else "passed"
        say(f"--- without {', '.join(each)}: {outcome}")
    return max(codes, default=2)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
