"""Shell completion: live names of nodes, topics and services, types, and what can be run.

A completion never prints an error and never takes long: after an error, or too late, nothing is offered.
"""

from __future__ import annotations

import contextlib
import re
import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from robolink.system import waits

if TYPE_CHECKING:
    from robolink.graph.graph import Token

WITHIN = 0.3
"""Timeout of a look at the network, in seconds."""

_SAFE = re.compile(r"[A-Za-z0-9_./:~-]+", re.ASCII)
"""Names that need no quotes in a shell. zsh evaluates what it is offered, and anybody may announce a name."""

NODE = "robolink.node"
"""Key of a context's `meta` for the node of `run`, which a line that is not complete has not parsed."""

Context = typer.Context


def node_names(incomplete: str) -> list[str]:
    """Return the full names of the running nodes."""
    from robolink.wire import NodeToken

    return _names(incomplete, lambda each: each.full_node_name if isinstance(each, NodeToken) else None)


def topic_names(incomplete: str) -> list[str]:
    """Return the names of the topics that have publishers or subscriptions."""
    from robolink.wire import EndpointKind

    return _endpoint_names(incomplete, EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)


def service_names(incomplete: str) -> list[str]:
    """Return the names of the services that are served."""
    from robolink.wire import EndpointKind

    return _endpoint_names(incomplete, EndpointKind.SERVICE)


def type_of_topic(ctx: Context, incomplete: str) -> list[str]:
    """Return the types of the topic on the command line; all message types if it has none."""
    from robolink.wire import EndpointKind

    kinds = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
    return _types_of(ctx.params.get("topic"), incomplete, *kinds) or message_types(incomplete)


def type_of_service(ctx: Context, incomplete: str) -> list[str]:
    """Return the types of the service on the command line; all service types if it has none."""
    from robolink.wire import EndpointKind

    return _types_of(ctx.params.get("service"), incomplete, EndpointKind.SERVICE) or service_types(incomplete)


def message_types(incomplete: str) -> list[str]:
    """Return the names of message types."""
    return _type_names(incomplete, "msg")


def service_types(incomplete: str) -> list[str]:
    """Return the names of service types."""
    return _type_names(incomplete, "srv")


def action_types(incomplete: str) -> list[str]:
    """Return the names of action types."""
    return _type_names(incomplete, "action")


def interface_types(incomplete: str) -> list[str]:
    """Return the names of message, service and action types."""
    return _type_names(incomplete, "msg", "srv", "action")


def interface_packages(incomplete: str) -> list[str]:
    """Return the packages that have types."""
    return offered({each.partition("/")[0] for each in _type_names("", "msg", "srv", "action")}, incomplete)


def package_names(incomplete: str) -> list[str]:
    """Return the names of all packages."""
    with contextlib.suppress(Exception):
        from robolink.companions.ament_index import get_packages_with_prefixes

        return offered(get_packages_with_prefixes(), incomplete)
    return []


def runnable_nodes(ctx: Context, incomplete: str) -> list[str]:
    """Return the nodes that `robolink run` knows by name, and the packages that have executables."""
    with contextlib.suppress(Exception):
        from robolink.workspace import list_executables, list_nodes, program_names

        workspace = ctx.params.get("workspace") or None
        nodes = [each.name for each in list_nodes(workspace=workspace)]
        return offered([*nodes, *list_executables(workspace=workspace), *program_names()], incomplete)
    return []


def package_executables(ctx: Context, incomplete: str) -> list[str]:
    """Return the executables of the package on the command line; nothing after a node's name."""
    with contextlib.suppress(Exception):
        from robolink.workspace import find_package, named_executables, programs_of

        package, workspace = str(ctx.params.get("node") or ""), ctx.params.get("workspace") or None
        if not ctx.params.get("args"):
            folder = find_package(package, workspace=workspace)
            own = [] if folder is None else [each.name for each in named_executables(folder)]
            return offered([*own, *programs_of(package)], incomplete)
    return []


def world_files(ctx: Context, incomplete: str) -> list[str]:
    """Return the worlds known by name, and folders and world files whose paths begin so."""
    with contextlib.suppress(Exception):
        from robolink.workspace import list_worlds

        known = [each.stem for each in list_worlds(workspace=ctx.params.get("workspace") or None)]
        return offered([*known, *_files(incomplete, (".yaml", ".yml", ".wbt"))], incomplete)
    return []


def parameters(ctx: Context, incomplete: str) -> list[str]:
    """Return the assignment of the world for the node `world`, whose other parameters are numbers and switches."""
    if ctx.meta.get(NODE) not in ("world", "world.py"):
        return []
    if ":=" in incomplete:
        return world_assignments(ctx, incomplete)
    return ["world:="] if "world".startswith(incomplete) else []


def world_assignments(ctx: Context, incomplete: str) -> list[str]:
    """Return `world:=NAME` for each world, if `incomplete` begins so."""
    name, given, value = incomplete.partition(":=")
    return [f"{name}:={each}" for each in world_files(ctx, value)] if given and name == "world" else []


def joined_for_bash(words: str, at: int) -> tuple[str, int, str]:
    """Return bash's words with the last assignment in one piece, the index of the word to complete, and what to cut.

    Bash ends a word at each `:` and `=`, as they separate paths and variables, and has its own part of the word only
    replaced: the answer must do without what stands before.

    >>> joined_for_bash("robolink\\nrun\\nworld\\n-p\\nworld\\n:=\\ncl", 6)
    ('robolink\\nrun\\nworld\\n-p\\nworld:=cl', 4, 'world:=')

    Args:
        words: Words of the line, one a line.
        at: Index of the word at the cursor.
    """
    parts = words.split("\n")
    for back in (1, 2):  # the value has been begun, or not
        head, rest = parts[:-back], parts[-back:]
        if at == len(parts) - 1 and head and rest[0] == ":=":
            prefix = f"{head[-1]}:="
            return "\n".join([*head[:-1], prefix + "".join(rest[1:])]), len(head) - 1, prefix
    return words, at, ""


def faults_files(ctx: Context, incomplete: str) -> list[str]:
    """Return the faults files known by name, and folders and YAML files whose paths begin so."""
    with contextlib.suppress(Exception):
        from robolink.workspace import list_faults

        known = [each.stem for each in list_faults(workspace=ctx.params.get("workspace") or None)]
        return offered([*known, *_files(incomplete, (".yaml", ".yml"))], incomplete)
    return []


def _files(incomplete: str, suffixes: tuple[str, ...]) -> list[str]:
    """Return the folders, and the files with these suffixes, whose paths begin so."""
    folder, slash, _ = incomplete.rpartition("/")
    inside = [each for each in Path(folder + slash or ".").iterdir() if each.name[0] != "." or incomplete[-1:] == "."]
    found = [each for each in inside if each.is_dir() or each.suffix in suffixes]
    return [f"{folder}{slash}{each.name}{'/' if each.is_dir() else ''}" for each in found]


def _endpoint_names(incomplete: str, *kinds: Any) -> list[str]:
    return _names(incomplete, lambda each: each.name if getattr(each, "kind", None) in kinds else None)


def _names(incomplete: str, name_of: Callable[[Any], str | None]) -> list[str]:
    """Return names; hidden ones only if one is begun, and without the leading slash if it was left out."""
    names = {name for each in announced() if (name := name_of(each)) is not None}
    if incomplete and not incomplete.startswith("/"):
        names = {each.removeprefix("/") for each in names}
    hidden = any(part.startswith("_") for part in incomplete.split("/"))
    return offered((each for each in names if hidden or not re.search(r"(?:^|/)_", each)), incomplete)


def _types_of(name: Any, incomplete: str, *kinds: Any) -> list[str]:
    from robolink.wire import EndpointToken

    full_name = "/" + str(name or "").lstrip("/")
    types = [
        each.type_name
        for each in announced()
        if isinstance(each, EndpointToken) and each.kind in kinds and each.name == full_name
    ]
    return offered(types, incomplete)


def _type_names(incomplete: str, *kinds: str) -> list[str]:
    with contextlib.suppress(Exception):
        from robolink.interfaces import names

        full = [name for kind in kinds for name in names(kind)]
        short = "/" not in incomplete and incomplete[:1].isupper()  # Twist stands for geometry_msgs/msg/Twist
        return offered((each.rpartition("/")[2] for each in full) if short else full, incomplete)
    return []


def offered(names: Iterable[str], incomplete: str) -> list[str]:
    """Return the names that begin with `incomplete` and need no quotes in any shell, sorted."""
    return sorted({each for each in names if each.startswith(incomplete) and _SAFE.fullmatch(each)})


def announced() -> list[Token]:
    """Return the tokens announced on the environment's domain, as far as they are known after WITHIN seconds."""
    from robolink.wire import parse_token

    texts: dict[str, bool] = {}
    complete = threading.Event()
    # In the background, since opening a session may hang: on a network that does not answer, say.
    threading.Thread(target=_look, args=(texts, complete), name="robolink completion", daemon=True).start()
    waits.wait(complete, WITHIN)
    found = []
    for text, alive in list(texts.items()):
        with contextlib.suppress(Exception):
            if alive:
                found.append(parse_token(text))
    return found


def _look(texts: dict[str, bool], complete: threading.Event) -> None:
    """Collect announced tokens as they become known, and set `complete` when that is all."""
    import os

    from robolink.networks.request import domain_id
    from robolink.transport import connect
    from robolink.wire import graph_pattern

    try:
        domain = domain_id(os.environ)
        session = connect(os.environ.get("ROBOLINK_TRANSPORT") or "zenoh", domain)
        try:
            session.watch(graph_pattern(domain), texts.__setitem__)
            texts.update(dict.fromkeys(session.tokens(graph_pattern(domain)), True))
            complete.set()
        finally:
            session.close()
    except Exception:  # noqa: BLE001, S110 - there is nothing to offer, and nobody to tell
        pass
    finally:
        complete.set()
