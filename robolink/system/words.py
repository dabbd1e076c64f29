"""Words of messages for people: a noun with its article."""

from __future__ import annotations


def with_article(noun: str) -> str:
    """Return a noun with its indefinite article, as one writes it of a type's name.

    >>> with_article("int32"), with_article("uint8")
    ('an int32', 'a uint8')
    """
    return f"a{'n' if noun[:1] in tuple('aeio') else ''} {noun}"
