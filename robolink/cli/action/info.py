"""Output of `robolink action info`: the servers of an action, and its clients."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.cli.shared.graph import absolute, endpoints, sections_of
from robolink.cli.shared.output import say, say_json
from robolink.cli.shared.session import looking
from robolink.exceptions import NotFoundError
from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.wire import EndpointToken

TITLES = {"Action clients": "Action Clients", "Action servers": "Action Servers"}
"""Printed titles, each with the section of `node info` that it is made from."""


def show(action: str, *, types: bool, count: bool, as_json: bool) -> None:
    """Show the servers and clients. Raises NotFoundError for an action that has neither."""
    name = absolute(action)
    with looking() as context:
        nodes = _nodes(endpoints(context))
    users = {
        title: {node: used[title][name] for node, used in nodes.items() if name in used[title]} for title in TITLES
    }
    if not any(users.values()):
        known = {each for used in nodes.values() for actions in used.values() for each in actions}
        raise NotFoundError("action", shown(name), known, f"domain {context.get_domain_id()}")
    if as_json:
        say_json({"name": name, **{title.lower().replace(" ", "_"): found for title, found in users.items()}})
        return
    say(f"Action: {name}")
    for title, found in users.items():
        say(f"{title}: {len(found)}")
        for node, its_types in found.items() if not count else ():
            say(f"    {node} [{', '.join(its_types)}]" if types else f"    {node}")


def _nodes(ends: list[EndpointToken]) -> dict[str, dict[str, dict[str, list[str]]]]:
    """Return, for each node, the actions that it is a client of and that it serves, each with its types."""
    of_node: dict[str, list[EndpointToken]] = {}
    for each in ends:
        of_node.setdefault(each.full_node_name, []).append(each)
    found = {}
    for node in sorted(of_node):
        sections = dict(sections_of(of_node[node], hidden=True))
        found[node] = {title: dict(sections[section]) for title, section in TITLES.items()}
    return found
