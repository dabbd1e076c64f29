"""Actions that start processes, and the command lines of these (`launch.actions`, `launch.descriptions`)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from robolink.launch.ros.launch.bases import (
    Action,
    LaunchArgumentError,
    LaunchContext,
    SomeSubstitutionsType,
    check_actions,
)

__all__ = [
    "Executable",
    "ExecuteLocal",
    "ExecuteProcess",
]


IGNORED = frozenset(
    ["cached_output", "emulate_tty", "log_cmd", "output", "output_format", "sigkill_timeout", "sigterm_timeout"]
)
"""Settings that ROS 2 has and that are of no effect here: all lines of all processes are shown and stored."""


class Executable:
    """Command line with its folder and environment (`launch.descriptions`).

    Args:
        cmd: The program and its arguments.
        prefix: Words in front, such as those of a debugger.
        name: Name for people.
        cwd: Working directory.
        env: The whole environment, by name; None is the launcher's.
        additional_env: Variables that are added.
        arguments: Further arguments.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        additional_env: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
    ) -> None:
        if isinstance(cmd, str):
            raise LaunchArgumentError(f"cmd is a list of words, such as {cmd.split()}, got the text '{cmd:.60}'")
        self.cmd = [*cmd, *(arguments or ())]
        self.prefix, self.name, self.cwd, self.env, self.additional_env = prefix, name, cwd, env, additional_env


class ExecuteLocal(Action):
    """Start a process.

    Args:
        process_description: Its command line.
        shell: True lets a shell read the command line.
        on_exit: What follows its end: entities, or a function of the event and the context.
        respawn: True starts it again whenever it ends.
        respawn_delay: Time before that, in seconds.
        respawn_max_retries: Most starts again; -1 has no limit.
        **kwargs: `condition`, and the settings that are of no effect here: `IGNORED`.
    """

    lasts = True
    accepted = IGNORED

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        on_exit: Any = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | SomeSubstitutionsType | None = None,
        respawn_max_retries: int = -1,
        **kwargs: Any,
    ) -> None:
        self.is_left_out = False
        """True if it cannot run here."""
        super().__init__(**{name: value for name, value in kwargs.items() if name not in IGNORED})
        if on_exit is not None and not callable(on_exit):
            check_actions(on_exit, f"{type(self).__name__}(on_exit=...)")
        self.process_description, self.shell, self.on_exit = process_description, shell, on_exit
        self.respawn, self.respawn_delay, self.respawn_max_retries = respawn, respawn_delay, respawn_max_retries
        self.process_details: dict[str, Any] | None = None
        """Name, command line and process id, once it was started."""
        self.return_code: int | None = None
        """Its last return code."""

    def execute(self, context: LaunchContext) -> None:
        """Leave it to the launcher, which sees all actions that are executed in `context`."""


class ExecuteProcess(ExecuteLocal):
    """Start a command.

    Args:
        cmd: The program and its arguments.
        prefix: Words in front.
        name: Name for people.
        cwd: Working directory.
        env: The whole environment, by name; None is the launcher's.
        additional_env: Variables that are added.
        **kwargs: Those of ExecuteLocal.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        additional_env: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        executable = Executable(cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env)
        super().__init__(process_description=executable, **kwargs)

    @property
    def cmd(self) -> list[SomeSubstitutionsType]:
        """The program and its arguments."""
        return self.process_description.cmd
