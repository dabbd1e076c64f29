"""robolink interface: see the types of messages, services and actions."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from robolink.cli.shared import complete

app = typer.Typer(no_args_is_help=True, help="Show the definitions of messages, services and actions.")

HEADINGS = {"msg": "Messages", "srv": "Services", "action": "Actions"}

Type = Annotated[
    str,
    typer.Argument(
        help="Type: Twist, geometry_msgs/Twist or geometry_msgs/msg/Twist.",
        metavar="TYPE",
        autocompletion=complete.interface_types,
    ),
]
OnlyMsgs = Annotated[bool, typer.Option("--only-msgs", "-m", help="List only message types.")]
OnlySrvs = Annotated[bool, typer.Option("--only-srvs", "-s", help="List only service types.")]
OnlyActions = Annotated[bool, typer.Option("--only-actions", "-a", help="List only action types.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@app.command("list")
def list_interfaces(
    only_msgs: OnlyMsgs = False, only_srvs: OnlySrvs = False, only_actions: OnlyActions = False, as_json: AsJson = False
) -> None:
    """List all available interface types, those of the workspace too."""
    from robolink.cli.shared.output import say, say_json

    found = {kind: _names(kind) for kind in _kinds(only_msgs, only_srvs, only_actions)}
    if as_json:
        say_json({HEADINGS[kind].lower(): names for kind, names in found.items()})
        return
    for kind, names in found.items():
        say("\n".join([f"{HEADINGS[kind]}:", *(f"    {name}" for name in names)]))


@app.command("packages")
def packages(
    only_msgs: OnlyMsgs = False, only_srvs: OnlySrvs = False, only_actions: OnlyActions = False, as_json: AsJson = False
) -> None:
    """List the packages that provide interfaces."""
    from robolink.cli.shared.output import say, say_json

    names = [name for kind in _kinds(only_msgs, only_srvs, only_actions) for name in _names(kind)]
    found = sorted({name.partition("/")[0] for name in names})
    if as_json:
        say_json(found)
    else:
        say("\n".join(found))


@app.command("package")
def package(
    name: Annotated[
        str,
        typer.Argument(
            help="Package, such as example_interfaces.", metavar="PACKAGE", autocompletion=complete.interface_packages
        ),
    ],
    only_msgs: OnlyMsgs = False,
    only_srvs: OnlySrvs = False,
    only_actions: OnlyActions = False,
    as_json: AsJson = False,
) -> None:
    """List the interface types of a package."""
    from robolink.cli.shared.output import say, say_json
    from robolink.exceptions import NotFoundError

    known = [each for kind in HEADINGS for each in _names(kind)]
    if not any(each.startswith(f"{name}/") for each in known):
        raise NotFoundError("interface package", name[:200], {each.partition("/")[0] for each in known})
    kinds = _kinds(only_msgs, only_srvs, only_actions)
    found = [each for each in known if each.split("/")[:2] in [[name, kind] for kind in kinds]]
    if as_json:
        say_json(found)
    elif found:
        say("\n".join(found))


@app.command("show")
def show_interface(
    type_: Annotated[
        str,
        typer.Argument(
            help="Type: Twist, geometry_msgs/Twist or geometry_msgs/msg/Twist; - reads it from standard input.",
            metavar="TYPE",
            autocompletion=complete.interface_types,
        ),
    ],
    all_comments: Annotated[
        bool, typer.Option("--all-comments", help="Print the comments of nested types too.")
    ] = False,
    no_comments: Annotated[bool, typer.Option("--no-comments", help="Print no comments and no empty lines.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON object, with the type hash.")] = False,
) -> None:
    """Print the definition of an interface."""
    from robolink.cli.interface.show import as_data, lines, type_named
    from robolink.cli.shared.messages import as_json as json_text
    from robolink.cli.shared.output import say

    if all_comments and no_comments:
        raise typer.BadParameter("--all-comments and --no-comments exclude each other")
    found = type_named(_from_stdin() if type_ == "-" else type_)
    if as_json:
        say(json_text(as_data(found)))
    else:
        say("\n".join(lines(found, comments=not no_comments, nested_comments=all_comments)))


@app.command("proto")
def proto(
    type_: Type, no_quotes: Annotated[bool, typer.Option("--no-quotes", help="Print no quotes around it.")] = False
) -> None:
    """Print a prototype of a message, request or goal, as YAML for topic pub and service call."""
    from robolink.cli.interface.show import prototype, type_named
    from robolink.cli.shared.output import say

    text = prototype(type_named(type_))
    say(f"{text}\n" if no_quotes else f'"{_escaped(text)}\n"')


def _escaped(text: str) -> str:
    """Escape the characters that a shell would interpret within double quotes."""
    import re

    return re.sub(r'([\\"$`])', r"\\\1", text)


def _kinds(*only: bool) -> list[str]:
    """Return the kinds that are selected; all, if none is."""
    return [kind for kind, requested in zip(HEADINGS, only, strict=True) if requested] or list(HEADINGS)


def _names(kind: str) -> list[str]:
    from robolink.interfaces import names

    return names(kind)


def _from_stdin() -> str:
    if sys.stdin is None or sys.stdin.isatty():
        raise typer.BadParameter("'-' reads the type from a pipe: robolink topic type /chatter | robolink ... show -")
    name = sys.stdin.readline().strip()
    if not name:
        raise typer.BadParameter("nothing came from standard input: expected the name of a type")
    return name
