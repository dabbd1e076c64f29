"""Policies in SROS2's XML: which topics, services and actions the nodes of each enclave may use, and how.

Includes (`xi:include`) are followed to files in the folder of the policy, and below it; nothing else is fetched.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from robolink.documents.xmltext import Element, read
from robolink.exceptions import DocumentError, nearest
from robolink.security import patterns
from robolink.text.names import FULL_NAME_RULES, MAX_NAMESPACE, MAX_NODE_NAME, NODE_NAME_RULES, find_problem

VERSION = "0.2.0"
"""Version of the format, the only one that there is."""

KINDS = {"topics": ("publish", "subscribe"), "services": ("reply", "request"), "actions": ("call", "execute")}
"""Kinds of use that a policy allows, of topics, services and actions."""

MOST_INCLUDES = 200
"""Most files that a policy may include."""

MOST_INCLUDED = 100_000
"""Most elements that it may include, however often the same."""

_INCLUDE = ("{http://www.w3.org/2001/XInclude}include", "{http://www.w3.org/2003/XInclude}include")
_BASE = "{http://www.w3.org/XML/1998/namespace}base"


class Rule(NamedTuple):
    """A rule of a policy, for one name."""

    kind: str
    """One of KINDS' words, such as `publish`."""
    allows: bool
    name: str
    """Full name, or a pattern (`robolink.security.patterns`)."""


class Profile(NamedTuple):
    """The rules for a node of an enclave."""

    namespace: str
    node: str
    rules: list[Rule]

    @property
    def full_name(self) -> str:
        """Full name of the node."""
        return f"{self.namespace.rstrip('/')}/{self.node}"


Policy = dict[str, list[Profile]]
"""Profiles by enclave."""


def load(path: Path) -> Policy:
    """Read a policy file; raises DocumentError with file and line for the first mistake."""
    return _enclaves(load_elements(path))


def load_elements(path: Path) -> Element:
    """Read a policy file, its includes put in place, and check nothing but its root."""
    if not path.is_file():
        raise DocumentError("policy file does not exist", str(path))
    root = _included(read(path), _Includes(path.parent.resolve()))
    if root.tag != "policy":
        raise root.mistake(f"expected <policy>, got <{root.tag}>{nearest(root.tag, ['policy'])}")
    if root.attributes.get("version") != VERSION:
        raise root.mistake(f"expected version='{VERSION}', got {root.attributes.get('version', 'none')!r}")
    return root


def _enclaves(root: Element) -> Policy:
    found: Policy = {}
    for enclaves in _children(root, "enclaves"):
        for enclave in _children(enclaves, "enclave"):
            path = _attribute(enclave, "path")
            if path != "/" and (wrong := find_problem(path, FULL_NAME_RULES, MAX_NAMESPACE)):
                raise enclave.mistake(
                    f"'{path[:80]}' is not an enclave: {wrong.message} (at index {wrong.invalid_index})"
                )
            if path in found:
                raise enclave.mistake(f"enclave '{path}' is there twice")
            found[path] = [
                _profile(each)
                for profiles in _children(enclave, "profiles")
                for each in _children(profiles, "profile", "metadata")
                if each.tag == "profile"
            ]
    if not found:
        raise root.mistake("there is no <enclave> in it")
    return found


def _profile(element: Element) -> Profile:
    namespace, node = _attribute(element, "ns"), _attribute(element, "node")
    if namespace != "/" and (wrong := find_problem(namespace.replace("*", "_"), FULL_NAME_RULES, MAX_NAMESPACE)):
        raise element.mistake(f"ns is a namespace such as / or /arm, got '{namespace[:80]}': {wrong.message}")
    if wrong := find_problem(node.replace("*", "_"), NODE_NAME_RULES, MAX_NODE_NAME):
        raise element.mistake(f"node is a name such as driver, got '{node[:80]}': {wrong.message}")
    rules = [rule for each in _children(element, *KINDS) for rule in _rules(each, namespace, node)]
    return Profile(namespace, node, rules)


def _rules(element: Element, namespace: str, node: str) -> Iterator[Rule]:
    known = KINDS[element.tag]
    for kind, word in element.attributes.items():
        if kind == _BASE:
            continue
        if kind not in known:
            raise element.mistake(
                f"<{element.tag}> has no '{kind}'{nearest(kind, known)}; it has {' and '.join(known)}"
            )
        if word not in ("ALLOW", "DENY"):
            raise element.mistake(f"{kind} is ALLOW or DENY, got '{word}'{nearest(word, ['ALLOW', 'DENY'])}")
        for each in _children(element, element.tag.removesuffix("s")):
            yield Rule(kind, word == "ALLOW", _full_name(each, namespace, node))


def _full_name(element: Element, namespace: str, node: str) -> str:
    name, base = element.text, namespace.rstrip("/")
    full = name if name.startswith("/") else f"{base}/{node}{name[1:]}" if name.startswith("~") else f"{base}/{name}"
    if name.startswith("~") and not name.startswith("~/"):
        raise element.mistake(f"<{element.tag}>{name}: behind ~, the node, comes a /")
    if wrong := patterns.problem(full):
        raise element.mistake(f"<{element.tag}>{name}: {wrong}")
    return full


def _children(element: Element, *tags: str) -> list[Element]:
    """Return the elements within one; raises DocumentError for any that is none of these."""
    for child in element.children:
        if child.tag not in tags:
            meant = " or ".join(f"<{tag}>" for tag in tags)
            raise child.mistake(f"expected {meant}, got <{child.tag}>{nearest(child.tag, tags)}")
    return element.children


def _attribute(element: Element, name: str) -> str:
    value = element.attributes.get(name)
    if value is None:
        near = nearest(name, element.attributes)
        raise element.mistake(f"<{element.tag}> needs {name}='...'{near}")
    return value


class _Includes:
    """The folder that includes may come from, those under way, and how many there have been, of how many elements."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.count, self.elements = folder, 0, 0
        self.open: list[Path] = []


def _included(element: Element, includes: _Includes) -> Element:
    """Return an element with its includes replaced by what they name."""
    children: list[Element] = []
    for child in element.children:
        children += _fetched(child, includes) if child.tag in _INCLUDE else [_included(child, includes)]
    return element._replace(children=children)


def _fetched(element: Element, includes: _Includes) -> list[Element]:
    href = _attribute(element, "href")
    if ":" in href:
        raise element.mistake(f"xi:include of '{href}': only files in the policy's folder are included")
    path = (Path(element.file).parent / href).resolve()
    includes.count += 1
    if not path.is_relative_to(includes.folder):
        raise element.mistake(f"xi:include of '{href}' leads out of {includes.folder}")
    if path in includes.open or includes.count > MOST_INCLUDES:
        raise element.mistake(f"xi:include of '{href}' never ends")
    if not path.is_file():
        raise element.mistake(f"xi:include: {path} is not there")
    includes.open.append(path)
    content = read(path)
    includes.elements += content.size
    if includes.elements > MOST_INCLUDED:
        raise element.mistake(f"xi:include of '{href}': more than {MOST_INCLUDED} elements are included")
    root = _included(content, includes)
    includes.open.pop()
    return _pointed(root, element)


def _pointed(root: Element, include: Element) -> list[Element]:
    """Return the elements that `xpointer="xpointer(/a/b/*)"` names; the root without one."""
    pointer = include.attributes.get("xpointer", "")
    steps = pointer.removeprefix("xpointer(/").removesuffix(")").split("/")
    if not pointer:
        return [root]
    if not pointer.startswith("xpointer(/") or not all(step.isidentifier() or step == "*" for step in steps):
        raise include.mistake(f"xpointer '{pointer}': only paths such as xpointer(/profile/*) are read")
    found = [root] if steps[0] in (root.tag, "*") else []
    for step in steps[1:]:
        found = [child for each in found for child in each.children if step in (child.tag, "*")]
    return found
