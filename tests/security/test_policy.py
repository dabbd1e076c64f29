"""Policies in SROS2's XML: what is read, what is refused and where, and that hostile XML does nothing."""

from __future__ import annotations

import contextlib
import datetime
from pathlib import Path

import pytest
import zenoh
from hypothesis import given
from hypothesis import strategies as st

from robolink.documents.xmltext import parse
from robolink.exceptions import DocumentError
from robolink.security import patterns, permissions, policy
from robolink.security.generating import merged, write_policy
from robolink.security.policy import Profile, Rule
from robolink.wire import DataKey, format_key

HEAD = '<?xml version="1.0"?><policy version="0.2.0" xmlns:xi="http://www.w3.org/2001/XInclude"><enclaves>'
TAIL = "</enclaves></policy>"
PROFILE = '<enclave path="/a"><profiles><profile ns="{ns}" node="talker">{rules}</profile></profiles></enclave>'


def written(folder: Path, rules: str, ns: str = "/", name: str = "policy.xml") -> Path:
    path = folder / name
    path.write_text(HEAD + "\n" + PROFILE.format(ns=ns, rules="\n" + rules) + TAIL, encoding="utf-8")
    return path


def test_names_are_absolute_relative_or_private(tmp_path: Path) -> None:
    rules = '<topics publish="ALLOW" subscribe="DENY"><topic>/x</topic><topic>y</topic><topic>~/z</topic></topics>'
    (profile,) = policy.load(written(tmp_path, rules, "/arm"))["/a"]
    assert profile.full_name == "/arm/talker"
    names = ["/x", "/arm/y", "/arm/talker/z"]
    assert profile.rules == [Rule("publish", True, n) for n in names] + [Rule("subscribe", False, n) for n in names]


def test_files_are_included_from_the_folder_of_the_policy(tmp_path: Path) -> None:
    (tmp_path / "common").mkdir()
    log = '<profile><topics publish="ALLOW"><topic>rosout</topic></topics></profile>'
    (tmp_path / "common" / "logging.xml").write_text(log, encoding="utf-8")
    node = (
        '<profile xmlns:xi="http://www.w3.org/2003/XInclude"><xi:include href="logging.xml" xpointer="{}"/></profile>'
    )
    (tmp_path / "common" / "node.xml").write_text(node.format("xpointer(/profile/*)"), encoding="utf-8")
    include = '<xi:include href="common/node.xml" xpointer="xpointer(/profile/*)"/>'
    (profile,) = policy.load(written(tmp_path, include))["/a"]
    assert profile.rules == [Rule("publish", True, "/rosout")]


@pytest.mark.parametrize(
    ("rules", "told"),
    [
        ('<topic publish="ALLOW"/>', "3: expected <topics> or <services> or <actions>, got <topic> (did you mean"),
        ('<topics publsh="ALLOW"><topic>a</topic></topics>', "has no 'publsh' (did you mean 'publish'?)"),
        ('<topics publish="ALOW"><topic>a</topic></topics>', "got 'ALOW' (did you mean 'ALLOW'?)"),
        ('<topics publish="ALLOW"><topics>a</topics></topics>', "expected <topic>, got <topics>"),
        ('<topics publish="ALLOW"><topic>a b</topic></topics>', "<topic>a b: a name is /a/b"),
        ('<topics publish="ALLOW"><topic>a*b</topic></topics>', "a * stands for a whole part"),
        ('<topics publish="ALLOW"><topic></topic></topics>', "a name is /a/b"),
        ('<xi:include href="http://example.org/x.xml"/>', "only files in the policy's folder"),
        ('<xi:include href="../../etc/passwd"/>', "leads out of"),
        ('<xi:include href="/etc/passwd"/>', "leads out of"),
        ('<xi:include href="policy.xml"/>', "never ends"),
        ('<xi:include href="gone.xml"/>', "is not there"),
        ("<topics", "no XML:"),
    ],
)
def test_a_mistake_is_told_with_its_place(tmp_path: Path, rules: str, told: str) -> None:
    with pytest.raises(DocumentError) as caught:
        policy.load(written(tmp_path, rules))
    assert told in str(caught.value)
    assert str(caught.value).startswith(str(tmp_path / "policy.xml:"))


@pytest.mark.parametrize(
    "text",
    [
        '<!DOCTYPE a [<!ENTITY b "cc"><!ENTITY d "&b;&b;">]><a>&d;</a>',
        '<!DOCTYPE a SYSTEM "file:///etc/passwd"><a/>',
        '<!DOCTYPE a [<!ENTITY % p SYSTEM "http://example.org/"> %p;]><a/>',
        "<a>" * 1000 + "</a>" * 1000,
        "<a>" + "<b/>" * 200_000 + "</a>",
        '<?xml version="1.0" encoding="nonsense"?><a/>',
        "",
        "\0",
        "<a>&unknown;</a>",
    ],
)
def test_hostile_xml_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(DocumentError) as caught:
        parse(text.encode(), "x.xml")
    assert "\n" not in str(caught.value)


@given(st.binary(max_size=200))
def test_any_bytes_are_xml_or_an_error(content: bytes) -> None:
    with contextlib.suppress(DocumentError):
        parse(content, "x.xml")


PART = st.text("abc_1", min_size=1, max_size=3)
NAME = st.lists(PART, min_size=1, max_size=4).map(lambda parts: "/" + "/".join(parts))
PATTERN = st.tuples(st.lists(PART | st.just("*"), max_size=3), PART | st.just("*") | PART.map(lambda p: p + "*")).map(
    lambda each: "/" + "/".join([*each[0], each[1]])
)


@given(PATTERN, NAME)
def test_zenoh_lets_through_what_fits(pattern: str, name: str) -> None:
    assert patterns.problem(pattern) == ""
    key = format_key(DataKey(3, name, "std_msgs/msg/String", "RIHS01_" + "0" * 64))
    for asked in (key, key + "/_buf_cpu"):
        is_included = any(zenoh.KeyExpr(each).includes(asked) for each in patterns.keys(pattern, 3))
        if asked == key or "*" not in pattern:  # with a *, what stands beside a key may be a longer name's as well
            assert is_included == patterns.fits(pattern, name)
    assert not any(zenoh.KeyExpr(each).includes("4" + key[1:]) for each in patterns.keys(pattern, 3))


@given(PATTERN)
def test_what_is_kept_beside_a_key_has_its_own_expressions(pattern: str) -> None:
    for each in (*patterns.beside(pattern, 0, "pub"), *patterns.beside(pattern, 0, "sub")):
        zenoh.KeyExpr(each)  # canonical, else it raises


def test_permissions_are_read_back(tmp_path: Path) -> None:
    day = datetime.datetime(2026, 1, 1, tzinfo=datetime.timezone.utc)
    rules = [
        *(Rule(kind, True, f"/{kind}/*") for kind in ("publish", "subscribe", "request", "reply")),
        Rule("publish", False, "/publish/not"),
    ]
    path = tmp_path / "permissions.xml"
    path.write_bytes(permissions.write("/a", rules, 7, (day, day)))
    found = permissions.load(path)
    assert {Rule(*each[:3]) for each in found} == set(rules)
    assert all(each.holds_in(7) and not each.holds_in(0) for each in found)
    assert path.read_text("utf-8").count("<not_before>2026-01-01T00:00:00</not_before>") == 1


def test_an_action_is_its_topics_and_services() -> None:
    profile = Profile("/", "n", [Rule("call", True, "/drive")])
    rules = permissions.expanded([profile])
    assert Rule("request", True, "/drive/_action/send_goal") in rules
    assert Rule("subscribe", True, "/drive/_action/feedback") in rules
    assert Rule("reply", True, "/n/get_parameters") in rules
    assert Rule("publish", True, "/rosout") in rules
    assert not any(each.name.startswith("/drive") and each.kind in ("publish", "reply") for each in rules)


def test_a_profile_that_allows_nothing_has_nothing() -> None:
    rules = permissions.expanded([Profile("/", "n", [Rule("publish", False, "/*")])])
    assert rules == [Rule("publish", False, "/*")]


def test_a_policy_is_written_as_it_is_read_and_merged(tmp_path: Path) -> None:
    path = tmp_path / "made.xml"
    first = {"/a": [Profile("/arm", "n", [Rule("publish", True, "/arm/x"), Rule("reply", True, "/arm/n/y")])]}
    write_policy(path, first)
    assert "<topic>x</topic>" in path.read_text("utf-8")
    assert "<service>~/y</service>" in path.read_text("utf-8")
    more = {"/a": [Profile("/arm", "n", [Rule("call", True, "/far")])], "/b": [Profile("/", "m", [])]}
    write_policy(path, merged(path, more))
    found = policy.load(path)
    assert sorted(found) == ["/a", "/b"]
    assert set(found["/a"][0].rules) == {*first["/a"][0].rules, *more["/a"][0].rules}
