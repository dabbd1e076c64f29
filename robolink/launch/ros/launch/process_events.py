"""Events of the processes of a launch (`launch.events.process`)."""

from __future__ import annotations

import signal
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from robolink.exceptions import nearest
from robolink.launch.ros.launch.bases import Action, Event, LaunchArgumentError
from robolink.system.terminal import shown

__all__ = [
    "ProcessExited",
    "ProcessIO",
    "ProcessStarted",
    "ProcessStderr",
    "ProcessStdin",
    "ProcessStdout",
    "ProcessTargetedEvent",
    "RunningProcessEvent",
    "ShutdownProcess",
    "SignalProcess",
    "matches_executable",
    "matches_name",
    "matches_pid",
]


class RunningProcessEvent(Event):
    """Something has happened to a process.

    Args:
        action: The action that started it.
        name: Its name.
        cmd: Its command line.
        cwd: Its working directory; None is the launcher's.
        env: Its environment; None is the launcher's.
        pid: Its process id.
    """

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self,
        *,
        action: Action,
        name: str,
        cmd: Sequence[str],
        cwd: str | None,
        env: Mapping[str, str] | None,
        pid: int,
    ) -> None:
        self.action = self.execute_process_action = action
        self.process_name, self.cmd, self.cwd, self.env, self.pid = name, list(cmd), cwd, env, pid


class ProcessStarted(RunningProcessEvent):
    """A process runs."""

    name = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    """A process has ended.

    Args:
        returncode: Its exit code, or -N for signal N.
        **kwargs: Those of RunningProcessEvent.
    """

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.returncode = returncode


class ProcessIO(RunningProcessEvent):
    """A process has written, or was written to.

    Args:
        text: The bytes.
        fd: 0 for standard input, 1 for output, 2 for errors.
        **kwargs: Those of RunningProcessEvent.
    """

    name = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, fd: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.text, self.fd = text, fd
        self.from_stdin, self.from_stdout, self.from_stderr = (fd == each for each in (0, 1, 2))


class ProcessStdin(ProcessIO):
    """A process was written to.

    Args:
        text: The bytes.
        **kwargs: Those of RunningProcessEvent.
    """

    name = "launch.events.process.ProcessStdin"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=0, **kwargs)


class ProcessStdout(ProcessIO):
    """A process has written to its standard output.

    Args:
        text: The bytes.
        **kwargs: Those of RunningProcessEvent.
    """

    name = "launch.events.process.ProcessStdout"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=1, **kwargs)


class ProcessStderr(ProcessIO):
    """A process has written to its standard error.

    Args:
        text: The bytes.
        **kwargs: Those of RunningProcessEvent.
    """

    name = "launch.events.process.ProcessStderr"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=2, **kwargs)


class ProcessTargetedEvent(Event):
    """A request to processes.

    Args:
        process_matcher: Function that decides whether the process of an action is meant.
    """

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: Callable[[Any], bool]) -> None:
        self.process_matcher = process_matcher


class ShutdownProcess(ProcessTargetedEvent):
    """Processes are to end."""

    name = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessTargetedEvent):
    """Processes are to be sent a signal.

    Args:
        signal_number: The signal, by number or name. LaunchArgumentError is raised for one that is not there.
        process_matcher: Function that decides whether the process of an action is meant.
    """

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: str | signal.Signals, process_matcher: Callable[[Any], bool]) -> None:
        super().__init__(process_matcher=process_matcher)
        self.signal = _signal(signal_number)
        self.signal_name = self.signal.name


def _signal(given: str | int) -> signal.Signals:
    names = signal.Signals.__members__
    if isinstance(given, str) and given in names:
        return names[given]
    if not isinstance(given, str) and given in {int(each) for each in names.values()}:
        return signal.Signals(given)
    hint = nearest(given.upper(), names) if isinstance(given, str) else ""
    hint = hint or ": signals are such as SIGINT or SIGTERM"
    raise LaunchArgumentError(f"no signal here is {shown(repr(given), 60)}{hint}")


def matches_pid(pid: int) -> Callable[[Any], bool]:
    """Return a function that is true for the action whose process has the id `pid`."""
    return lambda action: (getattr(action, "process_details", None) or {}).get("pid") == pid


def matches_name(name: str) -> Callable[[Any], bool]:
    """Return a function that is true for the action whose process is called `name`."""
    return lambda action: (getattr(action, "process_details", None) or {}).get("name") == name


def matches_executable(executable: str) -> Callable[[Any], bool]:
    """Return a function that is true for the action whose command begins with `executable`."""
    return lambda action: (getattr(action, "process_details", None) or {}).get("cmd", [""])[0] == executable
