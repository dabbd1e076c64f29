"""Policies as files: profiles of nodes in SROS2's XML, in its order, and merged with a file that is there."""

from __future__ import annotations

from pathlib import Path

from robolink.documents.xmltext import Element, make, spell
from robolink.security import files
from robolink.security.policy import KINDS, VERSION, Policy, Profile, Rule, load


def merged(path: Path, found: Policy) -> Policy:
    """Return the policy of a file, if it is there, with what was found added to its profiles."""
    policy = load(path) if path.exists() else {}
    for enclave, profiles in found.items():
        there = policy.setdefault(enclave, [])
        for each in profiles:
            same = [old for old in there if (old.namespace, old.node) == (each.namespace, each.node)]
            if same:
                same[0].rules.extend(rule for rule in each.rules if rule not in same[0].rules)
            else:
                there.append(each)
    return policy


def write_policy(path: Path, policy: Policy) -> None:
    """Write a policy file, whole or not at all."""
    text = '<?xml version="1.0" encoding="UTF-8"?>\n' + spell(_element(policy))
    files.write(path, text.encode())


def _element(policy: Policy) -> Element:
    enclaves = [
        make("enclave", {"path": path}, make("profiles", {}, *map(_profile, sorted(profiles))))
        for path, profiles in sorted(policy.items())
    ]
    return make("policy", {"version": VERSION}, make("enclaves", {}, *enclaves))


def _profile(profile: Profile) -> Element:
    groups: dict[tuple[str, str, bool], list[str]] = {}
    for rule in profile.rules:
        (tag,) = [tag for tag, kinds in KINDS.items() if rule.kind in kinds]
        groups.setdefault((tag, rule.kind, rule.allows), []).append(_short(rule, profile))
    parts = [
        make(tag, {kind: "ALLOW" if allows else "DENY"}, *(make(tag[:-1], text=each) for each in sorted(set(names))))
        for (tag, kind, allows), names in sorted(groups.items())
    ]
    return make("profile", {"node": profile.node, "ns": profile.namespace}, *parts)


def _short(rule: Rule, profile: Profile) -> str:
    """Return a name as a policy writes it: from the node (`~/a`), from its namespace (`a`), or in full."""
    if rule.name.startswith(f"{profile.full_name}/"):
        return "~" + rule.name.removeprefix(profile.full_name)
    below = profile.namespace.rstrip("/") + "/"
    if below != "/" and rule.name.startswith(below):
        return rule.name.removeprefix(below)
    return rule.name[1:] if below == "/" and rule.name.count("/") == 1 else rule.name
