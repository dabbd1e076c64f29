"""Zenoh's access control from the rights of enclaves: rules for the remote side of each link, by its certificate.

Zenoh denies what no rule allows, and a rule that denies beats those that allow. Each session holds the rules of all
enclaves, for what comes in and for what goes out, so that a peer that brings no rules of its own gets nothing through.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from robolink.security import patterns
from robolink.security.permissions import Permission
from robolink.security.rights import Rights
from robolink.wire import EndpointKind, graph_pattern

MESSAGES = (
    *("put", "delete", "declare_subscriber", "query", "reply", "declare_queryable"),
    *("liveliness_token", "liveliness_query", "declare_liveliness_subscriber"),
)
"""Kinds of messages that Zenoh's access control knows."""

_ENDPOINTS = {
    "publish": EndpointKind.PUBLISHER,
    "subscribe": EndpointKind.SUBSCRIPTION,
    "reply": EndpointKind.SERVICE,
    "request": EndpointKind.CLIENT,
}
_PUT, _ASK, _LOOK = ("put", "delete"), "query", ("liveliness_query", "declare_liveliness_subscriber")
_OTHER_SIDE = {"publish": "subscribe", "subscribe": "publish", "request": "reply", "reply": "request"}
"""The use of this side that meets each right of an enclave."""

Keys = list[str]
Expressions = Callable[[str], Keys]


def control(
    enclaves: Mapping[str, Rights], domain: int, *, trusted: Iterable[str] = (), interfaces: Iterable[str] = ()
) -> dict[str, Any]:
    """Return the setting `access_control` of a session.

    Args:
        enclaves: Rights by enclave; their domain is `domain`.
        domain: Domain of the session.
        trusted: Enclaves with which everything may be exchanged: routers.
        interfaces: Network interfaces to which all is confined; none for no such limit.
    """
    rules: dict[str, dict[str, Any]] = {}
    subjects: list[dict[str, Any]] = []
    policies: list[dict[str, Any]] = []
    confined = {"interfaces": sorted(interfaces)} if interfaces else {}
    everybody = {name: everything() if name in trusted else list(rules_of(enclaves[name])) for name in enclaves}
    for name, own in everybody.items():
        if not own:
            continue  # Zenoh refuses a policy without rules; nothing is what it has anyway
        # Most rules are those of several enclaves: each is written once, since Zenoh reads 8 MB/s of this.
        known = [rules.setdefault(json.dumps(rule), rule | {"id": str(len(rules))})["id"] for rule in own]
        subjects.append({"id": name, "cert_common_names": [name]} | confined)
        policies.append({"rules": known, "subjects": [name]})
    lists = {"rules": [*rules.values()], "subjects": subjects, "policies": policies} if rules else {}
    return {"enabled": True, "default_permission": "deny", "rules": [], "subjects": [], "policies": []} | lists


def everything(*, allow: bool = True) -> list[dict[str, Any]]:
    """Return the rule that allows, or denies, all messages on all keys."""
    # ** does not match what begins with @: the graph and the history of latched topics.
    return [_rule(("ingress", "egress"), MESSAGES, ["**", "@ros2_lv/**", "**/@adv/**"], allow=allow)]


def rules_of(rights: Rights) -> Iterator[dict[str, Any]]:
    """Yield the rules for one enclave."""
    if rights.is_withdrawn:
        yield from everything(allow=False)
        return
    for allow, held in ((True, rights.allowed), (False, rights.denied)):
        if not held:
            continue
        for flow in ("ingress", "egress"):
            for messages, keys in _table(rights, held, flow, allow=allow):
                if keys:
                    yield _rule((flow,), messages, keys, allow=allow)


def _table(
    rights: Rights, held: list[Permission], flow: str, *, allow: bool
) -> Iterator[tuple[tuple[str, ...], list[str]]]:
    """Yield messages and their keys: for what an enclave sends (ingress), or what is sent to it, its mirror image."""
    domain = rights.domain
    names = _by_kind(held, mirrored=flow == "egress")

    def keys(*kinds: str) -> list[str]:
        return [key for kind in kinds for name in names[kind] for key in patterns.keys(name, domain)]

    def beside(kind: str, end: str) -> list[str]:
        return [key for name in names[kind] for key in patterns.beside(name, domain, end)]

    kept, heard = beside("publish", "pub"), beside("subscribe", "pub")
    yield _PUT, keys("publish") + kept
    yield ("declare_subscriber",), keys("subscribe") + heard
    yield (_ASK,), keys("request") + heard
    yield ("declare_queryable",), keys("reply") + kept
    graph = [graph_pattern(domain)]
    if flow == "ingress":
        yield ("liveliness_token",), _tokens(rights, held, allow=allow) + kept + beside("subscribe", "sub")
    elif allow:
        yield ("liveliness_token",), graph + kept + beside("subscribe", "sub")
    if allow:
        yield ("reply",), keys("publish", "reply")
        yield _LOOK, graph + heard + beside("publish", "sub")


def _by_kind(held: list[Permission], *, mirrored: bool) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {kind: [] for kind in _ENDPOINTS}
    for each in held:
        found[_OTHER_SIDE[each.kind] if mirrored else each.kind].append(each.name)
    return {kind: list(dict.fromkeys(names)) for kind, names in found.items()}


def _tokens(rights: Rights, held: list[Permission], *, allow: bool) -> list[str]:
    """Return the tokens that an enclave may declare: its nodes', and those of endpoints that it may have."""
    start, own = f"@ros2_lv/{rights.domain}/*/*/*", f"{patterns.mangled(rights.enclave)}/*/*"
    nodes = [f"{start}/NN/{own}/**"] if allow else []
    ends = [f"{start}/{_ENDPOINTS[each.kind].value}/{own}/{patterns.mangled(each.name)}/**" for each in held]
    return [*nodes, *dict.fromkeys(ends)]


def _rule(flows: tuple[str, ...], messages: Iterable[str], keys: list[str], *, allow: bool) -> dict[str, Any]:
    return {
        "permission": "allow" if allow else "deny",
        "flows": list(flows),
        "messages": list(messages),
        "key_exprs": list(dict.fromkeys(keys)),
    }
