"""Remote-controlled processes that talk over DDS or beside a bridge: `programs/peer.py` by a real rclpy or robolink."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import subprocess
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

PATIENCE = 20.0
"""How long, in seconds, anything may take that has no limit of its own."""


def until(condition: Callable[[], Any], what: str, seconds: float = PATIENCE) -> Any:
    """Return the first true value of a condition. Raises AssertionError with its last value after so many seconds."""
    end = time.monotonic() + seconds
    while not (value := condition()):
        assert time.monotonic() < end, f"after {seconds:g} s not yet: {what}: {value}"
        time.sleep(0.005)
    return value


class Peer:
    """A running process that does what it is asked to."""

    def __init__(
        self, command: Sequence[str], name: str, environ: dict[str, str], folder: Path, program: str = "peer.py"
    ) -> None:
        self.name = name
        """Its node is /lab/NAME."""
        self.started = time.monotonic()
        self._process = subprocess.Popen(
            [*command, str(folder / program), name],
            env=environ,
            cwd=folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            start_new_session=True,
        )
        self._changed = threading.Condition()
        self._answers: dict[int, dict[str, Any]] = {}
        self._events: list[dict[str, Any]] = []
        self._numbers = itertools.count(1)
        self.errors: list[str] = []
        self._threads = [threading.Thread(target=each, daemon=True) for each in (self._follow, self._follow_errors)]
        for thread in self._threads:
            thread.start()

    @property
    def pid(self) -> int:
        return self._process.pid

    def _follow(self) -> None:
        assert self._process.stdout
        for line in self._process.stdout:
            if not line.startswith("{") or not line.endswith("\n"):
                continue  # what a library prints, or half a line of one that was killed
            said = json.loads(line)
            with self._changed:
                if "id" in said:
                    self._answers[said["id"]] = said
                else:
                    self._events.append(said)
                self._changed.notify_all()

    def _follow_errors(self) -> None:
        assert self._process.stderr
        self.errors += map(str.rstrip, self._process.stderr)

    def start(self, do: str, **arguments: Any) -> int:
        """Request something; the number is for `answer`."""
        number = next(self._numbers)
        assert self._process.stdin
        try:
            self._process.stdin.write(json.dumps({"id": number, "do": do, **arguments}) + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            raise AssertionError(f"{self.name} has ended: {self.errors[-20:]}") from None
        return number

    def answer(self, number: int, seconds: float = PATIENCE) -> Any:
        self._wait(lambda: number in self._answers, seconds, lambda: f"an answer to request {number}")
        said = self._answers.pop(number)
        assert "error" not in said, f"{self.name}: {said['error']}: {self.errors[-20:]}"
        return said["value"]

    def ask(self, do: str, *, within: float = PATIENCE, **arguments: Any) -> Any:
        """Request something, and return the answer: a method of the program's Peer."""
        return self.answer(self.start(do, **arguments), within)

    def events(self, event: str) -> list[dict[str, Any]]:
        """Return all of this name so far."""
        with self._changed:
            return [each for each in self._events if each["event"] == event]

    def wait(self, event: str, count: int = 1, seconds: float = PATIENCE, **fields: Any) -> list[dict[str, Any]]:
        """Wait for so many of this name with these fields; return all of them so far."""

        def found() -> list[dict[str, Any]]:
            return [each for each in self.events(event) if fields.items() <= each.items()]

        def what() -> str:
            return f"{count} of '{event}' {fields or ''}, but {len(found())}, the last of them {found()[-1:]}"

        self._wait(lambda: len(found()) >= count, seconds, what)
        return found()

    def _wait(self, condition: Callable[[], bool], seconds: float, what: Callable[[], str]) -> None:
        end = time.monotonic() + seconds
        while not condition():
            left = end - time.monotonic()
            assert self._process.poll() is None, f"{self.name} has ended: {self.errors[-20:]}"
            assert left > 0, f"{self.name} has not given, in {seconds:g} s, {what()}; it says {self.errors[-20:]}"
            with self._changed:
                self._changed.wait(min(left, 0.05))

    def ready(self) -> Peer:
        """Wait until its node is there."""
        self.wait("ready")
        return self

    def kill(self) -> None:
        """End it as kill -9 does."""
        self._process.kill()
        self._process.wait(PATIENCE)

    def close(self) -> None:
        """Let it end by itself: it says goodbye to the others."""
        assert self._process.stdin
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        try:
            self._process.wait(5.0)
        except subprocess.TimeoutExpired:
            self.kill()
        for thread in self._threads:
            thread.join(PATIENCE)
        for stream in (self._process.stdout, self._process.stderr):
            assert stream
            stream.close()

    def __enter__(self) -> Peer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def meet(sender: Peer, receiver: Peer, topic: str, heard: str = "") -> None:
    """Wait until the sender knows a subscription of a topic, and the receiver a publisher of it, or of another one."""
    heard = heard or topic
    until(lambda: sender.ask("matched", topic=topic)[0], f"{sender.name} sees a subscription of {topic}")
    until(lambda: receiver.ask("matched", topic=heard)[1], f"{receiver.name} sees a publisher of {heard}")


def environment(domain: int, **more: str) -> dict[str, str]:
    """Return the environment of a process: this one's, on a domain, on this machine only."""
    own = {
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "PYTHONUNBUFFERED": "1",
        "NO_COLOR": "1",
    }
    return {**os.environ, **own, **more}
