"""Names: what ROS 2 allows, where the bad character is, and how a name is expanded and remapped."""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.arguments.remapping import RemapKind, parse_remap_rule, remap_name, remap_node, resolve_name
from robolink.exceptions import (
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidParameterException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NameValidationException,
)
from robolink.expand_topic_name import expand_topic_name
from robolink.text.names import MAX_NAMESPACE, MAX_NODE_NAME, MAX_TOPIC_NAME, absolute_namespace, join
from robolink.topic_or_service_is_hidden import topic_or_service_is_hidden
from robolink.validate_full_topic_name import validate_full_topic_name
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name
from robolink.validate_parameter_name import validate_parameter_name
from robolink.validate_topic_name import validate_topic_name

Validate = Callable[[str], bool]

token = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,8}", fullmatch=True)
path = st.lists(token, min_size=1, max_size=4).map("/".join)
rough = st.text(alphabet="ab_/~{}:=.*1 é\n", max_size=12)


def problem(validate: Validate, name: str) -> tuple[int, str]:
    """Give where and why a name is refused."""
    with pytest.raises(NameValidationException) as caught:
        validate(name)
    assert caught.value.name == name
    return caught.value.invalid_index, caught.value.error_msg


@pytest.mark.parametrize(
    ("validate", "name", "index", "message"),
    [
        (validate_node_name, "", 0, "must not be empty"),
        (validate_node_name, "talker.", 6, "must not contain characters"),
        (validate_node_name, "/talker", 0, "must not contain characters"),
        (validate_node_name, "tälker", 1, "must not contain characters"),
        (validate_node_name, "talker\n", 6, "must not contain characters"),
        (validate_node_name, "2nd", 0, "must not start with a number"),
        (validate_node_name, "n" * (MAX_NODE_NAME + 1), MAX_NODE_NAME - 1, "longer than 255"),
        (validate_namespace, "", 0, "empty"),
        (validate_namespace, "arm", 0, "must be absolute"),
        (validate_namespace, "/arm/", 4, "must not end with '/'"),
        (validate_namespace, "/arm//left", 5, "must not contain '//'"),
        (validate_namespace, "/arm/2", 5, "must not start with a number"),
        (validate_namespace, "/" + "n" * MAX_NAMESPACE, MAX_NAMESPACE - 1, "longer than 245"),
        (validate_full_topic_name, "scan", 0, "must be absolute"),
        (validate_full_topic_name, "/", 0, "must not end with '/'"),
        (validate_full_topic_name, "/{ns}/scan", 1, "must not contain characters"),
        (validate_full_topic_name, "/a/~", 3, "must not contain characters"),
        (validate_full_topic_name, "/" + "n" * MAX_TOPIC_NAME, MAX_TOPIC_NAME - 1, "longer than 247"),
        (validate_topic_name, "", 0, "must not be empty"),
        (validate_topic_name, "scan/", 4, "must not end with '/'"),
        (validate_topic_name, "a?", 1, "must not contain characters"),
        (validate_topic_name, "foo/{b?r}", 6, "must not contain characters"),
        (validate_topic_name, "foo/{4bar}", 5, "must not start with a number"),
        (validate_topic_name, "foo/{b/r}", 6, "within a substitution"),
        (validate_topic_name, "foo/{{bar}}", 5, "within a substitution"),
        (validate_topic_name, "foo/{bar", 4, "without a '}'"),
        (validate_topic_name, "{a}/b}", 5, "without a '{'"),
        (validate_topic_name, "}", 0, "without a '{'"),
        (validate_topic_name, "a/~/b", 2, "except as the first"),
        (validate_topic_name, "~a", 1, "'/' after '~'"),
        (validate_topic_name, "42", 0, "must not start with a number"),
        (validate_topic_name, "invalid/42topic", 8, "must not start with a number"),
    ],
)
def test_a_bad_name_is_refused_with_the_place_of_the_bad_character(
    validate: Validate, name: str, index: int, message: str
) -> None:
    found, text = problem(validate, name)
    assert (found, message in text) == (index, True), text


@pytest.mark.parametrize(
    ("validate", "names"),
    [
        (validate_node_name, ["talker", "_hidden", "a2", "n" * MAX_NODE_NAME]),
        (validate_namespace, ["/", "/arm", "/arm/left_2", "/" + "n" * (MAX_NAMESPACE - 1)]),
        (validate_full_topic_name, ["/scan", "/a/_b/c2", "/" + "n" * (MAX_TOPIC_NAME - 1)]),
        (validate_topic_name, ["scan", "/scan", "~", "~/scan", "{node}/scan", "a/{ns}_b", "a{node}", "x//y"]),
        (validate_parameter_name, ["a", "a.b", "qos_overrides./scan.depth"]),
    ],
)
def test_good_names_pass(validate: Validate, names: list[str]) -> None:
    assert all(validate(name) for name in names)


def test_each_kind_of_name_has_its_own_error() -> None:
    with pytest.raises(InvalidNodeNameException, match="node name"):
        validate_node_name("?")
    with pytest.raises(InvalidNamespaceException, match="namespace"):
        validate_namespace("?")
    with pytest.raises(InvalidTopicNameException, match="topic name"):
        validate_topic_name("?")
    with pytest.raises(InvalidServiceNameException, match="service name"):
        validate_topic_name("?", is_service=True)
    with pytest.raises(InvalidServiceNameException):
        validate_full_topic_name("?", is_service=True)
    with pytest.raises(InvalidParameterException):
        validate_parameter_name("")


@pytest.mark.parametrize(
    "validate", [validate_node_name, validate_namespace, validate_topic_name, validate_full_topic_name]
)
def test_a_letter_with_an_accent_is_told_which_letters_would_do(validate: Callable[[str], object]) -> None:
    name = "robô" if validate in {validate_node_name, validate_topic_name} else "/robô"
    with pytest.raises(NameValidationException, match=r"must not contain characters other than a-z, A-Z, digits"):
        validate(name)


@given(rough, st.sampled_from([validate_node_name, validate_namespace, validate_topic_name, validate_full_topic_name]))
def test_validation_raises_nothing_but_its_error_and_points_into_the_name(name: str, validate: Validate) -> None:
    with suppress(NameValidationException):
        assert validate(name)
        return
    index, _ = problem(validate, name)
    assert 0 <= index < max(1, len(name))


@given(rough)
def test_validation_agrees_with_the_grammar(name: str) -> None:
    tilde, chunk = (
        r"(?:~(?=/|\Z))?",
        r"(?:/*(?:[a-zA-Z_]|\{(?![0-9])[a-zA-Z0-9_]*\})(?:[a-zA-Z0-9_]|\{(?![0-9])[a-zA-Z0-9_]*\})*)",
    )
    good = name != "" and re.fullmatch(f"{tilde}{chunk}*", name) is not None
    try:
        validated: bool = validate_topic_name(name)
    except InvalidTopicNameException:
        validated = False
    assert validated == good


@pytest.mark.parametrize(
    ("name", "node", "namespace", "full"),
    [
        ("chatter", "talker", "/", "/chatter"),
        ("chatter", "talker", "/ns", "/ns/chatter"),
        ("/chatter", "talker", "/ns", "/chatter"),
        ("~", "talker", "/ns", "/ns/talker"),
        ("~/chatter", "talker", "/", "/talker/chatter"),
        ("{node}/chatter", "talker", "/ns", "/ns/talker/chatter"),
        ("{ns}/chatter", "talker", "/ns", "/ns/chatter"),
        ("{namespace}/{node}", "talker", "/ns", "/ns/talker"),
        ("~/{node}_{node}", "talker", "/ns", "/ns/talker/talker_talker"),
    ],
)
def test_a_name_is_expanded(name: str, node: str, namespace: str, full: str) -> None:
    assert expand_topic_name(name, node, namespace) == full


def test_an_unknown_substitution_says_which_is_near() -> None:
    with pytest.raises(InvalidTopicNameException, match=r"'\{nod\}' \(did you mean 'node'\?\)") as caught:
        expand_topic_name("a/{nod}", "talker", "/")
    assert caught.value.invalid_index == 2


@given(path, token, st.one_of(st.just("/"), path.map("/{}".format)), st.sampled_from(["{}", "~/{}", "/{}"]))
def test_what_is_expanded_from_good_names_is_a_full_name(name: str, node: str, namespace: str, form: str) -> None:
    full = expand_topic_name(form.format(name), node, namespace)
    assert full.endswith(f"/{name}")
    assert validate_full_topic_name(full)


@pytest.mark.parametrize(
    ("name", "hidden"), [("/chatter", False), ("a_/b_", False), ("", False), ("a/_b/c", True), ("_", True)]
)
def test_a_token_with_an_underscore_in_front_hides_a_topic(name: str, hidden: bool) -> None:
    assert topic_or_service_is_hidden(name) is hidden


def test_a_node_name_is_put_into_its_namespace() -> None:
    assert (join("/", "a"), join("/ns", "a")) == ("/a", "/ns/a")
    assert [absolute_namespace(each) for each in ("", "ns", "/ns")] == ["/", "/ns", "/ns"]


TOPIC, SERVICE = RemapKind.TOPIC, RemapKind.SERVICE


@pytest.mark.parametrize(
    ("rule", "kind", "full", "expected"),
    [
        ("scan:=lidar", TOPIC, "/ns/scan", "/ns/lidar"),
        ("scan:=/lidar", TOPIC, "/ns/scan", "/lidar"),
        ("scan:=lidar", TOPIC, "/scan", "/scan"),
        ("/scan:=lidar", TOPIC, "/scan", "/ns/lidar"),
        ("~/scan:=~/points", TOPIC, "/ns/talker/scan", "/ns/talker/points"),
        ("talker:/ns/scan:=/lidar", TOPIC, "/ns/scan", "/lidar"),
        ("talker:~/scan:=lidar", TOPIC, "/ns/talker/scan", "/ns/lidar"),
        ("scan:=lidar", SERVICE, "/ns/scan", "/ns/lidar"),
        ("rostopic://scan:=lidar", TOPIC, "/ns/scan", "/ns/lidar"),
        ("rostopic://scan:=lidar", SERVICE, "/ns/scan", "/ns/scan"),
        ("rosservice:///ns/scan:=lidar", SERVICE, "/ns/scan", "/ns/lidar"),
        ("rosservice://scan:=lidar", TOPIC, "/ns/scan", "/ns/scan"),
        ("talker:scan:=lidar", TOPIC, "/ns/scan", "/ns/lidar"),
        ("other:scan:=lidar", TOPIC, "/ns/scan", "/ns/scan"),
        ("talker:rostopic://scan:=lidar", TOPIC, "/ns/scan", "/ns/lidar"),
        ("__ns:=/lidar", TOPIC, "/ns/scan", "/ns/scan"),
    ],
)
def test_a_rule_renames_what_it_matches(rule: str, kind: RemapKind, full: str, expected: str) -> None:
    assert remap_name([parse_remap_rule(rule)], kind, full, "talker", "/ns") == expected


def test_the_first_rule_that_matches_decides_and_its_result_is_not_remapped_again() -> None:
    rules = [parse_remap_rule(each) for each in ("a:=b", "a:=c", "b:=d")]
    assert remap_name(rules, TOPIC, "/a", "n", "/") == "/b"


def test_nodes_are_renamed() -> None:
    rules = [parse_remap_rule(each) for each in ("other:__node:=x", "__name:=y", "__node:=z", "__ns:=/n")]
    assert remap_node(rules, RemapKind.NODE, "talker") == "y"
    assert remap_node(rules, RemapKind.NODE, "other") == "x"
    assert remap_node(rules, RemapKind.NAMESPACE, "talker") == "/n"
    assert remap_node(rules[:1], RemapKind.NODE, "talker") is None


@pytest.mark.parametrize(
    ("rule", "reason"),
    [
        ("scan", "expected from:=to"),
        (":=b", "must not be empty"),
        ("a:=", "must not be empty"),
        ("a:=b?", "'b\\?' must not contain"),
        ("a:=b:=c", "must not contain"),
        ("*/a:=b", "wildcards are not supported"),
        ("__nod:=b", "did you mean '__node'"),
        ("__node:=a/b", "node name 'a/b' must not contain"),
        ("__ns:=a", "namespace 'a' must be absolute"),
        ("a:={x}", "unknown substitution"),
    ],
)
def test_a_bad_rule_is_refused_with_the_reason(rule: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        parse_remap_rule(rule)


@given(st.one_of(rough, st.tuples(rough, rough).map(":=".join)))
def test_a_rule_is_read_or_a_value_error(text: str) -> None:
    with suppress(ValueError):
        rule = parse_remap_rule(text)
        assert rule.replacement in text
        assert remap_name([rule], TOPIC, "/a", "a", "/").startswith("/")


def test_resolving_expands_remaps_and_checks() -> None:
    rules = [parse_remap_rule("foo:=bar"), parse_remap_rule("rosservice://foo:=baz")]
    assert resolve_name(rules, TOPIC, "foo", "n", "/ns") == "/ns/bar"
    assert resolve_name((), TOPIC, "foo", "n", "/ns") == "/ns/foo"
    assert resolve_name(rules[1:], SERVICE, "foo", "n", "/ns") == "/ns/baz"
    with pytest.raises(InvalidTopicNameException, match="'//'"):
        resolve_name(rules, TOPIC, "a//b", "n", "/ns")
    with pytest.raises(InvalidServiceNameException, match="characters"):
        resolve_name(rules, SERVICE, "a b", "n", "/ns")
