"""Limits of slow links: what is refused, and the settings of Zenoh that are made of the rest."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError, TransportError
from robolink.networks import limits
from robolink.networks.limits import Limits
from robolink.transport import network

ONE = '{"control": ["/cmd_vel"], "rate": {"/camera/image": 2.0}, "size": {"/map": 8000}, "buffer": 8192}'


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{rat: {/a: 1}}", "1:2: rat: unknown key 'rat' (did you mean 'rate'?)"),
        ("{rate: {/a: 0}}", "1:13: rate./a: expected messages a second, 0.001 to 1,000,000, got 0.0"),
        ("{rate: {/a: -2}}", "1:13: rate./a: expected messages a second, 0.001 to 1,000,000, got -2.0"),
        ("{rate: {/a: .nan}}", "1:13: rate./a: expected messages a second, 0.001 to 1,000,000, got nan"),
        ("{rate: {/a: .inf}}", "1:13: rate./a: expected messages a second, 0.001 to 1,000,000, got inf"),
        ("{rate: {/a: fast}}", "1:13: rate./a: expected float, got 'fast'"),
        ("{size: {/a: 0}}", "1:13: size./a: expected bytes, 1 to 1,073,741,824, got 0"),
        ("{buffer: -1}", "1:10: buffer: expected bytes, 1,024 to 1,073,741,824, or 0 for the system's choice, got -1"),
        ("{interfaces: []}", "1:14: interfaces: name at least one, such as wlan0, or leave `interfaces` out"),
        (
            "{control: [cmd_vel]}",
            "1:12: control[0]: 'cmd_vel' is not a full name of a topic: a name is /a/b; a * stands",
        ),
        ("{rate: {a: 2}}", "1:9: rate.a: 'a' is not a full name of a topic: a name is /a/b; a * stands"),
        ("{rate: {/a/*: 2}}", "1:9: rate./a/*: '/a/*': name each topic: all that fit a pattern would share one rate"),
        ("{rate: [/a]}", "1:8: rate: expected mapping, got list"),
        ("{rate", "1:6: expected ',' or '}'"),
    ],
)
def test_a_mistake_is_one_line_with_its_place(text: str, reason: str) -> None:
    with pytest.raises(TransportError) as caught:
        limits.requested({"ROBOLINK_LIMITS": text})
    assert str(caught.value).startswith(f"ROBOLINK_LIMITS:{reason}")
    assert "\n" not in str(caught.value)


def test_a_file_of_limits(tmp_path: Path) -> None:
    path = tmp_path / "slow.yaml"
    environ = {"ROBOLINK_LIMITS": str(path)}
    path.write_text("rate:\n  /scan: 5\n")
    assert limits.requested(environ) == Limits(rate={"/scan": 5.0})
    path.write_text("rate:\n  /scan: 0\n")
    with pytest.raises(TransportError, match=r"^ROBOLINK_LIMITS: .*slow\.yaml:2:10: rate\./scan: expected messages"):
        limits.requested(environ)
    path.unlink()
    with pytest.raises(TransportError, match=r"^ROBOLINK_LIMITS: no file .*slow\.yaml"):
        limits.requested(environ)


def test_unset_or_empty_is_no_limit() -> None:
    assert limits.requested({}) is None
    assert limits.requested({"ROBOLINK_LIMITS": " "}) is None


def test_the_settings_of_zenoh() -> None:
    found = limits.settings(limits.parsed(ONE).value, 7, ["wlan0"])
    (first,) = found.pop("qos/network")
    assert first["key_exprs"] == [
        *("7/cmd_vel/*/*", "7/cmd_vel/*/*/_buf_cpu"),
        *("7/clock/*/*", "7/clock/*/*/_buf_cpu"),
    ]
    assert (first["overwrite"], first["interfaces"]) == ({"priority": "real_time"}, ["wlan0"])
    where = {"interfaces": ["wlan0"], "flows": ["egress"], "messages": ["put"]}
    topic = "7/camera/image/*/*"
    rules = [{"key_expr": topic, "freq": 2.0}, {"key_expr": f"{topic}/_buf_cpu", "freq": 2.0}]
    keys = ["7/map/*/*", "7/map/*/*/_buf_cpu"]
    assert found == {
        "downsampling": [where | {"id": "robolink rate", "rules": rules}],
        "low_pass_filter": [where | {"id": "robolink size 0", "key_exprs": keys, "size_limit": 8000}],
        "transport/link/tcp/so_sndbuf": 8192,
    }


def test_named_interfaces_count_more() -> None:
    (first,) = limits.settings(Limits(interfaces=["wlan1"]), 0, ["eth0"])["qos/network"]
    assert first["interfaces"] == ["wlan1"]
    (first,) = limits.settings(Limits(), 0)["qos/network"]
    assert "interfaces" not in first


def test_loopback_is_not_limited() -> None:
    assert not {"lo", "lo0"} & set(limits.beyond_loopback() or [])


def test_they_are_part_of_a_session_s_configuration() -> None:
    environ = {"ROBOLINK_LIMITS": ONE}
    config = network.load("lan", 0, environ)
    assert json.loads(config.get_json("downsampling"))[0]["rules"][0]["freq"] == 2.0
    assert json.loads(config.get_json("transport/link/tcp/so_sndbuf")) == 8192
    assert json.loads(network.load("lan", 0, {}).get_json("downsampling")) == []
    own = environ | {"ZENOH_CONFIG_OVERRIDE": "downsampling=[]"}
    assert json.loads(network.load("lan", 0, own).get_json("downsampling")) == []


FILE = """
far: {network: lan, limits: {rate: {/camera/image: 2}}}
lab: {peers: [10.0.0.2], limits: {control: [/go]}}
plain: lan
"""


def test_a_network_of_the_file_has_its_own(tmp_path: Path) -> None:
    (tmp_path / "networks.yaml").write_text(FILE)
    environ = {"ROBOLINK_WORKSPACE": str(tmp_path)}
    far = network.plan("far", 0, environ)
    assert (far.request.value, far.limits) == ("lan", Limits(rate={"/camera/image": 2.0}))
    assert network.plan("lab", 0, environ).limits == Limits(control=["/go"])
    assert network.plan("plain", 0, environ).limits is None
    given = environ | {"ROBOLINK_LIMITS": "{buffer: 8192}"}
    assert network.plan("far", 0, given).limits == Limits(buffer=8192)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("far: {network: lan, limits: {rate: {/a: 0}}}", "networks.yaml:1:41: far.limits.rate./a: expected messages"),
        ("far: {network: lan, peers: [a]}", "networks.yaml:1:7: far.network: either `network`, or `peers` and `lan`"),
        ("far: {network: 'a b'}", "networks.yaml:1:16: far.network: 'a b' is not a network"),
        ("far: {limits: {}}", "networks.yaml:1:6: far.peers: name at least one host"),
    ],
)
def test_mistakes_in_the_file_of_networks(text: str, reason: str, tmp_path: Path) -> None:
    (tmp_path / "networks.yaml").write_text(text)
    with pytest.raises(TransportError) as caught:
        network.plan("far", 0, {"ROBOLINK_WORKSPACE": str(tmp_path)})
    assert reason in str(caught.value)
    assert "\n" not in str(caught.value)


names = st.one_of(st.sampled_from(["/a", "/a/b", "/camera/*", "/*", "/scan*"]), st.text(max_size=12))
numbers = st.one_of(st.floats(), st.integers(-5, 1 << 33))
likely = st.fixed_dictionaries(
    {},
    optional={
        "control": st.lists(names, max_size=3),
        "rate": st.dictionaries(names, numbers, max_size=3),
        "size": st.dictionaries(names, numbers, max_size=3),
        "interfaces": st.lists(st.one_of(st.just("eth0"), st.text(max_size=8)), max_size=2),
        "buffer": numbers,
    },
)
anything: st.SearchStrategy[Any] = st.recursive(
    st.one_of(st.none(), st.booleans(), numbers, st.text(max_size=8)),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=8), inner, max_size=3)),
    max_leaves=8,
)


@given(st.one_of(likely, st.dictionaries(st.sampled_from(Limits.__struct_fields__), anything), anything))
def test_whatever_is_written_is_taken_by_zenoh_or_refused_in_one_line(data: Any) -> None:
    try:
        found = limits.parsed(spell(data)).value
    except DocumentError as error:
        wrong = str(error)
    else:
        wrong = ""
    if wrong:
        assert wrong.startswith("ROBOLINK_LIMITS")
        assert "\n" not in wrong
        return
    assert limits.parsed(limits.written(found)).value == found
    import zenoh

    config = zenoh.Config()
    limits.apply(config, found, 0)  # which raises for what Zenoh does not take
