"""Validation of a system without starting it: compares a launch file with what its nodes declare."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import msgspec

from robolink.arguments.remapping import parse_remap_rule
from robolink.exceptions import DocumentError, RobolinkError, nearest
from robolink.expand_topic_name import expand_topic_name
from robolink.launch.beside import unprotected
from robolink.launch.entry import Entry
from robolink.launch.looking.graph import Use, uses_of
from robolink.launch.looking.look import End, Look, looks_of
from robolink.launch.planning import core_errors, processes
from robolink.launch.readiness import awaited
from robolink.networks.request import domain_id
from robolink.security import session
from robolink.security.rights import Rights
from robolink.security.session import Security
from robolink.system.processes import environment_with
from robolink.wire import EndpointKind


class Report(NamedTuple):
    """Mistakes, and notes about nodes that could not be checked."""

    mistakes: list[DocumentError]
    notes: list[str]
    """Nodes that could not be inspected, and why."""


class Found(msgspec.Struct):
    """A mistake in a machine-readable form; lines and columns count from 1."""

    file: str
    line: int
    column: int
    message: str


def validate(entries: Sequence[Entry]) -> Report:
    """Check a system by constructing every node in a child process; mistakes begin with file:line:column."""
    mistakes: list[DocumentError] = []
    try:
        processes(entries)
    except DocumentError as error:
        mistakes.append(error)
    found = judged(entries, looks_of(entries))
    return Report([*mistakes, *(each for each in found.mistakes if str(each) not in map(str, mistakes))], found.notes)


def judged(entries: Sequence[Entry], looks: Mapping[str, Look]) -> Report:
    """Check a system by the results of `looks_of`."""
    notes = [f"{each.name} was not looked into: {reason}" for each in entries if (reason := _unseen(each, looks))]
    mistakes = [*core_errors(entries), *_load_errors(entries, looks)]
    for each in entries:
        mistakes += _parameter_errors(each, looks.get(each.name, Look()))
    mistakes += _wide_errors(entries, looks)
    mistakes += _remapping_errors(entries, looks)
    mistakes += _type_errors(entries, looks)
    mistakes += enclave_errors(entries, looks)
    notes += enclave_notes(entries)
    named = {each.full_name: each for each in entries}
    is_all_known = all(each.name in looks and _is_known(looks[each.name]) for each in entries)
    for each in entries if is_all_known else ():
        for mistake, text in _waiting(each, named, looks):
            if mistake:
                mistakes.append(each.error(["start_after"], text))
            else:
                notes.append(text)
    once = {str(each): each for each in mistakes}  # copies of a node are wrong in the same place
    return Report(list(once.values()), list(dict.fromkeys(notes)))


def found(error: DocumentError) -> Found:
    """Convert an error to its machine-readable form."""
    return Found(error.file, error.line, error.column, error.message)


def _unseen(entry: Entry, looks: Mapping[str, Look]) -> str:
    look = looks.get(entry.name)
    if look is None:
        return "it is a command"
    if look.unseen or (look.error and not _has_own_terminal(entry)):
        return look.unseen
    return look.error or ("" if look.nodes else "it makes no node")


def _has_own_terminal(entry: Entry) -> bool:
    """True if a program is to read keys, which nobody can do here: from the terminal, or in that of its prefix."""
    return entry.node.interactive or bool(entry.node.prefix)


def _is_checked(look: Look) -> bool:
    """True if what is given to a program is known to arrive: others, such as viewers, make no node here."""
    return _is_known(look) and bool(look.nodes)


def _is_known(look: Look) -> bool:
    """True if a node was inspected completely: it will never have more than it has now."""
    return not (look.error or look.unseen or look.is_open)


def _load_errors(entries: Iterable[Entry], looks: Mapping[str, Look]) -> Iterator[DocumentError]:
    for each in entries:
        look = looks.get(each.name)
        if look is not None and look.error and not _has_own_terminal(each):
            yield each.error(["node"], f"'{each.name}' cannot be started: {look.error}")


# Parameters


def _parameter_errors(entry: Entry, look: Look) -> Iterator[DocumentError]:
    for name in entry.node.parameters:
        if name in look.refused:
            yield entry.error(["parameters", name], look.refused[name])
        elif name not in look.declared and name not in entry.wide and entry.source is not None and _is_checked(look):
            reason = f"'{entry.name}' declares no parameter '{name}'{nearest(name, look.declared)}"
            yield entry.error(["parameters", name], reason, key=True)


def _wide_errors(entries: Sequence[Entry], looks: Mapping[str, Look]) -> Iterator[DocumentError]:
    """Yield an error for each parameter that was given to several nodes and that none of them declares."""
    for wide in sorted({name for each in entries for name in each.wide}):
        concerned = [each for each in entries if wide in each.wide]
        seen = [looks.get(each.name, Look(unseen="a command")) for each in concerned]
        seen = [each for each in seen if each.nodes or not _is_known(each)]
        if seen and all(map(_is_known, seen)) and not any(wide in each.declared for each in seen):
            declared = {name for each in seen for name in each.declared}
            reason = f"no node that gets it declares a parameter '{wide}'{nearest(wide, declared)}"
            yield concerned[0].error(["parameters", wide], reason, key=True)


# Remappings


def _remapping_errors(entries: Iterable[Entry], looks: Mapping[str, Look]) -> Iterator[DocumentError]:
    """Yield an error for each remapping that renames nothing; of a group or of copies, one match is enough."""
    errors: dict[tuple[str, int, int], DocumentError] = {}
    useful: set[tuple[str, int, int]] = set()
    for each in entries:
        look = looks.get(each.name)
        for match, replacement in each.node.remappings.items():
            said = each.error(["remappings", match], "", key=True)
            place = (said.file, said.line, said.column)
            if look is None or not _is_checked(look) or _renames(f"{match}:={replacement}", look):
                useful.add(place)
                continue
            names = {end.name for end in look.ends} | {end.name.rpartition("/")[2] for end in look.ends}
            names |= each.node.remappings.keys() - {match}  # what the others rename is no longer called so
            reason = f"'{each.name}' has nothing that is called '{match}'{nearest(match, names)}"
            errors[place] = each.error(["remappings", match], reason, key=True)
    yield from (error for place, error in errors.items() if place not in useful)


def _renames(rule: str, look: Look) -> bool:
    """True if something of a node has the new name that a rule gives."""
    parsed = parse_remap_rule(rule)
    if not parsed.match:  # of the node itself
        return True
    names = {each.name.partition("/_action/")[0] for each in look.ends} | {each.name for each in look.ends}
    for full_name in look.nodes:
        namespace, _, name = full_name.rpartition("/")
        if expand_topic_name(parsed.replacement, name, namespace or "/") in names:
            return True
    return False


# Types


def _type_errors(entries: Iterable[Entry], looks: Mapping[str, Look]) -> Iterator[DocumentError]:
    """Yield an error for each name with two types: whoever publishes or serves is right, else the first."""
    users: dict[tuple[str, str], list[tuple[Entry, Use]]] = {}
    for entry in entries:
        for use in uses_of(looks.get(entry.name, Look())):
            users.setdefault((use.kind, use.name), []).append((entry, use))
    for (kind, name), all_of_one in users.items():
        first, right = next((each for each in all_of_one if each[1].offers), all_of_one[0])
        for entry, use in all_of_one:
            if (use.type, use.hash) != (right.type, right.hash):
                what = f"another {use.type}" if use.type == right.type else f"{right.type}"
                reason = (
                    f"'{entry.name}' {use.verb} {kind} {name} as {use.type}, but '{first.name}' {right.verb} {what}"
                )
                yield entry.error(["node"], reason)


# What is waited for


def _waiting(entry: Entry, named: Mapping[str, Entry], looks: Mapping[str, Look]) -> Iterator[tuple[bool, str]]:
    """Yield a text for each awaited name that this system does not offer, and True if that is a mistake, not a note.

    It is a mistake if a node is announced by another name, or if something similar is offered.

    Call it only if every node was inspected: else one of the others may offer it.
    """
    others = [look for name, look in looks.items() if name != entry.name]
    for each in awaited(entry, named):
        text = f"'{entry.name}' waits for {each.kind} {each.names[0]}, which"
        if each.kind == "node":
            nodes = looks[each.names[0].removeprefix("/")].nodes
            if not set(nodes) & set(each.names):
                yield True, f"{text} is announced as {' and '.join(nodes) or 'nothing'}: give it a `name`"
            continue
        offers = "MP" if each.kind == "topic" else "SS"
        offered = {end.name for look in others for end in look.ends if end.kind == offers}
        if offered.isdisjoint(each.names):
            near = nearest(each.names[0], offered)
            yield bool(near), f"{text} no other node of this system has{near}"


# Enclaves


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
        key = _security_key(each)
        if key not in known:
            known[key] = _security(dict(key), each.node.enclave)
        found = known[key]
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


def _security_key(entry: Entry) -> tuple[tuple[str, str], ...]:
    """Return the variables and the enclave that decide about the security of a node."""
    environ = environment_with(entry.node.env)
    chosen = {name: value for name, value in environ.items() if name.startswith("ROS_")}
    return tuple(sorted({**chosen, session.OVERRIDE: chosen.get(session.OVERRIDE) or entry.node.enclave}.items()))


def _security(environ: Mapping[str, str], enclave: str) -> Security | str | None:
    """Return the security of a node; why there is none; None where security is off."""
    try:
        return session.requested(environ, domain_id(environ), enclave or None)
    except (RobolinkError, ValueError) as error:
        return str(error)


def _refusals(rights: Rights, ends: Iterable[End]) -> Iterator[str]:
    for each in ends:
        if why := rights.refusal(session.KINDS[EndpointKind(each.kind)], each.name):
            yield why
