"""Generator of the manual's picture of turtlesim: turtles that have drawn, in headless Chromium.

Usage: python tools/turtlesim_picture.py docs/pictures/turtlesim.png
"""

from __future__ import annotations

import argparse
import colorsys
import math
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from robolink import Context, Node  # noqa: E402
from robolink.interfaces.turtlesim.srv import SetPen, Spawn, TeleportAbsolute  # noqa: E402
from tests.support.browser import Browser, chromium  # noqa: E402
from tests.support.domains import free_domain  # noqa: E402

MIDDLE, RADIUS, PETALS = 5.54, 3.6, 7
"""Place and size of the flower, in metres, and its petals."""
POINTS = 140


def main() -> None:
    """Take the picture that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    options = parser.parse_args()
    if chromium is None:
        sys.exit("chromium is not installed: apt-get install chromium")
    with free_domain() as domain, started(domain) as address, Browser(1100, 620) as browser:
        draw(domain)
        browser.open(address)
        browser.wait("document.querySelector('canvas.image')?.width == 500 && robolink.connection.services.size > 10")
        browser.choose(".panel-services .picker", "/turtle1/set_pen")
        browser.move((500.0, 18.0))
        time.sleep(0.5)
        browser.screenshot(options.file)
        if browser.problems:
            sys.exit(f"the page's console: {browser.problems[:3]}")


@contextmanager
def started(domain: int) -> Iterator[str]:
    """Run turtlesim; the address of its page."""
    command = [sys.executable, "-m", "robolink", "run", "turtlesim", "turtlesim_node"]
    environ = dict(os.environ, ROS_DOMAIN_ID=str(domain), DISPLAY="")
    with subprocess.Popen(command, env=environ, stdout=subprocess.PIPE, text=True, cwd=ROOT) as process:
        try:
            assert process.stdout is not None
            yield next(word for line in process.stdout for word in line.split() if word.startswith("http://"))
        finally:
            process.terminate()


def draw(domain: int) -> None:
    """Draw a flower with turtle1, and let other turtles look on."""
    context = Context()
    context.init(args=[], domain_id=domain)
    with context:
        node = Node("painter", context=context)
        ask(node, SetPen, "turtle1/set_pen", off=1)
        for count in range(POINTS + 1):
            angle = math.tau * count / POINTS
            far = RADIUS * abs(math.cos(PETALS * angle / 2)) + 0.4
            x, y = MIDDLE + far * math.cos(angle), MIDDLE + far * math.sin(angle)
            ask(node, TeleportAbsolute, "turtle1/teleport_absolute", x=x, y=y, theta=angle + 2.0)
            time.sleep(0.02)  # a step of the turtle: of several jumps in one all are drawn with the newest pen
            r, g, b = (round(255 * each) for each in colorsys.hls_to_rgb(count / POINTS, 0.72, 1.0))
            ask(node, SetPen, "turtle1/set_pen", r=r, g=g, b=b, width=5)
        for place in ((1.2, 1.2, 0.8), (9.9, 1.2, 2.3), (1.2, 9.9, -0.8)):
            ask(node, Spawn, "spawn", **dict(zip(("x", "y", "theta"), place, strict=True)))


def ask(node: Node, kind: Any, name: str, **fields: Any) -> None:
    """Call a service of turtlesim."""
    client = node.create_client(kind, name)
    assert client.wait_for_service(10.0), f"{name} is not there"
    assert client.call(kind.Request(**fields), timeout_sec=10.0) is not None
    node.destroy_client(client)


if __name__ == "__main__":
    main()
