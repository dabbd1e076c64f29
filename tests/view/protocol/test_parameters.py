"""Parameters as Foxglove has them: there and back."""

from __future__ import annotations

from typing import Any

import msgspec
from hypothesis import given
from hypothesis import strategies as st

from robolink import Parameter
from robolink.view.protocol.parameters import ParameterName, from_json, name_of, to_json
from robolink.view.protocol.requests import ParameterRequest, ProtocolError

INTEGERS = st.integers(-(2**63), 2**63 - 1)
FLOATS = st.floats(allow_nan=False, allow_infinity=False)
TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=20)
VALUES = (
    st.booleans()
    | INTEGERS
    | FLOATS
    | TEXTS
    | st.lists(st.booleans(), min_size=1)
    | st.lists(INTEGERS, min_size=1)
    | st.lists(FLOATS, min_size=1)
    | st.lists(TEXTS, min_size=1)
    | st.lists(st.binary(min_size=1, max_size=1), min_size=1)
)
ANY = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | TEXTS,
    lambda inner: st.lists(inner) | st.dictionaries(TEXTS, inner),
    max_leaves=6,
)


@given(VALUES)
def test_a_parameter_comes_back_as_it_was(value: Any) -> None:
    message = Parameter("gain.p", value=value).to_parameter_msg()
    shown = to_json(ParameterName("/ns/node", "gain.p"), message.value)
    assert shown["name"] == "/ns/node.gain.p"
    wish = msgspec.json.decode(msgspec.json.encode(shown), type=ParameterRequest)
    assert from_json(wish, message.value.type) == message


@given(ANY, st.none() | st.sampled_from(["byte_array", "float64", "float64_array", "x"]), st.integers(0, 9))
def test_any_value_is_a_parameter_or_refused(value: Any, kind: str | None, known: int) -> None:
    try:
        from_json(ParameterRequest("/node.x", value, kind), known).value  # noqa: B018
    except ProtocolError as error:
        refusal = str(error)
    else:
        refusal = "/node.x"
    assert refusal.startswith("/node.x")


@given(st.text())
def test_names(text: str) -> None:
    try:
        name = name_of(text)
    except ProtocolError:
        return
    assert str(name) == text
    assert "." not in name.node
