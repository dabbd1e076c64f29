"""What the shell completes: live names of nodes, topics and services, types, and what can be run or launched.

A completion never prints an error and never takes long: what goes wrong or comes too late is not offered.
"""

from __future__ import annotations

import contextlib
import re
import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from robolink.graph import Token

WITHIN = 0.3
"""Seconds that a look at the network may take."""

_SAFE = re.compile(r"[A-Za-z0-9_./:~-]+", re.ASCII)
"""What a shell takes as it is. zsh evaluates what it is offered, and anybody may announce a name."""

Context = typer.Context


def node_names(incomplete: str) -> list[str]:
    """Give the full names of the nodes that are there."""
    from robolink.wire import NodeToken

    return _names(incomplete, lambda each: each.full_node_name if isinstance(each, NodeToken) else None)


def topic_names(incomplete: str) -> list[str]:
    """Give the names of the topics that are there."""
    from robolink.wire import EndpointKind

    return _endpoint_names(incomplete, EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)


def service_names(incomplete: str) -> list[str]:
    """Give the names of the services that are served."""
    from robolink.wire import EndpointKind

    return _endpoint_names(incomplete, EndpointKind.SERVICE)


def type_of_topic(ctx: Context, incomplete: str) -> list[str]:
    """Give the types that the topic on the command line has; all types of messages if it has none."""
    from robolink.wire import EndpointKind

    kinds = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
    return _types_of(ctx.params.get("topic"), incomplete, *kinds) or message_types(incomplete)


def type_of_service(ctx: Context, incomplete: str) -> list[str]:
    """Give the types that the service on the command line has; all types of services if it has none."""
    from robolink.wire import EndpointKind

    return _types_of(ctx.params.get("service"), incomplete, EndpointKind.SERVICE) or service_types(incomplete)


def message_types(incomplete: str) -> list[str]:
    """Give the types of messages."""
    return _type_names(incomplete, "msg")


def service_types(incomplete: str) -> list[str]:
    """Give the types of services."""
    return _type_names(incomplete, "srv")


def action_types(incomplete: str) -> list[str]:
    """Give the types of actions."""
    return _type_names(incomplete, "action")


def interface_types(incomplete: str) -> list[str]:
    """Give the types of messages, services and actions."""
    return _type_names(incomplete, "msg", "srv", "action")


def interface_packages(incomplete: str) -> list[str]:
    """Give the packages that have types."""
    return offered({each.partition("/")[0] for each in _type_names("", "msg", "srv", "action")}, incomplete)


def runnable_nodes(ctx: Context, incomplete: str) -> list[str]:
    """Give the nodes that `robolink run` knows by name, and the packages that have some."""
    with contextlib.suppress(Exception):
        from robolink.workspace import list_executables, list_nodes

        workspace = ctx.params.get("workspace") or None
        nodes = [each.name for each in list_nodes(workspace=workspace)]
        return offered([*nodes, *list_executables(workspace=workspace)], incomplete)
    return []


def package_executables(ctx: Context, incomplete: str) -> list[str]:
    """Give what can be run in the package that stands before it; nothing after a node's name."""
    with contextlib.suppress(Exception):
        from robolink.workspace import find_package, named_executables

        package, workspace = str(ctx.params.get("node") or ""), ctx.params.get("workspace") or None
        folder = None if ctx.params.get("args") else find_package(package, workspace=workspace)
        if folder is not None:
            return offered((each.name for each in named_executables(folder)), incomplete)
    return []


def launch_words(ctx: Context, incomplete: str) -> list[str]:
    """Give the launch files that are known by name; after one its arguments, after stop and restart what runs."""
    with contextlib.suppress(Exception):
        from robolink.workspace import find_launch, list_launches

        words, workspace = list(ctx.params.get("words") or []), ctx.params.get("workspace") or None
        if not words:
            return offered((each.stem for each in list_launches(workspace=workspace)), incomplete)
        if words[0] in ("stop", "restart"):
            from robolink.cli.running import names_for

            return offered(names_for(words, WITHIN), incomplete)
        from robolink.launch.reading.arguments import arguments_of

        names = [each.name for each in arguments_of(find_launch(words[0], workspace=workspace))]
        return [f"{each}:=" for each in offered(names, incomplete)]
    return []


def world_files(ctx: Context, incomplete: str) -> list[str]:
    """Give the worlds that are known by name, and the folders and world files that begin so."""
    with contextlib.suppress(Exception):
        from robolink.workspace import list_worlds

        known = [each.stem for each in list_worlds(workspace=ctx.params.get("workspace") or None)]
        return offered([*known, *_files(incomplete, (".yaml", ".yml", ".wbt"))], incomplete)
    return []


def faults_files(ctx: Context, incomplete: str) -> list[str]:
    """Give the faults files that are known by name, and the folders and YAML files that begin so."""
    with contextlib.suppress(Exception):
        from robolink.workspace import list_faults

        known = [each.stem for each in list_faults(workspace=ctx.params.get("workspace") or None)]
        return offered([*known, *_files(incomplete, (".yaml", ".yml"))], incomplete)
    return []


def _files(incomplete: str, suffixes: tuple[str, ...]) -> list[str]:
    """Give the folders, and the files of these kinds, whose paths begin so."""
    folder, slash, _ = incomplete.rpartition("/")
    found = [each for each in Path(folder + slash or ".").iterdir() if each.is_dir() or each.suffix in suffixes]
    return [f"{folder}{slash}{each.name}{'/' if each.is_dir() else ''}" for each in found]


def _endpoint_names(incomplete: str, *kinds: Any) -> list[str]:
    return _names(incomplete, lambda each: each.name if getattr(each, "kind", None) in kinds else None)


def _names(incomplete: str, name_of: Callable[[Any], str | None]) -> list[str]:
    """Offer names; hidden ones only to whoever begins one, and without their slash to whoever leaves it out."""
    names = {name for each in announced() if (name := name_of(each)) is not None}
    if incomplete and not incomplete.startswith("/"):
        names = {each.removeprefix("/") for each in names}
    hidden = any(part.startswith("_") for part in incomplete.split("/"))
    return offered((each for each in names if hidden or not re.search(r"(?:^|/)_", each)), incomplete)


def _types_of(name: Any, incomplete: str, *kinds: Any) -> list[str]:
    from robolink.wire import EndpointToken

    wanted = "/" + str(name or "").lstrip("/")
    types = [
        each.type_name
        for each in announced()
        if isinstance(each, EndpointToken) and each.kind in kinds and each.name == wanted
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
    """Give those names that begin so and that every shell takes as they are, sorted."""
    return sorted({each for each in names if each.startswith(incomplete) and _SAFE.fullmatch(each)})


def announced() -> list[Token]:
    """List what is announced on the domain of the environment, as far as it is known after WITHIN seconds."""
    from robolink.wire import parse_token

    texts: dict[str, bool] = {}
    complete = threading.Event()
    # In the background, since opening a session may hang: on a network that does not answer, say.
    threading.Thread(target=_look, args=(texts, complete), name="robolink completion", daemon=True).start()
    complete.wait(WITHIN)
    found = []
    for text, alive in list(texts.items()):
        with contextlib.suppress(Exception):
            if alive:
                found.append(parse_token(text))
    return found


def _look(texts: dict[str, bool], complete: threading.Event) -> None:
    """Note what is announced as it becomes known; `complete` is set when that is all."""
    import os

    from robolink.transport import connect
    from robolink.transport.network import domain_id
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
