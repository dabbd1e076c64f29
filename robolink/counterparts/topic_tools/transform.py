"""Publish what an expression makes of the messages of a topic, or of one field of them.

robolink run topic_tools transform /imu /x std_msgs/Float64 'std_msgs.msg.Float64(data=m.orientation.x)' -i std_msgs
"""

from __future__ import annotations

import contextlib
import functools
import importlib
from typing import Any

from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.topic_tools.conversion import Conversion, Topics, compiled, parser_of


def main(args: list[str] | None = None) -> None:
    """Convert messages until Ctrl-C."""
    spin_program(make, args)


def make(words: list[str]) -> Conversion:
    """Make the node of a command line."""
    parser = parser_of("transform")
    parser.add_argument("expression", nargs="?", default="m", help="Python's expression on the message m")
    parser.add_argument("-i", "--import", dest="modules", nargs="+", default=["numpy"], help="modules of it")
    parser.add_argument("--field", default="", help="field that m is, such as orientation.x")
    asked = parser.parse_args(words)
    code, names = compiled(asked.expression), {each: _module(each) for each in asked.modules}
    path = [each for each in asked.field.split(".") if each]

    def convert(message: Any, kind: type[Any]) -> Any:
        m = functools.reduce(getattr, path, message)
        return eval(code, {**names, "m": m})  # noqa: S307 - the user's own text, in their own shell

    return Conversion("transform", Topics(asked.input, asked.output_topic, asked.output_type), convert)


def _module(name: str) -> Any:
    from robolink import compat  # late: its import takes names already

    compat.activate()
    try:
        module = importlib.import_module(name)
    except ImportError as error:
        raise UsageError(f"--import {name}: {error}") from None
    with contextlib.suppress(ImportError):  # a package of messages, whose `msg` an expression needs
        importlib.import_module(f"{name}.msg")
    return module


if __name__ == "__main__":
    main()
