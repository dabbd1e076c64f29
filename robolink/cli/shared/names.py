"""Output of the verbs list, type and find of several nouns: names with their types."""

from __future__ import annotations

from collections.abc import Mapping

from robolink.cli.shared.output import say, say_json
from robolink.interfaces import is_named


def show_names(found: Mapping[str, list[str]], *, types: bool = False, count: bool = False, json: bool = False) -> None:
    """Show a line for each name, with its types if wanted, or how many there are."""
    if json:
        say_json(len(found) if count else found)
    elif count:
        say(str(len(found)))
    else:
        for name, known in found.items():
            say(f"{name} [{', '.join(known)}]" if types else name)


def show_types(types: list[str], *, json: bool) -> None:
    """Show the types of one name, a line for each."""
    say_json(types) if json else say("\n".join(types))


def show_of_type(found: Mapping[str, list[str]], type_: str, *, count: bool, json: bool) -> None:
    """Show the names that have a type: ``SetBool``, ``std_srvs/SetBool`` or ``std_srvs/srv/SetBool``."""
    names = [name for name, types in found.items() if any(is_named(each, type_) for each in types)]
    if json:
        say_json(len(names) if count else names)
    elif count:
        say(str(len(names)))
    elif names:
        say("\n".join(names))
