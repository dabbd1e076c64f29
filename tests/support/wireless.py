"""Wireless network between two network namespaces: frames are late, lost and slow, by a relay in this program.

    with wireless(Air(loss=0.01)) as link: ...          # link.robot and link.laptop are namespaces, with `wlan0` each

The kernel's `tc tbf` makes them slow, so that programs feel it as they do with a driver: a full socket waits. The relay
makes them late and loses some; as on Wi-Fi, their order stays. (`tc netem` would do the same; many kernels have none.)
It is a process, `python -m tests.support.wireless ROBOT LAPTOP '{"loss": 0.01}'`, which says `ready`, and for each line
of its standard input what has passed since the last. Linux, root.
"""

from __future__ import annotations

import contextlib
import json
import os
import random
import select
import shutil
import subprocess
import sys
import time
from collections import deque
from collections.abc import Iterator
from contextlib import ExitStack
from typing import NamedTuple

from tests.support import stalls
from tests.support.obedient import line, start, tell

INTERFACE = "wlan0"
ROBOT, LAPTOP = "10.79.0.1", "10.79.0.2"

_TUN = "/dev/net/tun"
_MAKE_INTERFACE = 0x400454CA
"""The ioctl TUNSETIFF."""
_ETHERNET, _BARE = 0x0002, 0x1000
"""IFF_TAP and IFF_NO_PI: whole frames and nothing before them."""
_LONGEST = 2048
_WAITING = 1_500_000
"""Bytes that wait for the air in one direction at most: a thousand frames, as is usual."""


class Air(NamedTuple):
    """What the network does to a frame."""

    delay: float = 0.003
    """Seconds."""
    jitter: float = 0.002
    """Seconds that it takes more or less, evenly spread."""
    loss: float = 0.01
    """Share of the frames."""
    megabits: float = 30.0
    """A second, in each direction."""
    seed: int = 1


class Passed(NamedTuple):
    """Frames of both directions since the last question."""

    frames: int
    bytes: int
    lost: int


class Link(NamedTuple):
    """Two namespaces and the process between them."""

    robot: str
    laptop: str
    relay: subprocess.Popen[str]

    def passed(self) -> Passed:
        """Return what has passed since the last question."""
        tell(self.relay, "")
        return Passed(*json.loads(line(self.relay)))


def missing() -> str:
    """The reason why there is no wireless network on this machine; '' if there is."""
    return stalls.no_hosts() or _no_relay()


def _no_relay() -> str:
    if not shutil.which("tc"):
        return "there is no `tc`"
    return "" if os.access(_TUN, os.R_OK | os.W_OK) else f"no {_TUN} that this user may open"


@contextlib.contextmanager
def wireless(air: Air | None = None) -> Iterator[Link]:
    """Make two network namespaces with a wireless network between them."""
    names = [f"robolink-{os.getpid()}-{side}" for side in ("robot", "laptop")]
    with ExitStack() as stack:
        for name in names:
            _ip("netns", "add", name)
            stack.callback(_ip, "netns", "delete", name)
            _ip("-netns", name, "link", "set", "lo", "up")
        air = air or Air()
        command = [sys.executable, "-m", "tests.support.wireless", *names, json.dumps(air._asdict())]
        relay = start(stack, command, os.environ)
        assert line(relay) == "ready"
        slow = f"tbf rate {air.megabits}mbit burst 4kb limit {_WAITING}".split()
        for name, address, other in zip(names, (ROBOT, LAPTOP), (LAPTOP, ROBOT), strict=True):
            _ip("-netns", name, "address", "add", f"{address}/24", "dev", INTERFACE)
            _ip("-netns", name, "link", "set", INTERFACE, "up")
            _ip("-netns", name, "route", "add", "default", "via", other)  # multicast goes where the default route goes
            subprocess.run(["tc", "-netns", name, "qdisc", "add", "dev", INTERFACE, "root", *slow], check=True)
        yield Link(names[0], names[1], relay)


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)


class Medium:
    """Frames on their way between two ends; it knows no clock and no interface."""

    def __init__(self, air: Air) -> None:
        self._air, self._random = air, random.Random(air.seed)
        self._waiting: tuple[deque[tuple[float, bytes]], ...] = (deque(), deque())
        self.frames = self.bytes = self.lost = 0

    def put(self, now: float, end: int, frame: bytes) -> None:
        """Take a frame from one end, 0 or 1."""
        waiting, air = self._waiting[end], self._air
        self.frames += 1
        self.bytes += len(frame)
        if self._random.random() < air.loss:
            self.lost += 1
            return
        due = now + air.delay + self._random.uniform(-air.jitter, air.jitter)
        waiting.append((max(due, waiting[-1][0]) if waiting else due, frame))

    def due(self) -> float | None:
        """Return when the next frame arrives; None: there is none."""
        return min((waiting[0][0] for waiting in self._waiting if waiting), default=None)

    def take(self, now: float, end: int) -> Iterator[bytes]:
        """Yield the frames from one end that have arrived at the other."""
        waiting = self._waiting[end]
        while waiting and waiting[0][0] <= now:
            yield waiting.popleft()[1]

    def passed(self) -> Passed:
        """Return what has passed since the last question."""
        found = Passed(self.frames, self.bytes, self.lost)
        self.frames = self.bytes = self.lost = 0
        return found


def _end(namespace: str, number: int) -> int:
    """Make an interface in a namespace; returns what its frames are read from and written to."""
    if sys.platform == "win32":
        raise OSError("a wireless network needs network namespaces, which Linux has")
    import fcntl  # no other system has it, and this module is imported to say so

    made = f"rl{os.getpid()}.{number}"
    end = os.open(_TUN, os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(end, _MAKE_INTERFACE, made.encode().ljust(16, b"\0") + (_ETHERNET | _BARE).to_bytes(24, sys.byteorder))
    _ip("link", "set", made, "netns", namespace, "name", INTERFACE)
    return end


def _relay(ends: list[int], medium: Medium) -> None:
    """Pass frames on until standard input ends."""
    while True:
        due = medium.due()
        patience = None if due is None else max(0.0, due - time.monotonic())
        ready, _, _ = select.select([*ends, sys.stdin], [], [], patience)
        for number, end in enumerate(ends):
            if end in ready:
                for frame in _frames(end):
                    medium.put(time.monotonic(), number, frame)
            for frame in medium.take(time.monotonic(), number):
                with contextlib.suppress(OSError):  # the other end is not up yet, or full
                    os.write(ends[1 - number], frame)
        if sys.stdin in ready:
            if not sys.stdin.readline():
                return
            print(json.dumps(medium.passed()), flush=True)  # noqa: T201


def _frames(end: int) -> Iterator[bytes]:
    """Yield the frames that wait at an end."""
    with contextlib.suppress(BlockingIOError):
        while True:
            yield os.read(end, _LONGEST)


def main() -> None:
    """Relay between two namespaces."""
    robot, laptop, air = sys.argv[1:]
    ends = [_end(name, number) for number, name in enumerate((robot, laptop))]
    with contextlib.suppress(OSError):
        if sys.platform != "win32":
            os.nice(-10)  # what it adds on a busy machine would look like the air
    print("ready", flush=True)  # noqa: T201
    _relay(ends, Medium(Air(**json.loads(air))))


if __name__ == "__main__":
    main()
