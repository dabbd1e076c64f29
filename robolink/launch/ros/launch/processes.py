"""Actions that start processes, and the command lines of these (`launch.actions`, `launch.descriptions`)."""

from __future__ import annotations

import io
import itertools
import os
import re
from collections.abc import Iterable, Mapping
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from robolink.launch.ros.launch.bases import (
    Action,
    LaunchArgumentError,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    SomeSubstitutionsType,
    Substitution,
    check_actions,
)
from robolink.launch.ros.launch.inner_names import inner_names
from robolink.launch.ros.launch.substitutions import LaunchConfiguration
from robolink.launch.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from robolink.system.processes import split_words

if TYPE_CHECKING:
    import asyncio

__all__ = [
    "Executable",
    "ExecuteLocal",
    "ExecuteProcess",
]

_PREFIX, _FILTER = "launch-prefix", "launch-prefix-filter"
"""Launch configurations of the words before every command, and of the pattern of the programs that get them."""
_numbers = itertools.count(1)
_Substitutions = list[Substitution]


class Executable:
    """Command line with its folder and environment (`launch.descriptions`).

    Args:
        cmd: The program and its arguments.
        prefix: Words in front, such as those of a debugger; None is the launch configuration `launch-prefix`, for
            programs whose names match `launch-prefix-filter`.
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
        self.arguments = arguments
        self.cmd = [_word(each) for each in (*cmd, *(arguments or ()))]
        self._has_prefix = prefix is not None
        self.prefix = normalize_to_list_of_substitutions(
            LaunchConfiguration(_PREFIX, default="") if prefix is None else prefix
        )
        self.name = None if name is None else normalize_to_list_of_substitutions(name)
        self.cwd = None if cwd is None else normalize_to_list_of_substitutions(cwd)
        self.env, self.additional_env = _pairs(env), _pairs(additional_env)
        self.final_words: list[str] = []
        """The command line without the prefix, once it was prepared."""
        self.final_prefix: list[str] = []
        self.final_variables: dict[str, str] = {}
        """Variables of its own, whether they are all that it has or are added."""
        self.final_name: str | None = None
        """Name and a number that no other has, once it was prepared."""
        self.final_cwd: str | None = None
        self.final_env: dict[str, str] | None = None

    @property
    def final_cmd(self) -> list[str] | None:
        """The whole command line, once it was prepared."""
        return None if self.final_name is None else [*self.final_prefix, *self.final_words]

    def prepare(self, context: LaunchContext, action: Action | None) -> None:
        """Perform all of it with the values of `context`, for an `action`, of which nothing is taken here."""
        self.settle([perform_substitutions(context, each) for each in self.cmd], context)

    def settle(self, words: list[str], context: LaunchContext) -> None:
        """Take `words` as the command line, and perform all else with the values of `context`."""
        self.final_words = words
        program = PurePath(words[0]).name if words else ""
        self.final_prefix = self._prefix_of(program, context)
        name = program if self.name is None else perform_substitutions(context, self.name)
        self.final_name = f"{name}-{next(_numbers)}"
        self.final_cwd = None if self.cwd is None else perform_substitutions(context, self.cwd)
        own, added = _performed(self.env, context), _performed(self.additional_env, context)
        self.final_variables = {**own, **added}
        self.final_env = {**(dict(context.environment) if self.env is None else own), **added}

    def _prefix_of(self, program: str, context: LaunchContext) -> list[str]:
        if not self._has_prefix:
            known = context.launch_configurations
            if _PREFIX not in known or not re.match(str(known.get(_FILTER, "")), program):
                return []
        return split_words(perform_substitutions(context, self.prefix))


def _word(given: Any) -> _Substitutions:
    """Return a word of a command line as substitutions; many launch files give a number."""
    return normalize_to_list_of_substitutions(str(given) if isinstance(given, (int, float)) else given)


def _pairs(given: Mapping[Any, Any] | None) -> list[tuple[_Substitutions, _Substitutions]] | None:
    if given is None:
        return None
    normalized = normalize_to_list_of_substitutions
    return [(normalized(name), normalized(value)) for name, value in given.items()]


def _performed(pairs: Iterable[tuple[_Substitutions, _Substitutions]] | None, context: LaunchContext) -> dict[str, str]:
    return {perform_substitutions(context, name): perform_substitutions(context, value) for name, value in pairs or ()}


@inner_names(
    "process_description",
    "shell",
    "sigterm_timeout",
    "sigkill_timeout",
    "emulate_tty",
    "output",
    "output_format",
    "log_cmd",
    "cached_output",
    "on_exit",
    "respawn",
    "respawn_delay",
    "respawn_max_retries",
)
class ExecuteLocal(Action):
    """Start a process.

    Where a LaunchService runs it, all of this counts. `robolink launch` shows and stores all lines of all processes,
    whatever `output`, `output_format`, `cached_output`, `emulate_tty`, `log_cmd` and the two timeouts are.

    Args:
        process_description: Its command line.
        shell: True lets a shell read the command line.
        sigterm_timeout: Time from SIGINT to SIGTERM when it is stopped, in seconds.
        sigkill_timeout: Time from SIGTERM to SIGKILL, in seconds.
        emulate_tty: True lets its output be a terminal.
        output: Where its lines go, as `launch.logging.get_output_loggers` takes it.
        output_format: Format of a line, with `line` and `this` for the action.
        cached_output: True keeps all that it writes, for `get_stdout` and `get_stderr`.
        log_cmd: True writes the command line before the start.
        on_exit: What follows its end: entities, or a function of the event and the context.
        respawn: True starts it again whenever it ends.
        respawn_delay: Time before that, in seconds.
        respawn_max_retries: Most starts again; -1 has no limit.
        **kwargs: `condition`.
    """

    lasts = True

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        sigterm_timeout: SomeSubstitutionsType | float | None = None,
        sigkill_timeout: SomeSubstitutionsType | float | None = None,
        emulate_tty: bool = False,
        output: Any = "log",
        output_format: str = "[{this.process_description.final_name}] {line}",
        cached_output: bool = False,
        log_cmd: bool = False,
        on_exit: Any = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | SomeSubstitutionsType | None = None,
        respawn_max_retries: int = -1,
        **kwargs: Any,
    ) -> None:
        self.is_left_out = False
        """True if it cannot run here."""
        super().__init__(**kwargs)
        if on_exit is not None and not callable(on_exit):
            check_actions(on_exit, f"{type(self).__name__}(on_exit=...)")
        self.process_description, self.shell, self.on_exit = process_description, shell, on_exit
        self.respawn, self.respawn_delay, self.respawn_max_retries = respawn, respawn_delay, respawn_max_retries
        self.sigterm_timeout = _seconds("sigterm_timeout", sigterm_timeout)
        self.sigkill_timeout = _seconds("sigkill_timeout", sigkill_timeout)
        output = os.environ.get("OVERRIDE_LAUNCH_PROCESS_OUTPUT") or output
        self.output = output if isinstance(output, dict) else normalize_to_list_of_substitutions(output)
        self.emulate_tty, self.output_format = emulate_tty, output_format
        self.cached_output, self.log_cmd = cached_output, log_cmd
        self.process_details: dict[str, Any] | None = None
        """Arguments of the events about it, but for the action: name, command line, environment; and its process id."""
        self.return_code: int | None = None
        """Its last return code."""
        self.written = {1: io.StringIO(), 2: io.StringIO()}
        """All that it wrote, if that is kept."""
        self._completed: asyncio.Future[None] | None = None

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that follow its end, if they are known."""
        return list(self.on_exit) if isinstance(self.on_exit, list) else []

    def prepare(self, context: LaunchContext) -> None:
        """Perform its command line and what belongs to that with the values of `context`."""
        self.process_description.prepare(context, self)
        self.describe_process()

    def describe_process(self) -> None:
        """Set `process_details` from a command line that was prepared."""
        described = self.process_description
        self.process_details = {
            "action": self,
            "name": described.final_name,
            "cmd": described.final_cmd,
            "cwd": described.final_cwd,
            "env": described.final_env,
        }

    def execute(self, context: LaunchContext) -> None:
        """Prepare it, and leave its start to the launcher, which sees all actions that are executed in `context`."""
        self.prepare(context)
        if context.asyncio_loop is not None:
            self._completed = context.asyncio_loop.create_future()
        context.note_executed(self)

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return the future of its end; None outside of a LaunchService."""
        return self._completed

    def complete(self) -> None:
        """Note that it has ended and is not started again."""
        if self._completed is not None and not self._completed.done():
            self._completed.set_result(None)

    def get_stdout(self) -> str:
        """Return all that it wrote to its standard output; raises LaunchError without `cached_output`."""
        return self._cached(1)

    def get_stderr(self) -> str:
        """Return all that it wrote to its standard errors; raises LaunchError without `cached_output`."""
        return self._cached(2)

    def _cached(self, fd: int) -> str:
        if not self.cached_output:
            name = self.process_description.final_name or "process"
            raise LaunchError(f"nothing that {name} wrote is kept: give it cached_output=True")
        return self.written[fd].getvalue()


def _seconds(name: str, given: SomeSubstitutionsType | float | None) -> _Substitutions:
    """Return a time; None is that of the launch configuration `name`, or else 5 s."""
    return _word(LaunchConfiguration(name, default="5") if given is None else given)


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

    @classmethod
    def _parse_cmdline(cls, cmd: str, parser: Any) -> list[list[Substitution]]:
        """Return the words of a command line in XML or YAML: `parse` of programs' own classes calls it, too."""
        from robolink.launch.ros.launch.frontend.parse_substitution import words_of

        return words_of(parser.parse_substitution(cmd))

    @property
    def cmd(self) -> list[list[Substitution]]:
        """The program and its arguments."""
        return self.process_description.cmd

    @property
    def name(self) -> SomeSubstitutionsType | None:
        """Name for people: the one with its number once it was prepared."""
        described = self.process_description
        return described.name if described.final_name is None else described.final_name

    @property
    def cwd(self) -> list[Substitution] | None:
        """Working directory."""
        return self.process_description.cwd

    @property
    def env(self) -> list[tuple[list[Substitution], list[Substitution]]] | None:
        """The whole environment; None is the launcher's."""
        return self.process_description.env

    @property
    def additional_env(self) -> list[tuple[list[Substitution], list[Substitution]]] | None:
        """Variables that are added."""
        return self.process_description.additional_env
