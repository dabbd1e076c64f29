"""Short path for the commands that a launcher starts, without typer, which takes a fifth of a node's start."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Sequence
from typing import NoReturn

ROS_ARGS = "--ros-args"


def shortcut(args: Sequence[str]) -> Callable[[], int] | None:
    """Return the function of a command without options of its own (`run NODE -- ...`, `run-together`); else None."""
    match args:
        case ["run", *rest]:
            return _run(rest)
        case ["run-together"]:
            return run_together
        case ["look-into"]:
            return look_into
        case ["fork-server", descriptor, _]:
            return lambda: fork_server(int(descriptor))
    return None


def run_together() -> int:
    """Run the nodes that standard input names, a single one as `run` does, and return the exit code."""
    from robolink.launch.shared_process import read

    members = read(sys.stdin.buffer.read())
    alone = _run([members[0].node, "--", *members[0].args]) if len(members) == 1 else None
    if alone is not None:
        return alone()
    from robolink.cli.running_nodes import container

    return container.run(members)


def fork_server(descriptor: int) -> int:
    """Serve a launcher's requests on a socket: this process is forked for each, which runs a command of this module.

    What it imports is what every node does before it opens its session.
    """
    # No object of the server's is garbage, and looking for some would copy memory that is shared. A process that was
    # forked collects its own: `pass_over_imports` is called there.
    gc.disable()
    import robolink.transport.zenoh  # noqa: F401
    from robolink import client, node, spinning, timer  # noqa: F401
    from robolink.cli.running_nodes import runner
    from robolink.supervisor.processes import fork_server

    if os.environ.get("ROS_SECURITY_ENABLE", "false") != "false":  # 30 ms of each node's start
        import ssl  # noqa: F401

        import robolink.transport.secured  # noqa: F401
    runner.prepare_types()
    requested = shortcut(fork_server.serve(descriptor))
    assert requested is not None, "a launcher asks for what it would run itself"
    return requested()


def look_into() -> NoReturn:
    """Report the nodes that standard input names on standard output, and end the process."""
    from robolink.cli.running_nodes import inspection
    from robolink.launch.looking.look import read

    inspection.run(read(sys.stdin.buffer.read()))


def _run(args: list[str]) -> Callable[[], int] | None:
    """Split the words as the command `run` does; None if one before `--` may be an option, which is left to it."""
    at = args.index(ROS_ARGS) if ROS_ARGS in args else len(args)
    own, ros_args = args[:at], args[at:]
    dashes = own.index("--") if "--" in own else at
    words, fixed = own[:dashes], own[dashes + 1 :]
    if not words or not words[0] or any(each.startswith("-") for each in words):
        return None

    def run() -> int:
        gc.disable()  # there is nothing to collect while modules are imported; `pass_over_imports` enables it
        try:
            from robolink.cli.running_nodes import runner

            return runner.run(runner.NodeCommand(words[0], [*words[1:], *fixed], len(words) - 1), ros_args, None)
        finally:
            gc.enable()

    return run
