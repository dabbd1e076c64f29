"""Generator of the pictures of the page: each kind of system as it opens, in both themes, on a screen and on a phone.

Usage: python tools/page_pictures.py FOLDER [SCENE ...] [--theme dark] [--size 1440x900] [--seconds 12]

The scenes are systems that are launched (wander, track, blobs, signs, fleet, navigate), a bag, an exercise, the system
of the learn page localize, and nothing at all. The pictures of the manual are made from the same scenes: `--manual`
writes view.png, exercises.png, localize.png and go_there.png into a folder, which is docs/pictures.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from robolink.learn.folder import start_folder  # noqa: E402
from tests.support.browser import Browser, chromium  # noqa: E402
from tests.support.domains import free_domain  # noqa: E402
from tools.docs_site.pictures import write_files_of  # noqa: E402

THEMES = ("dark", "light")
SIZES = {"1440x900": (1440, 900), "390x844": (390, 844)}
PHONE = 700
"""Width in pixels below which the page is a phone's."""

FILM = "robolink.layout?.panel('learn')?.film"

GOAL = """(() => { const world = robolink.layout.panel('world');
world._use('goal'); world.scene.wanted = { x: 6.0, y: 1.5, yaw: -1.57 }; world._send(); })()"""
"""JavaScript that sends a robot of the office into a room, as a click does."""


def main() -> None:
    """Take the pictures that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"{', '.join(SCENES)}; default: all")
    parser.add_argument("--theme", choices=THEMES)
    parser.add_argument("--size", choices=SIZES)
    parser.add_argument("--seconds", type=float, default=12.0, help="seconds that a robot drives before its picture")
    parser.add_argument("--manual", action="store_true", help="write the pictures of the manual below FOLDER")
    options = parser.parse_args()
    if unknown := [each for each in options.scenes if each not in SCENES]:
        parser.error(f"no scene '{unknown[0]}': {', '.join(SCENES)}")
    if chromium is None:
        sys.exit("chromium is not installed: apt-get install chromium")
    with Browser() as browser:
        if options.manual:
            take(browser, options.folder, "wander", {"view": (1280, 720)}, ("dark",), 30.0, named="{size}")
            take(browser, options.folder, "learn", {"exercises": (1280, 640)}, ("light",), 0.0, named="{size}")
            take(browser, options.folder, "localize", {"localize": (900, 600)}, ("light",), 3.0, named="{size}")
            take(browser, options.folder, "navigate", {"go_there": (900, 600)}, ("light",), 8.0, named="{size}")
            return
        sizes = {options.size: SIZES[options.size]} if options.size else SIZES
        themes = (options.theme,) if options.theme else THEMES
        for scene in options.scenes or SCENES:
            take(browser, options.folder, scene, sizes, themes, options.seconds)


def take(
    browser: Browser,
    folder: Path,
    scene: str,
    sizes: dict[str, tuple[int, int]],
    themes: tuple[str, ...],
    seconds: float,
    named: str = "{scene}-{size}-{theme}",
) -> None:
    """Begin a scene, and take its picture in each size and theme, as the page opens for somebody who is new.

    Args:
        browser: Where.
        folder: Where the pictures go.
        scene: Name of a scene.
        sizes: Width and height in pixels by name.
        themes: Themes.
        seconds: Time for which each picture waits after the page has opened.
        named: Name of a picture's file.
    """
    with SCENES[scene]() as address:
        for size, (width, height) in sizes.items():
            browser.resize(width, height, phone=width < PHONE)
            for theme in themes:
                remember(browser, {"settings": {"theme": theme, "language": "en"}})
                browser.open(address)
                browser.wait("globalThis.robolink?.connection.isOpen && robolink.layout?.isReady", 60.0)
                if scene == "learn":
                    browser.wait(f"{FILM}?.end && {FILM}.at == {FILM}.end && !{FILM}.changed", 60.0)
                if scene == "navigate":
                    browser.js(GOAL)
                time.sleep(seconds)
                file = browser.screenshot(folder / f"{named.format(scene=scene, size=size, theme=theme)}.png")
                sys.stdout.write(f"{file} {' '.join(browser.problems[:3])}\n")
                browser.problems.clear()
        browser.open("about:blank")  # a page that is left open would look for its server


def remember(browser: Browser, remembered: dict[str, object]) -> None:
    """Replace the browser's memory of the page that is opened next."""
    stored = "".join(
        f"localStorage.setItem('robolink.{name}', {json.dumps(json.dumps(value))});"
        for name, value in remembered.items()
    )
    source = f"if (location.host) {{ localStorage.clear(); {stored} }}"  # about:blank has no memory
    added = browser.call("Page.addScriptToEvaluateOnNewDocument", source=source)["identifier"]
    if before := getattr(browser, "remembered_", None):
        browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=before)
    browser.remembered_ = added  # type: ignore[attr-defined]


@contextmanager
def started(folder: Path, *words: str, then: tuple[str, ...] = (), after: float = 0.0) -> Iterator[str]:
    """Run a command that serves the page, and after some seconds another one that ends; the address of the page."""
    with free_domain() as domain:
        environ = dict(os.environ, ROS_DOMAIN_ID=str(domain), DISPLAY="", BROWSER="true")
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", "robolink", *words],
            env=environ,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            text=True,
            cwd=folder,
        )
        try:
            assert process.stdout is not None
            address = next(word for line in process.stdout for word in line.split() if word.startswith("http://"))
            if then:
                time.sleep(after)
                command = [sys.executable, "-P", "-m", "robolink", *then]
                subprocess.run(command, env=environ, cwd=folder, check=True, capture_output=True)
            yield address
        finally:
            process.terminate()
            process.communicate(timeout=30)


def launched(name: str) -> Callable[[], AbstractContextManager[str]]:
    """A scene of a launch file."""
    return lambda: started(ROOT, "launch", name, "--view")


@contextmanager
def bag() -> Iterator[str]:
    """A scene of a bag: twenty seconds of a robot that follows a wall."""
    with tempfile.TemporaryDirectory() as scratch:
        bag = Path(scratch) / "lap"
        words = ("simulate", "follow", "--duration", "20", "--record", str(bag))
        subprocess.run([sys.executable, "-P", "-m", "robolink", *words], cwd=ROOT, check=True, capture_output=True)
        with started(ROOT, "view", "--no-browser", "--port", "0", "--bag", str(bag)) as address:
            yield address


@contextmanager
def learn() -> Iterator[str]:
    """A scene of an exercise as it is given."""
    with tempfile.TemporaryDirectory() as scratch:
        student = start_folder(scratch, language="en")
        student.write()
        while student.next is not None and student.next != student.chosen("stop"):
            student.finish(student.next)
        with started(Path(scratch), "learn", "view", "--no-browser", "--port", "0") as address:
            yield address


@contextmanager
def navigate() -> Iterator[str]:
    """A scene of a robot that is ready to be sent through an office."""
    ready = ("lifecycle", "get", "/waypoint_follower")
    with started(ROOT, "launch", "navigate", "--view", then=ready, after=12.0) as address:
        yield f"{address}#world"


@contextmanager
def localize() -> Iterator[str]:
    """A scene of a robot that does not know where it is, some seconds after it has begun to guess."""
    with tempfile.TemporaryDirectory() as scratch:
        write_files_of("learn/localize.md", Path(scratch))
        subprocess.run([sys.executable, "draw_map.py"], cwd=scratch, check=True)
        words = ("launch", "localize.yaml", "--view")
        guess = ("service", "call", "/reinitialize_global_localization")
        with started(Path(scratch), *words, then=guess, after=10.0) as address:
            yield f"{address}#world"


SCENES: dict[str, Callable[[], AbstractContextManager[str]]] = {
    **{name: launched(name) for name in ("wander", "track", "blobs", "signs", "fleet")},
    "navigate": navigate,
    "bag": bag,
    "learn": learn,
    "localize": localize,
    "empty": lambda: started(ROOT, "view", "--no-browser", "--port", "0"),
}
"""Scenes by name: each gives the address of a page."""

if __name__ == "__main__":
    main()
