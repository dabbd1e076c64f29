"""Generator of the pictures of the page: a simulated robot, or an exercise, seen in headless Chromium.

Usage: python tools/view_picture.py docs/pictures/view.png [--system wander] [--seconds 30] [--theme dark]
       python tools/view_picture.py docs/pictures/exercises.png --exercise stop --theme light --height 640
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from robolink.grading.languages import Language  # noqa: E402
from robolink.learn.folder import start_folder  # noqa: E402
from tests.support.browser import Browser, chromium  # noqa: E402
from tests.support.domains import free_domain  # noqa: E402

CELL = dict[str, Any]


def cell(panel: str, height: float, **options: Any) -> CELL:
    """A panel of the layout."""
    return {"id": panel, "height": height, "options": options}


COMMAND = {"topic": "/cmd_vel"}
PLOT = [COMMAND | {"path": "linear.x"}, COMMAND | {"path": "angular.z", "axis": 1}]
LAYOUT = {
    "columns": [
        {"width": 62, "cells": [cell("world", 100)]},
        {"width": 38, "cells": [cell("topics", 60, topic="/cmd_vel"), cell("plot", 40, series=PLOT, seconds=30)]},
    ]
}


def main() -> None:
    """Take the picture that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("--system", default="wander", help="launch file")
    parser.add_argument("--exercise", help="an exercise of robolink learn as it is given, in the place of a system")
    parser.add_argument("--seconds", type=float, default=30.0, help="seconds that the robot drives")
    parser.add_argument("--theme", default="dark", choices=["dark", "light"])
    parser.add_argument("--width", type=int, default=1280)
    parser.add_argument("--height", type=int, default=720)
    parser.add_argument("--language", default="en", choices=["en", "pt"])
    requested = parser.parse_args()
    if chromium is None:
        sys.exit("chromium is not installed: apt-get install chromium")
    with Browser(requested.width, requested.height) as browser, tempfile.TemporaryDirectory() as scratch:
        if requested.exercise:
            folder = begun(Path(scratch), requested.exercise, requested.language)
            with started(folder, "learn", "view", "--no-browser", "--port", "0") as address:
                take_exercise(browser, address, requested)
        else:
            with started(ROOT, "launch", requested.system, "--view") as address:
                take(browser, address, requested)
        if browser.problems:
            sys.exit(f"the page's console: {browser.problems[:3]}")


def begun(folder: Path, exercise: str, language: Language) -> Path:
    """A folder of exercises in which those before one are done."""
    student = start_folder(str(folder), language=language)
    student.write()
    while student.next is not None and student.next != student.chosen(exercise):
        student.finish(student.next)
    return folder


@contextmanager
def started(folder: Path, *words: str) -> Iterator[str]:
    """Run a command that serves the page; the address of the page."""
    with free_domain() as domain:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", "robolink", *words],
            env=dict(os.environ, ROS_DOMAIN_ID=str(domain), DISPLAY="", BROWSER="true"),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            cwd=folder,
        )
        try:
            assert process.stdout is not None
            yield next(word for line in process.stdout for word in line.split() if word.startswith("http://"))
        finally:
            process.terminate()
            process.communicate(timeout=20)


def take_exercise(browser: Browser, address: str, requested: argparse.Namespace) -> None:
    """Open the page, let it play the path of the check to its end, and take a picture."""
    remember(browser, requested, {})
    browser.open(address)
    film = "robolink.layout?.panel('learn')?.film"
    browser.wait(f"globalThis.robolink && {film}?.end && {film}.at == {film}.end && !{film}.changed")
    browser.screenshot(requested.file)


def take(browser: Browser, address: str, requested: argparse.Namespace) -> None:
    """Open the page as somebody left it, let the robot drive, and take a picture."""
    remember(browser, requested, {"layout": LAYOUT})
    browser.open(address)
    browser.wait("globalThis.robolink?.layout?.isReady && robolink.topics.get('/cmd_vel')?.view")
    for branch in ("linear", "angular"):
        browser.click(f".tree [data-path={branch}]")
    browser.move((640.0, 18.0))
    time.sleep(requested.seconds)
    browser.screenshot(requested.file)


def remember(browser: Browser, requested: argparse.Namespace, remembered: CELL) -> None:
    """Fill the browser's memory before the page is opened."""
    remembered["settings"] = {"theme": requested.theme, "language": requested.language}
    source = "".join(
        f"localStorage.setItem('robolink.{name}', {json.dumps(json.dumps(value))});"
        for name, value in remembered.items()
    )
    browser.call("Page.addScriptToEvaluateOnNewDocument", source=source)


if __name__ == "__main__":
    main()
