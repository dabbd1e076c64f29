"""Profiles of the nodes that run: what each publishes, hears, serves and calls, in the words of a policy."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.node_parts.losses import TOPIC
from robolink.security.policy import Policy, Profile, Rule
from robolink.security.session import KINDS

if TYPE_CHECKING:
    from robolink.context import Context


def profiles_of_graph(context: Context) -> Policy:
    """Return the profiles of all nodes, by enclave, but for nodes whose names begin with `_`.

    A node that subscribes to something may publish /diagnostics: from its first loss on it does.
    """
    graph = context.graph
    found: Policy = {}
    for node in graph.nodes():
        if node.node_name.startswith("_"):
            continue
        rules = {
            Rule(word, True, each.name)
            for kind, word in KINDS.items()
            for each in graph.of_node(node.node_name, node.namespace, kind)
        }
        if any(rule.kind == "subscribe" for rule in rules):
            rules.add(Rule("publish", True, TOPIC))
        found.setdefault(node.enclave, []).append(Profile(node.namespace, node.node_name, sorted(rules)))
    return found
