"""Rights of an enclave in a domain: whether it may publish, subscribe, request or reply, as rules of Zenoh's too."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from robolink.exceptions import DocumentError, SecurityError, WireError
from robolink.security import patterns, permissions
from robolink.security.keystore import PERMISSIONS, enclave_of
from robolink.security.patterns import fits
from robolink.security.permissions import Permission
from robolink.system import clocks
from robolink.wire import EndpointKind, graph_pattern, parse_key

VERBS = {"publish": "publish", "subscribe": "subscribe to", "request": "call", "reply": "serve"}
"""Kinds of rights, each as a verb for people."""


class Rights:
    """Set of rights of one enclave in one domain: what is not allowed is denied, and a denial beats what is allowed.

    Args:
        enclave: Enclave whose rights they are.
        given: Its permissions, in any order.
        domain: Domain in which they are asked for.
        source: File that they come from, to name in errors.
        moment: Time at which they are asked for, in seconds since 1970; None is now.
    """

    def __init__(
        self,
        enclave: str,
        given: Iterable[Permission],
        domain: int,
        source: str = "",
        moment: float | None = None,
    ) -> None:
        self.enclave, self.domain, self.source = enclave, domain, source
        own = list(given)
        here = [each for each in own if each.holds_in(domain)]
        elsewhere = {first for each in own for first, _ in each.domains}
        self._made_for = "" if here else ", ".join(map(str, sorted(elsewhere)[:5]))
        """Domains of permissions that hold in others alone."""
        self.turns = {each.begin for each in here if each.allows} | {each.end for each in here if each.allows}
        """Times at which a permission begins or ends to hold."""
        now = clocks.time_of_day() if moment is None else moment
        held = [each for each in here if each.holds_at(now)]
        self.allowed = [each for each in held if each.allows]
        self.denied = [each for each in held if not each.allows]

    def allows(self, kind: str, key: str) -> bool:
        """True if a right is there.

        Args:
            kind: `publish`, `subscribe`, `request` or `reply`.
            key: Key of the topic or service (`robolink.wire.format_key`), or its full name.
        """
        return not self.refusal(kind, key)

    def refusal(self, kind: str, key: str) -> str:
        """Return why a right is not there, with enclave, name and rule; '' if it is. Arguments as for `allows`."""
        name = _name(key, self.domain)
        requested = f"enclave '{self.enclave}' may not {VERBS[kind]} {name or key}"
        if not name:
            return f"{requested}: it is of another domain than {self.domain}"
        for each in self.denied:
            if each.kind == kind and fits(each.name, name):
                return f"{requested}: '{each.name}' is denied ({each.place})"
        if any(each.kind == kind and fits(each.name, name) for each in self.allowed):
            return ""
        domain = f" in domain {self.domain}" if self.domain or self._made_for else ""
        if self._made_for:
            domain += (
                f", its permissions were made for domain {self._made_for}: go there, "
                f"or make them anew with ROS_DOMAIN_ID={self.domain}"
            )
        return f"{requested}: no rule allows it{domain} ({self.source})"

    def require(self, kind: str, key: str) -> None:
        """Raise SecurityError if a right is not there. Arguments as for `allows`."""
        if why := self.refusal(kind, key):
            raise SecurityError(why)

    @property
    def is_withdrawn(self) -> bool:
        """True if everything is denied."""
        return {each.kind for each in self.denied if each.name == "/*"} == set(VERBS)


def load_rights(enclaves: Path, domain: int) -> tuple[dict[str, Rights], list[str]]:
    """Return the rights of all enclaves below a folder, by name, and what is wrong with their files.

    An enclave whose file has a mistake has no rights, nor has one whose permissions have ended or not begun.
    """
    now = clocks.time_of_day()
    found: dict[str, Rights] = {}
    mistakes: list[str] = []
    for path in sorted(enclaves.rglob(PERMISSIONS)):
        name = enclave_of(path, enclaves)
        try:
            given = permissions.load(path)
        except DocumentError as error:
            mistakes.append(str(error))
            given = []
        if why := permissions.outside((each for each in given if each.holds_in(domain)), now):
            mistakes.append(why)
        found[name] = Rights(name, given, domain, str(path), now)
    return found, mistakes


def _name(key: str, domain: int) -> str:
    """Return the name of a topic or service from its key; '' for one of another domain."""
    if key.startswith("/"):
        return key
    try:
        parsed = parse_key(key)
    except WireError:
        return ""
    return parsed.name if parsed.domain == domain else ""


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
    """Return the setting `access_control` of a session: rules for the remote side of each link, by its certificate.

    Zenoh denies what no rule allows, and a rule that denies beats those that allow. Each session holds the rules of all
    enclaves, for what comes in and for what goes out, so that a peer that brings no rules of its own gets nothing
    through.

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

    published, heard = beside("publish", "pub"), beside("subscribe", "pub")
    yield _PUT, keys("publish") + published
    yield ("declare_subscriber",), keys("subscribe") + heard
    yield (_ASK,), keys("request") + heard
    yield ("declare_queryable",), keys("reply") + published
    graph = [graph_pattern(domain)]
    if flow == "ingress":
        yield ("liveliness_token",), _tokens(rights, held, allow=allow) + published + beside("subscribe", "sub")
    elif allow:
        yield ("liveliness_token",), graph + published + beside("subscribe", "sub")
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
