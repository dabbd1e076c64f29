"""ROS arguments: the part of a command line behind `--ros-args`, for names, parameters and logs."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import msgspec

from robolink.arguments.overrides import Override, Value, by_first_pattern, overrides_for
from robolink.arguments.remapping import RemapKind, RemapRule, parse_remap_rule, remap_node
from robolink.exceptions import RCLError, RobolinkError, nearest
from robolink.impl.logging_severity import (
    LoggingSeverity,
    LoggingSeverityError,
    get_logging_severity_from_string,
)
from robolink.system.patterns import late

WIDE_PARAMETER = "--wide-param"
"""robolink's own flag for a parameter that was given to more nodes than this one, so that it may lack it.

A launcher gives a value of a section such as `/**` by it, since rcl's `-p` takes no patterns of names.
"""
CHILD_PARAMETER = "--child-param"
"""robolink's own flag for a parameter of a node that the program's node makes itself, such as a costmap of Nav2's.

A launcher gives it by the full name of that node, which rcl's `-p` does not take: in ROS 2 only files can give it.
"""


class InvalidROSArgsError(RCLError, ValueError):
    """A ROS argument cannot be read; the text names it and says what was expected."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"Failed to parse ROS arguments: {' '.join(reason.split())}")


class UnknownROSArgsError(RobolinkError, RuntimeError, ValueError):
    """Arguments between `--ros-args` and `--` that ROS does not know; `unknown_args` lists them."""

    def __init__(self, unknown_args: Sequence[str]) -> None:
        self.unknown_args = list(unknown_args)
        hint = nearest(self.unknown_args[0], _KNOWN)
        super().__init__(f"unknown ROS arguments: {self.unknown_args}{hint}")


class Arguments(msgspec.Struct, frozen=True):
    """Parsed command line: the arguments of ROS, and `unparsed`, those of the program.

    The logger name '' in `log_levels` stands for the root. Settings that were not given are None.
    """

    remap_rules: tuple[RemapRule, ...] = ()
    parameter_overrides: tuple[Override, ...] = ()
    log_levels: tuple[tuple[str, LoggingSeverity], ...] = ()
    enclave: str | None = None
    stdout_logs: bool | None = None
    rosout_logs: bool | None = None
    external_lib_logs: bool | None = None
    log_file_name: str | None = None
    log_config_file: str | None = None
    unparsed: tuple[str, ...] = ()

    def node_name(self, default: str) -> str:
        """Return the name of a node that calls itself `default`."""
        return remap_node(self.remap_rules, RemapKind.NODE, default) or default

    def namespace(self, default: str, node_name: str) -> str:
        """Return the namespace of a node, whose name is already remapped, that would live in `default`."""
        return remap_node(self.remap_rules, RemapKind.NAMESPACE, node_name) or default

    def overrides_for(self, full_node_name: str) -> dict[str, Value]:
        """Return the parameters that a node such as `/arm/driver` gets, by name; of one pattern later arguments win."""
        return overrides_for(self.parameter_overrides, full_node_name)

    def over(self, base: Arguments) -> Arguments:
        """Return these arguments, a node's own, with those of `base`, the program's, wherever these say nothing."""
        given = {name: value for name in _SETTINGS if (value := getattr(self, name)) is not None}
        return msgspec.structs.replace(
            base,
            remap_rules=self.remap_rules + base.remap_rules,  # the first rule wins
            parameter_overrides=base.parameter_overrides + self.parameter_overrides,  # the last value wins
            log_levels=base.log_levels + self.log_levels,
            unparsed=self.unparsed,
            **given,
        )


_SETTINGS = ("enclave", "stdout_logs", "rosout_logs", "external_lib_logs", "log_file_name", "log_config_file")


def parse_arguments(args: Sequence[str]) -> Arguments:
    """Parse a command line, its parameter files included.

    Raises `InvalidROSArgsError`, `UnknownROSArgsError`, or `UnicodeEncodeError` for an argument that is not
    UTF-8 (all of them `ValueError`s).
    """
    for arg in args:
        arg.encode()
    ros_args, rest = _split(args)
    parser = _Parser()
    parser.feed(iter(ros_args))
    if parser.unknown:
        raise UnknownROSArgsError(parser.unknown)
    return Arguments(
        tuple(parser.remap_rules),
        tuple(by_first_pattern(parser.overrides)),
        tuple(parser.log_levels),
        unparsed=tuple(rest),
        **parser.settings,
    )


def remove_ros_args(args: Sequence[str]) -> list[str]:
    """Return the arguments without those between `--ros-args` and `--`, and without these two."""
    return _split(args)[1]


def _split(args: Sequence[str]) -> tuple[list[str], list[str]]:
    """Part the arguments for ROS from the others; `--ros-args` may come several times."""
    ros_args: list[str] = []
    rest: list[str] = []
    is_ros = False
    for arg in args:
        if arg == "--ros-args":
            is_ros = True
        elif is_ros and arg == "--":
            is_ros = False
        else:
            (ros_args if is_ros else rest).append(arg)
    return ros_args, rest


class _Parser:
    """Parser of the ROS arguments, one flag at a time."""

    def __init__(self) -> None:
        self.remap_rules: list[RemapRule] = []
        self.overrides: list[Override] = []
        self.log_levels: list[tuple[str, LoggingSeverity]] = []
        self.settings: dict[str, Any] = {}
        self.unknown: list[str] = []

    def feed(self, args: Iterator[str]) -> None:
        for flag in args:
            if flag in _SWITCHES:
                self.settings[_SWITCHES[flag]] = flag.startswith("--enable")
            elif flag in _FLAGS:
                take, expected = _FLAGS[flag]
                value = next(args, None)
                if value is None:
                    raise InvalidROSArgsError(f"{flag} must be followed by {expected}")
                self.take(take, flag, value)
            else:
                self.unknown.append(flag)

    def take(self, take: Callable[[_Parser, str], None], flag: str, value: str) -> None:
        try:
            take(self, value)
        except (ValueError, LoggingSeverityError) as error:
            raise InvalidROSArgsError(f"'{flag} {value}': {error}") from None

    def remap(self, value: str) -> None:
        self.remap_rules.append(parse_remap_rule(value))

    def wide_parameter(self, value: str) -> None:
        self.parameter(value)
        self.overrides[-1] = self.overrides[-1]._replace(is_typed=False)

    def parameter(self, value: str) -> None:
        from robolink.arguments.parameter_file import parse_parameter_value

        parts = _PARAMETER.fullmatch(value)
        if parts is None:
            raise ValueError("expected name:=value or node:name:=value")
        pattern = f"/{parts['node'] or '**'}"
        typed = parse_parameter_value(parts["value"], "value")
        self.overrides.append(Override(pattern, parts["name"], typed, is_typed=True))

    def child_parameter(self, value: str) -> None:
        parts = _CHILD_PARAMETER.fullmatch(value)
        if parts is None:
            raise ValueError("expected /namespace/node:name:=value")
        self.parameter(parts["parameter"])
        self.overrides[-1] = self.overrides[-1]._replace(pattern=parts["node"])

    def parameter_file(self, value: str) -> None:
        from robolink.arguments.parameter_file import read_parameter_file

        self.overrides += read_parameter_file(value)

    def log_level(self, value: str) -> None:
        logger, separator, level = value.rpartition(":=")
        if separator and not logger:
            raise ValueError("expected LEVEL or logger:=LEVEL")
        self.log_levels.append((logger, get_logging_severity_from_string(level)))

    def enclave(self, value: str) -> None:
        self.settings["enclave"] = value

    def log_file_name(self, value: str) -> None:
        self.settings["log_file_name"] = value

    def log_config_file(self, value: str) -> None:
        self.settings["log_config_file"] = value


_PARAMETER = late(r"(?:(?P<node>[A-Za-z_][A-Za-z0-9_]*):(?!=))?(?P<name>[^:*\s]+):=(?P<value>.*)", re.DOTALL)
_CHILD_PARAMETER = late(r"(?P<node>(?:/[A-Za-z_][A-Za-z0-9_]*)+):(?P<parameter>[^:*\s]+:=.*)", re.DOTALL)
_REMAP = (_Parser.remap, "from:=to")
_PARAM = (_Parser.parameter, "name:=value")
_ENCLAVE = (_Parser.enclave, "the path of an enclave")
_FLAGS = {
    "-r": _REMAP,
    "--remap": _REMAP,
    "-p": _PARAM,
    "--param": _PARAM,
    WIDE_PARAMETER: (_Parser.wide_parameter, "name:=value"),
    CHILD_PARAMETER: (_Parser.child_parameter, "/namespace/node:name:=value"),
    "--params-file": (_Parser.parameter_file, "the path of a file"),
    "--log-level": (_Parser.log_level, "LEVEL or logger:=LEVEL"),
    "-e": _ENCLAVE,
    "--enclave": _ENCLAVE,
    "--log-file-name": (_Parser.log_file_name, "the beginning of a file name"),
    "--log-config-file": (_Parser.log_config_file, "the path of a file"),
}
_SWITCHES = {
    f"--{verb}-{sink}-logs": f"{sink.replace('-', '_')}_logs"
    for verb in ("enable", "disable")
    for sink in ("stdout", "rosout", "external-lib")
}
_KNOWN = [*(each for each in _FLAGS if each not in (WIDE_PARAMETER, CHILD_PARAMETER)), *_SWITCHES]
