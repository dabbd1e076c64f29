"""Enclaves of a launch file: whether each has keys, and whether it may do what its node does."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence

from robolink.exceptions import DocumentError, RobolinkError
from robolink.launch.entry import Entry
from robolink.launch.looking.look import End, Look
from robolink.launch.protection import unprotected
from robolink.networks.asked import domain_id
from robolink.security import session
from robolink.security.rights import Rights
from robolink.security.session import Security
from robolink.system.variables import environment_with
from robolink.wire import EndpointKind


def enclave_errors(entries: Iterable[Entry], looks: Mapping[str, Look]) -> Iterator[DocumentError]:
    """Yield an error for each node whose enclave has no keys, and for each name that its enclave has no right to.

    Nothing is wrong where ROS_SECURITY_ENABLE is not true.

    Args:
        entries: Nodes and commands of a system; commands are passed over.
        looks: What the nodes have, by the names of their entries.
    """
    known: dict[tuple[tuple[str, str], ...], Security | str | None] = {}
    for each in entries:
        if each.source is None:
            continue
        asked = _asked(each)
        if asked not in known:
            known[asked] = _security(dict(asked), each.node.enclave)
        found = known[asked]
        if isinstance(found, str):
            yield each.error(["enclave"], f"'{each.name}' cannot be started: {found}")
        elif found is not None:
            for reason in dict.fromkeys(_refusals(found.rights, looks.get(each.name, Look()).ends)):
                yield each.error(["enclave"], f"'{each.name}': {reason}")


def enclave_notes(entries: Sequence[Entry]) -> Iterator[str]:
    """Yield a note where the environment switches off what a launch file says of enclaves, or says otherwise."""
    yield from unprotected(entries, os.environ)
    named = [each for each in entries if each.node.enclave]
    for each in named:
        environ = environment_with(each.node.env)
        override = environ.get(session.OVERRIDE)
        try:
            if not session.is_on(environ):
                yield f"enclaves were not looked into: {session.ENABLE} is not true"
            elif override and override != each.node.enclave:
                yield f"{each.name} gets the enclave '{override}' of {session.OVERRIDE}, and not '{each.node.enclave}'"
        except RobolinkError:
            return  # which is an error


def _asked(entry: Entry) -> tuple[tuple[str, str], ...]:
    """Return what decides about the security of a node: the variables, and the enclave that counts."""
    environ = environment_with(entry.node.env)
    chosen = {name: value for name, value in environ.items() if name.startswith("ROS_")}
    return tuple(sorted({**chosen, session.OVERRIDE: chosen.get(session.OVERRIDE) or entry.node.enclave}.items()))


def _security(environ: Mapping[str, str], enclave: str) -> Security | str | None:
    """Return the security of a node; why there is none; None where none is asked for."""
    try:
        return session.wanted(environ, domain_id(environ), enclave or None)
    except (RobolinkError, ValueError) as error:
        return str(error)


def _refusals(rights: Rights, ends: Iterable[End]) -> Iterator[str]:
    for each in ends:
        if why := rights.refusal(session.KINDS[EndpointKind(each.kind)], each.name):
            yield why
