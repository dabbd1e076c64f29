"""Generated pages of the reference, in English: commands, Python API, message types, keys of files."""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

API = (
    "robolink.node",
    "robolink.publisher",
    "robolink.subscription",
    "robolink.client",
    "robolink.service",
    "robolink.timer",
    "robolink.parameter",
    "robolink.qos",
    "robolink.executors",
    "robolink.callback_groups",
    "robolink.task",
    "robolink.clock",
    "robolink.time",
    "robolink.duration",
    "robolink.action",
    "robolink.lifecycle",
    "robolink.image",
    "robolink.testing",
    "robolink.control.pid",
    "robolink.control.scan_controller",
)
"""Modules whose public classes and functions are described."""

ABOUT = {
    "cli": ("Commands", "Every command and option. `robolink COMMAND --help` says the same."),
    "api": ("Python API", "What programs use most, from its docstrings. The modules have rclpy's names."),
    "messages": (
        "Messages, services, actions",
        "The types that are included. `robolink interface show TYPE` shows one with all that is in it.",
    ),
    "files": (
        "Keys of files",
        (
            "Launch files, faults files and world files. Editors complete and check them: the first line of a file says"
            " where its schema is, `# yaml-language-server: $schema=launch.schema.json`; `robolink launch --schema`,"
            " `robolink simulate --schema` and `robolink world schema` print them."
        ),
    ),
}
"""Title of each page, and what stands below it."""


def text(name: str) -> str:
    """Return a generated page.

    Args:
        name: cli, api, messages or files.
    """
    made: dict[str, Callable[[], Iterator[str]]] = {"cli": _cli, "api": _api, "messages": _messages, "files": _files}
    title, about = ABOUT[name]
    return "\n".join([f"# {title}", "", about, "", *made[name]()]) + "\n"


def cell(words: str) -> str:
    """Return a text as it stands in a cell of a table."""
    return " ".join(words.split()).replace("|", "\\|").replace("<", "&lt;")


def table(*heads: str) -> list[str]:
    """Return the first lines of a table."""
    return [f"| {' | '.join(heads)} |", f"|{'---|' * len(heads)}"]


# Commands


def _cli() -> Iterator[str]:
    from robolink.cli.root import command

    root = command()
    for path, each in leaves(root, []):
        yield f"## robolink {' '.join(path)}\n"
        yield f"{help_of(each)}\n"
        options = shown_options(each)
        if options:
            yield from table("option", "meaning")
            yield from (f"| `{_spelling(param)}` | {cell(help_of(param))} |" for param in options)
            yield ""


def leaves(command: Any, path: list[str]) -> Iterator[tuple[list[str], Any]]:
    """Yield the commands below a command that have no commands themselves, each with its path.

    Args:
        command: The command.
        path: Its own path.
    """
    verbs = getattr(command, "commands", None)
    if not hasattr(command, "list_commands"):
        yield path, command
        return
    from typer.main import get_command  # noqa: F401 - the root imports its nouns by it

    context = command.make_context("robolink", [], resilient_parsing=True)
    for name in command.list_commands(context):
        each = verbs.get(name) if verbs and name in verbs else command.get_command(context, name)
        if each is not None and not getattr(each, "hidden", False):
            yield from leaves(each, [*path, name])


def shown_options(command: Any) -> list[Any]:
    """Return the options and arguments of a command that its help shows."""
    return [each for each in command.params if not getattr(each, "hidden", False) and each.name != "help"]


def help_of(thing: Any) -> str:
    """Return the help text of a command or an option; '' if it has none."""
    return inspect.cleandoc(getattr(thing, "help", None) or "")


def _spelling(param: Any) -> str:
    names = ", ".join(param.opts) if param.param_type_name == "option" else ""
    metavar = param.metavar or ("" if getattr(param, "is_flag", False) else (param.name or "").upper())
    return cell(f"{names} {metavar}".strip())


# Python


def _api() -> Iterator[str]:
    for name in API:
        module = importlib.import_module(name)
        yield f"## {name}\n"
        yield f"{_described(module)}\n"
        for each in public(module):
            thing = getattr(module, each)
            yield from (_class(each, thing) if inspect.isclass(thing) else _function(each, thing, "###"))


def public(module: ModuleType) -> list[str]:
    """Return the names of a module's public classes and functions: those of `__all__`, or those that it defines."""
    names = getattr(module, "__all__", None)
    found = [(each, getattr(module, each)) for each in names or vars(module) if not each.startswith("_")]
    return sorted(
        each
        for each, thing in found
        if (inspect.isclass(thing) or inspect.isfunction(thing))
        and (thing.__module__ == module.__name__ or (names and thing.__module__.startswith("robolink")))
    )


def summary(thing: Any) -> str:
    """Return the first paragraph of a docstring in one line; '' if there is none."""
    return " ".join((inspect.getdoc(thing) or "").partition("\n\n")[0].split())


def _class(name: str, kind: type) -> Iterator[str]:
    yield f"### {name}\n"
    yield f"{_described(kind)}\n"
    for each, member in methods(kind):
        yield from _function(f"{name}.{each}", member, "####")


def methods(kind: type) -> list[tuple[str, Any]]:
    """Return the public methods that a class defines itself, by their names."""
    return sorted(
        (name, each)
        for name, each in vars(kind).items()
        if not name.startswith("_") and inspect.isfunction(each) and each.__doc__
    )


def _function(name: str, function: Any, level: str) -> Iterator[str]:
    try:
        signature = str(inspect.signature(function)).replace("robolink.", "")
    except (TypeError, ValueError):
        signature = "(...)"
    yield f"{level} {name}\n"
    yield f"```text\n{name.rpartition('.')[2]}{signature}\n```\n"
    yield f"{_described(function)}\n"


def _described(thing: Any) -> str:
    """Return a docstring as Markdown: its first paragraph and, but for a module, the rest as it stands."""
    words = summary(thing)
    rest = "" if inspect.ismodule(thing) else (inspect.getdoc(thing) or "").partition("\n\n")[2]
    return _block(words, rest)


def _block(words: str, rest: str) -> str:
    """Return a paragraph, and a text below it as it stands, as Markdown."""
    paragraph = " ".join(words.split()).replace("<", "&lt;")
    return f"{paragraph}\n\n```text\n{rest}\n```" if rest.strip() else paragraph


# Types


def _messages() -> Iterator[str]:
    from robolink.interfaces import names

    found: dict[str, list[str]] = {}
    for kind in ("msg", "srv", "action"):
        for name in names(kind):
            found.setdefault(name.partition("/")[0], []).append(name)
    for package in sorted(found):
        yield f"## {package}\n"
        yield from table("type", "fields")
        yield from (f"| `{each.partition('/')[2]}` | {cell(_fields(each))} |" for each in sorted(found[package]))
        yield ""


def _fields(name: str) -> str:
    from robolink.cli.interface.show import prototype, type_named

    return " ".join(f"`{each}`" for each in _keys(prototype(type_named(name))))


def _keys(shown: Any) -> list[str]:
    lines = shown if isinstance(shown, list) else str(shown).splitlines()
    return [each.split(":")[0].strip() for each in lines if each and not each.startswith((" ", "-"))]


# Files


def _files() -> Iterator[str]:
    for schema in _schemas():
        yield f"## {schema['title']}\n"
        for name, part in _parts(schema):
            if name:
                yield f"### {name}\n"
            first, _, rest = part.get("description", "").partition("\n\n")
            yield f"{_block(first, rest)}\n"
            yield from table("key", "type", "default", "meaning")
            yield from (_row(key, value) for key, value in part["properties"].items())
            yield ""


def _schemas() -> list[dict[str, Any]]:
    from robolink.faults.file import faults_schema
    from robolink.launch.reading.description import launch_schema
    from robolink.sim.schema import world_schema

    return [launch_schema(), faults_schema(), world_schema()]


def _parts(schema: dict[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    """Return the kinds of mappings of a schema by name; '' is the file itself."""
    return [(name, part) for name, part in ({"": schema} | schema["definitions"]).items() if "properties" in part]


def _row(key: str, value: dict[str, Any]) -> str:
    default = f"`{value['default']}`" if value.get("default") not in (None, "") else ""
    meaning = value.get("description", "").partition("\n\n")[0]
    return f"| `{key}` | {cell(_kind(value))} | {default} | {cell(meaning)} |"


def _kind(value: dict[str, Any]) -> str:
    if "enum" in value:
        return ", ".join(f"`{each}`" for each in value["enum"])
    if "anyOf" in value:
        kinds = dict.fromkeys(_kind(each) for each in value["anyOf"] if "pattern" not in each)
        return ", ".join(kinds)
    if "allOf" in value:
        return _kind(value["allOf"][0])
    if "$ref" in value:
        return str(value["$ref"].rpartition("/")[2])
    return str(value.get("type", ""))
