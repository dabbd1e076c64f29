"""What a launcher asks of the processes that it starts, read without typer: that is a fifth of a node's start."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Sequence
from typing import NoReturn

ROS_ARGS = "--ros-args"


def shortcut(args: Sequence[str]) -> Callable[[], int] | None:
    """Give what does a command that has no options of its own: `run NODE -- ...`, `run-together`; None for others."""
    match args:
        case ["run", *rest]:
            return _run(rest)
        case ["run-together"]:
            return run_together
        case ["look-into"]:
            return look_into
    return None


def run_together() -> int:
    """Run the nodes that standard input names, a single one as `run` does; give the exit code."""
    from robolink.launch.together import read

    members = read(sys.stdin.buffer.read())
    alone = _run([members[0].node, "--", *members[0].args]) if len(members) == 1 else None
    if alone is not None:
        return alone()
    from robolink.cli import container

    return container.run(members)


def look_into() -> NoReturn:
    """Tell on standard output of the nodes that standard input names, and end the process."""
    from robolink.cli import looker
    from robolink.launch.looking.look import read

    looker.run(read(sys.stdin.buffer.read()))


def _run(args: list[str]) -> Callable[[], int] | None:
    """Part the words as `robolink.cli.run` does. What it may know as an option, before `--`, is left to it."""
    at = args.index(ROS_ARGS) if ROS_ARGS in args else len(args)
    own, ros_args = args[:at], args[at:]
    dashes = own.index("--") if "--" in own else at
    words, fixed = own[:dashes], own[dashes + 1 :]
    if not words or not words[0] or any(each.startswith("-") for each in words):
        return None

    def run() -> int:
        gc.disable()  # there is nothing to collect while modules are imported; `pass_over_imports` enables it
        try:
            from robolink.cli import runner

            return runner.run(runner.Asked(words[0], [*words[1:], *fixed], len(words) - 1), ros_args, None)
        finally:
            gc.enable()

    return run
