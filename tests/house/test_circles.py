"""No file imports, by way of others, one that imports it: circles of modules, and how long the longest may be."""

from __future__ import annotations

import functools

import grimp

STANDARD = {"message", "interfaces"}
"""Rooms that may make a circle: messages are made of the standard types, which are messages. They import late."""
LONGEST = 3
"""Most files of a circle that type imports make."""

Graph = dict[str, set[str]]


@functools.cache
def imports(*, of_types: bool) -> Graph:
    """Return what each file imports, inside functions too; and for types only, if `of_types`."""
    graph = grimp.build_graph("robolink", exclude_type_checking_imports=not of_types, cache_dir=None)
    return {each: graph.find_modules_directly_imported_by(each) for each in graph.modules}


def reached(graph: Graph, start: str) -> set[str]:
    """Return what a file imports, by way of others too."""
    found: set[str] = set()
    waiting = [start]
    while waiting:
        new = graph[waiting.pop()] - found
        found |= new
        waiting += new
    return found


def circles(graph: Graph) -> set[frozenset[str]]:
    """Return the groups of files of which each imports each other."""
    reach = {each: reached(graph, each) for each in graph}
    mutual = {frozenset(other for other in found if each in reach[other]) for each, found in reach.items()}
    return {each for each in mutual if len(each) > 1}


def is_standard(circle: frozenset[str]) -> bool:
    return {each.split(".")[1] for each in circle} <= STANDARD


def test_circles_are_found() -> None:
    graph = {"a": {"b"}, "b": {"c"}, "c": {"a", "d"}, "d": {"e"}, "e": set[str](), "f": {"g"}, "g": {"f", "a"}}
    assert circles(graph) == {frozenset("abc"), frozenset("fg")}


def test_no_files_import_each_other_when_they_run() -> None:
    assert [sorted(each) for each in circles(imports(of_types=False)) if not is_standard(each)] == []


def test_types_make_no_circle_of_more_than_three_files() -> None:
    found = circles(imports(of_types=True))
    longer = [each for each in found if len(each) > LONGEST and not is_standard(each)]
    assert [sorted(each) for each in longer] == []


def test_imports_for_types_are_told_apart() -> None:
    entity, ports = "robolink.running.entity", "robolink.running.ports"
    assert ports in imports(of_types=True)[entity] - imports(of_types=False)[entity]
