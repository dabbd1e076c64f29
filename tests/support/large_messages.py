"""Large messages between processes whose memory is short, that stand still or are started again: nothing may be wrong.

    python -m tests.support.large_messages [--freezes 10] [--restarts 60] [--floods 5] [SCENE ...]

plays the scenes and says what was sent, received, lost and wrong, and how much memory the receiver has. It ends with 1
if anything was wrong, or missing without having been counted.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from functools import partial
from typing import Any, NamedTuple

from robolink.transport.shared_memory import MOST_POOLS, VARIABLE, decide, this_machine
from tests.support.commands import PATIENCE
from tests.support.domains import free_domain
from tests.support.obedient import ROOT, line, start, tell
from tests.support.ports import free_port

LITTLE = 8 * 2**20
"""Usual limit of locked memory, in bytes."""

Plan = Mapping[str, Any]


class Counted(NamedTuple):
    """Deliveries of one receiver."""

    sent: int
    """Messages of its publishers, from the first of each that it received to the last."""
    received: int
    wrong: int
    """Those whose content was another message's."""
    told: int
    """Those that message-lost events have counted."""
    lost: int
    dropped: int
    locked: int
    """Locked memory of the process, in kB."""
    resident: int
    limited: int
    """1 once it has said that it takes no more memory of new publishers, else 0."""

    @property
    def fine(self) -> bool:
        """True if nothing was wrong, and all that is missing was counted."""
        return not self.wrong and self.sent > 0 and self.received + self.told == self.sent


class Ends:
    """Processes of tests.support.large_end on a domain of their own."""

    def __init__(self, stack: ExitStack, environ: Mapping[str, str]) -> None:
        self._stack = stack
        self._environ = {**os.environ, "ROS_DOMAIN_ID": str(stack.enter_context(free_domain())), **environ}

    def start(self, role: str, *options: str, prefix: Sequence[str] = ()) -> subprocess.Popen[str]:
        """Start one."""
        command = [*prefix, sys.executable, "-m", "tests.support.large_end", role, *options]
        return start(self._stack, command, self._environ)


def count(process: subprocess.Popen[str]) -> Counted:
    """Return what a receiver was delivered so far, once nothing comes any more."""
    found: dict[str, int] = {}
    while True:
        before, found = found, report(process)
        if found["received"] == before.get("received", -1):
            break
        time.sleep(0.3)
    return Counted(**{name: found[name] for name in Counted._fields})


def report(process: subprocess.Popen[str]) -> dict[str, int]:
    """Return what a receiver has counted so far."""
    tell(process, "report")
    found: dict[str, int] = json.loads(line(process))
    return found


def freeze(
    *,
    kind: str = "depth",
    freezes: int = 10,
    seconds: float = 1.0,
    busy: float = 0.005,
    size: int = 1_000_000,
    unchecked: bool = False,
    until_wrong: bool = False,
) -> Counted:
    """Stop a receiver again and again under a flood, and then let one message end it.

    A second receiver goes on, so that the publisher does, and soon uses the memory of the first one's messages again.
    """
    if sys.platform == "win32":
        raise RuntimeError("Windows has no SIGSTOP: nothing can be stopped")
    with ExitStack() as stack:
        ends = Ends(stack, {VARIABLE: "on"})
        options = ("--kind", kind, "--bytes", str(size))
        receiver = ends.start("receive", *options, "--busy", str(busy), *(["--unchecked"] if unchecked else []))
        other = ends.start("receive", *options)
        assert [line(receiver), line(other)] == ["ready", "ready"]
        publisher = ends.start("publish", *options, "--receivers", "2")
        assert line(publisher) == "ready"
        for _ in range(freezes):
            tell(publisher, "0")
            time.sleep(0.5)
            receiver.send_signal(signal.SIGSTOP)
            time.sleep(seconds)
            tell(publisher, "1")  # ends the flood, before what waits is driven out by newer ones
            assert line(publisher)
            assert line(publisher)
            receiver.send_signal(signal.SIGCONT)
            count(receiver)
            tell(publisher, "1")  # is sure to come, so that what is missing before it shows
            assert line(publisher)
            found = count(receiver)
            if until_wrong and found.wrong:
                break
        return found


class Flood:
    """A flood to receivers, which goes on for as long as the object is in use, whoever of its ends goes or comes.

    Args:
        stack: Ends the processes.
        kind: Kind of the ends, of `large_end.PROFILES`.
        size: Size of a message, in bytes.
        publishers: Number of publishers of each process that sends: each has a thread of its own.
        receivers: Number of receivers that are there from the beginning.
    """

    def __init__(
        self, stack: ExitStack, *, kind: str = "depth", size: int = 1_000_000, publishers: int = 1, receivers: int = 2
    ) -> None:
        self._ends, self._options = Ends(stack, {}), ("--kind", kind, "--bytes", str(size))
        self._publishers = publishers
        self.receivers = [self._ends.start("receive", *self._options) for _ in range(receivers)]
        assert [line(each) for each in self.receivers] == ["ready"] * receivers
        self.begin(receivers)

    def begin(self, receivers: int = 1) -> None:
        """Start the process that sends; it begins when it knows of so many receivers."""
        counts = ("--receivers", str(receivers), "--publishers", str(self._publishers))
        self.sender = self._ends.start("publish", *self._options, *counts)
        assert line(self.sender) == "ready"
        tell(self.sender, "0")

    def join(self, *options: str, is_counted: bool = True) -> None:
        """Start another receiver."""
        receiver = self._ends.start("receive", *self._options, *options)
        assert line(receiver) == "ready"
        if is_counted:
            self.receivers.append(receiver)

    def freeze(self, *ends: subprocess.Popen[str], seconds: float = 0.35) -> None:
        """Let some of the processes stand still, long enough for Zenoh to use their memory again."""
        if sys.platform == "win32":
            raise RuntimeError("Windows has no SIGSTOP: nothing can be stopped")
        for each in ends:
            each.send_signal(signal.SIGSTOP)
        time.sleep(seconds)
        for each in ends:
            each.send_signal(signal.SIGCONT)

    def end(self) -> list[Counted]:
        """End the flood; return what each of the receivers has counted."""
        tell(self.sender, "1")
        assert [line(self.sender) for _ in "01"]  # the flood's end, and this one's
        count(self.receivers[0])
        tell(self.sender, "1")  # what is missing before the last shows when another one comes
        assert line(self.sender)
        return [count(each) for each in self.receivers]


def flood(*, times: int = 1, seconds: float = 1.0, **options: Any) -> list[Counted]:
    """Play some floods that nothing disturbs; returns what the receivers of all of them have counted."""
    found: list[Counted] = []
    for _ in range(times):
        with ExitStack() as stack:
            played = Flood(stack, **options)
            time.sleep(seconds)
            found += played.end()
    return found


def disturb(*, times: int = 1, seconds: float = 0.3, **options: Any) -> list[Counted]:
    """Play a flood whose ends stand still, are killed and come late, one after the other, while one never reads."""
    with ExitStack() as stack:
        played = Flood(stack, receivers=3, publishers=3, **options)
        played.join("--idle", is_counted=False)
        for _ in range(times):
            time.sleep(seconds)
            played.freeze(played.sender, played.receivers[0])
            time.sleep(seconds)
            for killed in (played.receivers.pop(), played.sender):
                killed.kill()
                killed.wait()
            played.begin()
            played.join()
            time.sleep(seconds)
        return played.end()


def pass_on(
    *,
    kind: str = "depth",
    messages: int = 40,
    size: int = 1_000_000,
    publishers: Sequence[str] = (),
    receivers: Sequence[Sequence[str]] = ((),),
    environ: Mapping[str, str] | None = None,
    latched_first: bool = False,
) -> list[Counted]:
    """Send some messages at 50 Hz to receivers, each started with its prefix."""
    with ExitStack() as stack:
        ends = Ends(stack, environ or {})
        options = ("--kind", kind, "--bytes", str(size))
        there = [ends.start("receive", *options, prefix=prefix) for prefix in receivers]
        assert [line(each) for each in there] == ["ready"] * len(there)
        publisher = ends.start("publish", *options, "--receivers", str(len(there)), prefix=publishers)
        assert line(publisher) == "ready"
        tell(publisher, str(messages))
        line(publisher)
        return [count(each)._replace(sent=messages) for each in there]


def join_late(*, size: int = 1_000_000, prefix: Sequence[str] = ()) -> list[Counted]:
    """Start a receiver after ten latched messages were sent."""
    with ExitStack() as stack:
        ends = Ends(stack, {})
        options = ("--kind", "latched", "--bytes", str(size))
        publisher = ends.start("publish", *options, "--receivers", "0")
        assert line(publisher) == "ready"
        tell(publisher, "15")
        line(publisher)
        receiver = ends.start("receive", *options, prefix=prefix)
        assert line(receiver) == "ready"
        tell(publisher, "15")
        line(publisher)
        return [count(receiver)]


class Restarts:
    """A receiver, and publishers of `messages` messages each that are started and killed one after the other.

    With `shares` a publisher sends as many more until the receiver has its memory, or takes none of new ones any more:
    a publisher's first messages go by TCP until its memory is there, and on a busy machine that takes a while.
    """

    def __init__(
        self,
        stack: ExitStack,
        *,
        messages: int = 5,
        size: int = 1_000_000,
        pools: int = MOST_POOLS,
        environ: Mapping[str, str] | None = None,
    ) -> None:
        self._ends, self._messages, self._size = Ends(stack, environ or {}), messages, size
        self._receiver = self._ends.start("receive", "--bytes", str(size), "--pools", str(pools))
        assert line(self._receiver) == "ready"
        self.sent = 0

    def play(self, times: int, *, shares: bool = False) -> Counted:
        """Start so many publishers; return what the receiver has of all so far."""
        for _ in range(times):
            before = report(self._receiver)["locked"]
            publisher = self._ends.start("publish", "--bytes", str(self._size))
            assert line(publisher) == "ready"
            self._send(publisher)
            deadline = time.monotonic() + PATIENCE
            while shares and not self._has_more_than(before):
                assert time.monotonic() < deadline, "the receiver does not get the publisher's memory"
                self._send(publisher)
            publisher.kill()
            publisher.wait()
        return count(self._receiver)._replace(sent=self.sent)

    def _send(self, publisher: subprocess.Popen[str]) -> None:
        tell(publisher, str(self._messages))
        line(publisher)
        self.sent += self._messages

    def _has_more_than(self, locked: int) -> bool:
        found = report(self._receiver)
        return bool(found["limited"]) or found["locked"] - locked > self._size // 1000


def restart(*, times: int, size: int = 1_000_000, environ: Mapping[str, str]) -> list[Counted]:
    """Start publishers one after the other for one receiver; returns its counts after ten each."""
    with ExitStack() as stack:
        restarts = Restarts(stack, size=size, environ=environ)
        return [restarts.play(10) for _ in range(times // 10)]


ROUTER = """
import sys, json, zenoh
shares = json.loads(sys.argv[2])
config = zenoh.Config.from_json5(json.dumps({
    "mode": "router",
    "listen": {"endpoints": ["tcp/127.0.0.1:" + sys.argv[1]]},
    "scouting": {"multicast": {"enabled": False}},
    "transport": {"shared_memory": {"enabled": shares}},
}))
session = zenoh.open(config)
print("ready", flush=True)
sys.stdin.read()
"""


def route(*, shares: bool, prefix: Sequence[str] = (), choice: str = "auto", **options: Any) -> list[Counted]:
    """Pass messages through a router, started with its prefix, that shares memory or does not."""
    port = free_port()
    command = [*prefix, sys.executable, "-c", ROUTER, str(port), json.dumps(shares)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as router:
        try:
            assert line(router) == "ready"
            return pass_on(environ={"ROBOLINK_NETWORK": f"tcp/127.0.0.1:{port}", VARIABLE: choice}, **options)
        finally:
            router.kill()


# What a process may have


def no_room() -> str:
    """Return why no process here may share memory safely, or nothing if one may."""
    found = decide(this_machine())
    return "" if found.on else found.reason


def tight() -> list[str]:
    """Return the prefix of a command that may lock but 8 MB, whatever this process may."""
    if sys.platform == "win32":
        raise RuntimeError("Windows has no such limit")
    capability = ["setpriv", "--bounding-set", "-ipc_lock", "--inh-caps", "-ipc_lock"]
    return [*(capability if os.geteuid() == 0 and shutil.which("setpriv") else []), "prlimit", f"--memlock={LITTLE}"]


def in_little_space(command: Sequence[str], size: str = "8m") -> list[str]:
    """Return a command that runs another one with a small /dev/shm of its own."""
    mount = f'mount -t tmpfs -o size={size} tmpfs /dev/shm && exec "$@"'
    return ["unshare", "--mount", "sh", "-c", mount, "sh", *command]


def little_space() -> list[Counted]:
    """Pass messages within a /dev/shm of 8 MB, where another program uses 2 MB: it must go on."""
    neighbour = "import mmap,sys; f=open('/dev/shm/other','w+b'); f.truncate(2**21); m=mmap.mmap(f.fileno(),2**21)\n"
    neighbour += "for _ in sys.stdin:\n    m[:]=bytes(2**21); print('alive',flush=True)"
    scene = f"""
import json, subprocess, sys
from tests.support.large_messages import pass_on
from tests.support.commands import PATIENCE
from tests.support.obedient import line, tell
other = subprocess.Popen([sys.executable, "-c", {neighbour!r}], stdin=-1, stdout=-1, text=True)
tell(other, "go"), line(other)
found = pass_on(receivers=[(), ()])
tell(other, "go")
assert line(other) == "alive", "the other program was harmed"
other.kill()
print(json.dumps(found))
"""
    done = subprocess.run(
        in_little_space([sys.executable, "-c", scene]), cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True
    )
    return [Counted(*each) for each in json.loads(done.stdout)]


def scenes(freezes: int, restarts: int, floods: int) -> dict[str, Callable[[], list[Counted]]]:
    """Return all scenes by name."""
    low: tuple[str, ...] = tuple(tight())
    found: dict[str, Callable[[], list[Counted]]] = {
        f"freeze-{kind}": partial(_one, freeze, kind=kind, freezes=freezes) for kind in ("depth", "all", "latched")
    }
    found |= {
        "memlock-none": pass_on,
        "memlock-receiver": partial(pass_on, receivers=[low]),
        "memlock-publisher": partial(pass_on, publishers=low),
        "memlock-both": partial(pass_on, publishers=low, receivers=[low]),
        "several": partial(pass_on, receivers=[(), low, ()]),
        "several-images": partial(pass_on, receivers=[(), (), ()], size=6_200_000),
        "latched": partial(pass_on, kind="latched", receivers=[(), low]),
        "late": join_late,
        "late-memlock": partial(join_late, prefix=low),
        "router-shares": partial(route, shares=True, receivers=[(), low]),
        "router-on": partial(route, shares=True, choice="on", receivers=[(), ()]),
        "router-memlock": partial(route, shares=True, prefix=low),
        "router-alone": partial(route, shares=False, receivers=[(), ()]),
        "space": little_space,
        "flood": partial(flood, times=floods, seconds=2.0),
        "flood-images": partial(flood, times=floods, seconds=2.0, size=6_200_000),
        "flood-several": partial(flood, times=floods, publishers=3, receivers=3),
        "disturbed": partial(disturb, times=floods),
        "disturbed-all": partial(disturb, times=1, kind="all"),
        "disturbed-images": partial(disturb, times=floods, size=6_200_000),
        "restarts": partial(restart, times=restarts, environ={}),
        "restarts-images": partial(restart, times=restarts // 2, size=6_200_000, environ={}),
        "restarts-without": partial(restart, times=restarts, environ={VARIABLE: "off"}),
    }
    return found


def _one(action: Callable[..., Counted], **options: Any) -> list[Counted]:
    return [action(**options)]


def main() -> int:
    """Play scenes and print their figures; 1 if anything was wrong."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--freezes", type=int, default=10)
    parser.add_argument("--restarts", type=int, default=60)
    parser.add_argument("--floods", type=int, default=5)
    parser.add_argument("scenes", nargs="*")
    asked = parser.parse_args()
    print(f"shared memory: {no_room() or 'there is room'}")  # noqa: T201
    known, bad = scenes(asked.freezes, asked.restarts, asked.floods), 0
    for name in asked.scenes or known:
        for each in known[name]():
            bad += not each.fine
            figures = " ".join(f"{field} {value:6}" for field, value in each._asdict().items())
            print(f"{name:18} {figures}{'' if each.fine else '  <- WRONG'}", flush=True)  # noqa: T201
    return bool(bad)


if __name__ == "__main__":
    raise SystemExit(main())
