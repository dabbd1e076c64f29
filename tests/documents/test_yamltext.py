"""YAML's limits, and libyaml, which reads what is long: it gives the same nodes at the same places."""

from __future__ import annotations

import contextlib
import string
from collections.abc import Iterator
from typing import Any

import pytest
import yaml
from hypothesis import assume, given
from hypothesis import strategies as st

from robolink.arguments.parameter_file import parse_parameter_file
from robolink.documents import yamltext
from robolink.documents.yamlfile import parse
from robolink.exceptions import DocumentError

needs_libyaml = pytest.mark.skipif(not yaml.__with_libyaml__, reason="this PyYAML has no libyaml")


def places(node: yaml.Node | None) -> Iterator[tuple[str, str, int, int, int, int]]:
    """Yield each node of a document: kind, tag, where it begins, and where it ends unless lines end it."""
    if node is None:
        return
    is_exact = isinstance(node, yaml.ScalarNode) or node.flow_style is True  # type: ignore[attr-defined]
    end = node.end_mark.index if is_exact else 0
    start = node.start_mark
    yield type(node).__name__, node.tag, start.index, start.line, start.column, end
    if isinstance(node, yaml.ScalarNode):
        yield node.value, node.style or "", 0, 0, 0, 0
        return
    for each in node.value:
        for part in each if isinstance(each, tuple) else (each,):
            yield from places(part)


def read(loader: type[Any], text: str) -> list[tuple[str, str, int, int, int, int]]:
    return list(places(loader(text).get_single_node()))


WORDS = st.text(string.ascii_letters + string.digits + "äß€😀.-_/~ ", min_size=1, max_size=8)
SCALARS = st.one_of(WORDS, st.integers(), st.floats(), st.booleans(), st.none(), st.text(max_size=8))
DATA = st.recursive(
    SCALARS, lambda each: st.lists(each, max_size=4) | st.dictionaries(WORDS, each, max_size=4), max_leaves=20
)


@needs_libyaml
@given(data=DATA, flow=st.sampled_from([True, False, None]), wide=st.booleans())
def test_libyaml_gives_the_same_places(data: object, flow: bool | None, wide: bool) -> None:
    text = yaml.safe_dump(data, default_flow_style=flow, allow_unicode=wide, width=30)
    assert read(yamltext._FastLoader, text) == read(yamltext._Loader, text)


@needs_libyaml
@given(text=st.text("ab: -[]{},'\"#&*|>\n%@`", max_size=30).map(lambda text: text + "\n"))
def test_what_pyyaml_reads_libyaml_reads_the_same(text: str) -> None:
    assume(not any(f":{each}" in text for each in ",]}"))  # `{a:}`: libyaml wants a space
    try:
        found = read(yamltext._Loader, text)
    except (yaml.YAMLError, ValueError):
        return  # libyaml refuses nearly all of it, too
    with contextlib.suppress(yaml.YAMLError):  # it leaves some texts, as of a value that is left out, to PyYAML's own
        assert read(yamltext._FastLoader, text) == found


@needs_libyaml
@given(text=st.text(max_size=40))
def test_any_long_text_is_read_or_refused(text: str) -> None:
    with contextlib.suppress(DocumentError):  # and nothing else
        parse(text + "\n" + "#" * yamltext.SHORT)


@pytest.mark.slow
@needs_libyaml
def test_a_mistake_in_a_long_text_has_its_place() -> None:
    filler = "".join(f"a{number}: {number}\n" for number in range(5000))
    for wrong in ("  b: 1", "\tb: 1", "b: [1", "b: 'x", "b: @x", "a: b: c", "b: *x"):
        with pytest.raises(DocumentError, match=r"x\.yaml:500[12]:\d+: "):
            yamltext.compose(f"{filler}{wrong}\n", "x.yaml")
    with pytest.raises(DocumentError, match=r"x\.yaml:5001:1: key 'a7' is given twice, first in line 8"):
        yamltext.plain(yamltext.compose(f"{filler}a7: 1\n", "x.yaml"), "x.yaml")


def test_a_long_parameter_file_keeps_what_is_tagged() -> None:
    long = "".join(f"    p{number}: 1\n" for number in range(3000))
    [tagged, plain, *_] = parse_parameter_file(f"a:\n  ros__parameters:\n    t: !!str 1\n    n: 1\n{long}", "p.yaml")
    assert (tagged.value, plain.value) == ("1", 1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "report"),
    [
        ("[" + "1," * yamltext.MAX_NODES + "]", r"x:1:\d+: more than 100000 values: that is too large a document"),
        ("- 1\n" * 300_000, r"x:100000:3: more than 100000 values"),
        ("#" * (yamltext.MAX_BYTES + 1), "x: longer than 5 MB"),
        ("[" * 50_000, r"x:1:\d+: nested more than 64 levels deep"),
        (" " * 30_000 + "\x07", r"x:1:30001: character U\+0007 is not allowed in YAML"),
    ],
)
def test_what_is_too_large_is_refused(text: str, report: str) -> None:
    with pytest.raises(DocumentError, match=report):
        yamltext.compose(text, "x")


@pytest.mark.slow
def test_without_libyaml_less_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(yamltext, "CParser", None)
    text = "- 1\n" * (yamltext.MAX_SLOW_NODES + 1)
    with pytest.raises(DocumentError, match="more than 20000 values"):
        yamltext.compose(text, "x")
