"""Permissions of an enclave (permissions.xml): DDS's rules, in which SROS2 keeps what a policy allows."""

from __future__ import annotations

import datetime
import math
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from robolink.documents.xmltext import Element, make, read, spell
from robolink.security import patterns
from robolink.security.policy import Profile, Rule

SERVICES = (
    *("describe_parameters", "get_parameter_types", "get_parameters", "list_parameters"),
    *("set_parameters", "set_parameters_atomically", "get_type_description"),
)
"""Services that every node has."""

COMMANDS = "/_robolink_cli_*"
"""Services of the nodes through which commands speak (`robolink pub` describes its types)."""

_IMPLIED = (
    *(("publish", "/rosout"), ("publish", "/parameter_events"), ("subscribe", "/parameter_events")),
    *(("subscribe", "/clock"), ("reply", COMMANDS)),
)
_GOALS, _NEWS = ("send_goal", "cancel_goal", "get_result"), ("feedback", "status")
_TIME = re.compile(r"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d)(?:\.\d+)?(Z|[+-]\d\d:\d\d)?", re.ASCII)
_SCHEMA = "http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd"


class Permission(NamedTuple):
    """A right, or its denial, of an enclave."""

    kind: str
    """`publish`, `subscribe`, `request` or `reply`."""
    allows: bool
    name: str
    """Full name, or a pattern (`robolink.security.patterns`)."""
    domains: tuple[tuple[int, int], ...]
    """First and last of the domains in which it holds."""
    place: str
    """File and line."""
    begin: float = -math.inf
    """Time from which it holds, in seconds since 1970."""
    end: float = math.inf
    """Time from which it holds no longer."""

    def holds_in(self, domain: int) -> bool:
        """True if it holds in a domain."""
        return any(first <= domain <= last for first, last in self.domains)

    def holds_at(self, moment: float) -> bool:
        """True if it holds at a time in seconds since 1970. A denial holds at any."""
        return not self.allows or self.begin <= moment < self.end


def expanded(profiles: Iterable[Profile]) -> list[Rule]:
    """Return the rules of profiles, those of actions as their topics and services, and what every node needs.

    A node needs /rosout, /parameter_events, /clock and its own services; a rule that denies one of them still holds.
    """
    rules: list[Rule] = []
    for profile in profiles:
        for rule in profile.rules:
            rules += _parts_of(rule)
        if any(rule.allows for rule in profile.rules):
            rules += [Rule(kind, True, name) for kind, name in _IMPLIED]
            rules += [Rule("reply", True, f"{profile.full_name}/{service}") for service in SERVICES]
    return list(dict.fromkeys(rules))


def _parts_of(rule: Rule) -> list[Rule]:
    """Return the rules of an action's parts, or the rule itself."""
    if rule.kind not in ("call", "execute"):
        return [rule]
    asks, hears = ("request", "subscribe") if rule.kind == "call" else ("reply", "publish")
    parts = [(asks, each) for each in _GOALS] + [(hears, each) for each in _NEWS]
    if rule.name.endswith("*"):  # what fits it has its parts below it
        return [Rule(kind, rule.allows, rule.name) for kind in (asks, hears)]
    return [Rule(kind, rule.allows, f"{rule.name}/_action/{part}") for kind, part in parts]


def write(
    enclave: str, rules: Iterable[Rule], domain: int, valid: tuple[datetime.datetime, datetime.datetime]
) -> bytes:
    """Return the text of a permissions.xml.

    Args:
        enclave: Enclave whose permissions they are.
        rules: Rules without actions, of `expanded`.
        domain: Domain in which they hold.
        valid: Times from and until which they hold.
    """
    begin, end = (each.replace(tzinfo=None, microsecond=0).isoformat() for each in valid)
    known = list(rules)
    grant = make(
        "grant",
        {"name": enclave},
        make("subject_name", text=f"CN={enclave}"),
        make("validity", {}, make("not_before", text=begin), make("not_after", text=end)),
        *_block("deny_rule", [each for each in known if not each.allows], domain),
        *_block("allow_rule", [each for each in known if each.allows], domain),
        make("default", text="DENY"),
    )
    space = {
        "xmlns:xsi": "http://www.w3.org/2001/XMLSchema-instance",
        "xsi:noNamespaceSchemaLocation": _SCHEMA,
    }
    return spell(make("dds", space, make("permissions", {}, grant))).encode()


def _block(tag: str, rules: list[Rule], domain: int) -> Iterator[Element]:
    topics: dict[str, set[str]] = {"publish": set(), "subscribe": set()}
    for rule in rules:
        for way, topic in _dds(rule):
            topics[way].add(topic)
    parts = [
        make(way, {}, make("topics", {}, *(make("topic", text=each) for each in sorted(found))))
        for way, found in topics.items()
        if found
    ]
    if parts:
        yield make(tag, {}, make("domains", {}, make("id", text=str(domain))), *parts)


def _dds(rule: Rule) -> list[tuple[str, str]]:
    match rule.kind:
        case "publish" | "subscribe":
            return [(rule.kind, f"rt{rule.name}")]
        case "request":
            return [("publish", f"rq{rule.name}Request"), ("subscribe", f"rr{rule.name}Reply")]
    return [("subscribe", f"rq{rule.name}Request"), ("publish", f"rr{rule.name}Reply")]


def load(path: Path) -> list[Permission]:
    """Read a permissions.xml; raises DocumentError for what is not such a file, or names that robolink cannot read."""
    root = read(path)
    if root.tag != "dds":
        raise root.mistake(f"expected <dds>, got <{root.tag}>")
    found: list[Permission] = []
    for grant in root.all("permissions", "grant"):
        begin, end = _validity(grant)
        for block in grant.children:
            if block.tag in ("allow_rule", "deny_rule"):
                found += _permissions(block, begin, end)
    return found


def outside(given: Iterable[Permission], moment: float) -> str:
    """Return why some of an enclave's permissions do not hold at a time in seconds since 1970; '' if all do."""
    for each in given:
        if not each.holds_at(moment):
            word, when = ("ended", each.end) if moment >= each.end else ("begin", each.begin)
            spelled = datetime.datetime.fromtimestamp(when, datetime.timezone.utc).strftime("%Y-%m-%d %H:%M:%S")
            return f"{each.place.rpartition(':')[0]}: these permissions {word} at {spelled} UTC, and count only within"
    return ""


def _validity(grant: Element) -> tuple[float, float]:
    """Return the times between which a grant holds; without them, as in no file of SROS2's, it always does."""
    begin = [_moment(each) for each in grant.all("validity", "not_before")]
    end = [_moment(each) for each in grant.all("validity", "not_after")]
    return max(begin, default=-math.inf), min(end, default=math.inf)


def _moment(element: Element) -> float:
    """Return a time of XML Schema in seconds since 1970: UTC, unless it names its zone."""
    found = _TIME.fullmatch(element.text)
    try:
        if found:
            zone = (found[2] or "Z").replace("Z", "+00:00")
            return datetime.datetime.fromisoformat(found[1] + zone).timestamp()
    except (ValueError, OverflowError):  # 31 February; before the year 1
        pass
    raise element.mistake(f"<{element.tag}> is a time such as 2036-01-31T12:00:00, got '{element.text[:40]}'")


def _permissions(block: Element, begin: float, end: float) -> Iterator[Permission]:
    domains = tuple(_domains(block))
    for way in ("publish", "subscribe"):
        for topic in block.all(way, "topics", "topic"):
            kind, name = _right(way, topic.text)
            if not kind:
                continue
            if wrong := patterns.problem(name):
                raise topic.mistake(f"<topic>{topic.text}: {wrong}")
            place = f"{topic.file}:{topic.line}"
            yield Permission(kind, block.tag == "allow_rule", name, domains, place, begin, end)


def _right(way: str, topic: str) -> tuple[str, str]:
    """Return the right that a topic of DDS stands for, and the name; '' for replies, which their request implies."""
    if topic.startswith("rt/"):
        return way, topic[2:]
    if topic.startswith("rq/") and topic.endswith("Request"):
        return ("request" if way == "publish" else "reply"), topic[2:].removesuffix("Request")
    return "", ""


def _domains(block: Element) -> Iterator[tuple[int, int]]:
    for each in block.all("domains", "id"):
        yield _number(each), _number(each)
    for each in block.all("domains", "id_range"):
        first = [_number(low) for low in each.all("min")] or [0]
        last = [_number(high) for high in each.all("max")] or [232]
        yield first[0], last[0]


def _number(element: Element) -> int:
    if not re.fullmatch(r"[0-9]{1,3}", element.text):
        raise element.mistake(f"a domain is a number from 0 to 232, got '{element.text[:40]}'")
    return int(element.text)
