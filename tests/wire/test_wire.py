"""The wire is rmw_zenoh's, byte for byte; whatever else arrives is a WireError."""

from __future__ import annotations

import ast
import contextlib
import re
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import wire
from robolink.duration import Duration, Infinite
from robolink.exceptions import WireError
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
    qos_profile_system_default,
    resolved,
)
from robolink.wire.tokens import parsed_by_field

DATA = Path(__file__).parents[1] / "data" / "wire"
HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"


def golden(name: str) -> list[str]:
    return (DATA / name).read_text().split()


TOKEN = golden("liveliness-token-real-humble.txt")[0]

chunks = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)
names = st.lists(chunks, min_size=1, max_size=4).map(lambda parts: "/" + "/".join(parts))
namespaces = st.just("/") | names
types = st.builds("{}/{}/{}".format, chunks, st.sampled_from(["msg", "srv", "action"]), st.just("Thing_Feedback"))
hashes = st.just(wire.NO_HASH) | st.from_regex(r"RIHS01_[0-9a-f]{64}", fullmatch=True)
numbers = st.integers(0, 10**18)
ids = numbers.map(str) | st.from_regex(r"[^/*$?#]{1,9}", fullmatch=True)
further = st.just("") | st.just(wire.CPU_BACKEND) | st.lists(ids, min_size=1, max_size=3).map("/".join)
sessions = st.from_regex(r"[1-9a-f][0-9a-f]{0,31}", fullmatch=True)
spans = st.just(Infinite) | st.integers(1, 2**63 - 3).map(lambda ns: Duration(nanoseconds=ns))
profiles = st.builds(
    QoSProfile,
    history=st.sampled_from([HistoryPolicy.KEEP_LAST, HistoryPolicy.KEEP_ALL]),
    depth=st.integers(1, 10**6),
    reliability=st.sampled_from([ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT]),
    durability=st.sampled_from([DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE]),
    lifespan=spans,
    deadline=spans,
    liveliness=st.sampled_from([LivelinessPolicy.AUTOMATIC, LivelinessPolicy.MANUAL_BY_TOPIC]),
    liveliness_lease_duration=spans,
)
keys = st.builds(wire.DataKey, numbers, names, types, hashes)
node_tokens = st.builds(wire.NodeToken, numbers, sessions, ids, namespaces, namespaces, chunks, further)
endpoint_tokens = st.builds(
    wire.EndpointToken,
    numbers,
    sessions,
    ids,
    ids,
    st.sampled_from(wire.EndpointKind),
    namespaces,
    namespaces,
    chunks,
    names,
    types,
    hashes,
    profiles,
    further,
)


def test_data_keys_of_a_real_peer() -> None:
    parsed = [wire.parse_key(key) for key in golden("data-keys.txt")]
    assert [(key.domain, key.name) for key in parsed] == [(0, "/chatter"), (42, "/robot/_hidden/chatter")]
    assert {key.type_name for key in parsed} == {"std_msgs/msg/String"}
    assert [wire.format_key(key) for key in parsed] == golden("data-keys.txt")


def test_key_of_a_service() -> None:
    key = wire.DataKey(2, "/add_two_ints", "example_interfaces/srv/AddTwoInts", HASH)
    assert wire.format_key(key) == f"2/add_two_ints/example_interfaces::srv::dds_::AddTwoInts_/{HASH}"


def test_token_of_a_real_peer() -> None:
    token = wire.parse_token(TOKEN)
    assert isinstance(token, wire.EndpointToken)
    assert token[:11] == (
        0,
        "9ca0f8facf84ffb1e6bfa4f2500889f0",
        "0",
        "3",
        wire.EndpointKind.PUBLISHER,
        "/",
        "/",
        "_ros2cli_712",
        "/chatter",
        "std_msgs/msg/String",
        wire.NO_HASH,
    )
    assert (token.qos.durability, token.qos.depth) == (DurabilityPolicy.TRANSIENT_LOCAL, 1)
    assert wire.format_token(token) == TOKEN


def tokens(distro: str) -> list[str]:
    """The tokens of nodes of a distribution, and of publishers, subscriptions and services that they have."""
    lines = (DATA / f"tokens-{distro}.txt").read_text().splitlines()
    return [line for line in lines if not line.startswith("#")]


DISTROS = ("humble", "jazzy", "kilted", "lyrical")


@pytest.mark.parametrize("distro", DISTROS)
def test_tokens_of_each_distribution(distro: str) -> None:
    found = [wire.parse_token(text) for text in tokens(distro)]
    assert [wire.format_token(each) for each in found] == tokens(distro)
    assert {type(each) for each in found} == {wire.NodeToken, wire.EndpointToken}
    ends = [each for each in found if isinstance(each, wire.EndpointToken)]
    assert {each.type_hash == wire.NO_HASH for each in ends} == {distro == "humble"}
    assert any(each.more for each in ends) is (distro == "lyrical")


def test_lyricals_tokens_say_where_the_bytes_of_images_and_clouds_lie() -> None:
    found = [token for token in map(wire.parse_token, tokens("lyrical")) if isinstance(token, wire.EndpointToken)]
    further = {each.type_name.rpartition("/")[2]: each.more for each in found}
    assert {name for name, more in further.items() if more == wire.CPU_BACKEND} == {
        "Image",
        "PointCloud2",
        "CompressedImage",
    }
    assert {further[name] for name in ("String", "Twist", "AddTwoInts")} == {""}


def test_ids_may_be_names() -> None:
    """rmw_zenoh's are numbers, but it takes any text; dora's servers are named."""
    kind = f"SS/%/%/dora/%add/example_interfaces::srv::dds_::AddTwoInts_/{HASH}/::,:,:,:,,"
    text = f"@ros2_lv/0/ab/bridge/add server-1/{kind}"
    token = wire.parse_token(text)
    assert isinstance(token, wire.EndpointToken)
    assert (token.node_id, token.endpoint_id) == ("bridge", "add server-1")
    assert wire.format_token(token) == text


def test_attachment_of_a_real_peer_carries_the_gid_of_its_token() -> None:
    attachment = wire.unpack_attachment(bytes.fromhex(golden("attachment-real-humble.hex")[0]))
    assert attachment == (216, 1784824452167621172, wire.gid_of(TOKEN))


def test_attachment_bytes() -> None:
    packed = wire.pack_attachment(7, 1724679300000000000, b"*" * 16)
    assert packed[:8].hex() == golden("attachment-seq7.hex")[0][:16]
    assert packed[16:].hex() == golden("attachment-seq7.hex")[0][32:]
    assert wire.pack_attachment(*wire.unpack_attachment(packed)) == packed


@pytest.mark.parametrize("damage", [{}, {16: b"\x0f"}, {0: b""}, {32: b""}, {33: b"."}])
def test_an_attachment_is_known_by_its_length_and_that_of_its_gid(damage: dict[int, bytes]) -> None:
    packed = wire.pack_attachment(7, 1, b"sixteen bytes id")
    raw = b"".join([*(damage.get(at, packed[at : at + 1]) for at in range(33)), damage.get(33, b"")])
    assert wire.is_attachment(raw) is (raw == packed)


def test_the_gid_in_an_attachment() -> None:
    assert wire.gid_in(wire.pack_attachment(7, 1, b"sixteen bytes id")) == b"sixteen bytes id"
    assert wire.gid_in(b"") == b""


def test_no_offset_of_an_attachment_is_known_outside_of_the_wire() -> None:
    root = Path(wire.__file__).parents[1]
    indexed = re.compile(r"attachment\[")
    sources = {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8") for path in root.rglob("*.py")}
    found = {name for name, source in sources.items() if indexed.search(source)}
    assert not found


@pytest.mark.parametrize("text", golden("qos-components.txt"))
def test_qos_of_a_real_peer(text: str) -> None:
    qos = wire.parse_qos(text)
    assert qos.reliability is ReliabilityPolicy.BEST_EFFORT
    assert wire.format_qos(qos) == text


@pytest.mark.parametrize(
    ("qos", "text"),
    [
        (QoSProfile(depth=10), "::,10:,:,:,,"),
        (qos_profile_sensor_data, "2::,5:,:,:,,"),
        (QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL), ":1:,1:,:,:,,"),
        (qos_profile_system_default, "::,:,:,:,,"),
        (QoSProfile(history=HistoryPolicy.KEEP_ALL), "::2,10:,:,:,,"),
        (QoSProfile(depth=42, deadline=Duration(seconds=2, nanoseconds=5)), "::,:2,5:,:,,"),
    ],
)
def test_qos_field(qos: QoSProfile, text: str) -> None:
    assert wire.format_qos(qos) == text
    assert wire.parse_qos(text) == resolved(qos)


def test_explicit_defaults_are_read_as_well() -> None:
    explicit = "1:2:1,42:9223372036,854775807:9223372036,854775807:1,9223372036,854775807"
    assert wire.parse_qos(explicit) == wire.parse_qos("::,:,:,:,,")


def test_node_token() -> None:
    token = wire.NodeToken(5, "ab12", "7", "", "/robot1", "talker")
    assert wire.format_token(token) == "@ros2_lv/5/ab12/7/7/NN/%/%robot1/talker"
    assert wire.parse_token(wire.format_token(token)) == token._replace(enclave="/")
    assert wire.graph_pattern(5) == "@ros2_lv/5/**"


@given(keys)
def test_keys_survive_the_wire(key: wire.DataKey) -> None:
    assert wire.parse_key(wire.format_key(key)) == key


@given(node_tokens | endpoint_tokens)
def test_tokens_survive_the_wire(token: wire.NodeToken | wire.EndpointToken) -> None:
    assert wire.parse_token(wire.format_token(token)) == token


int64 = st.integers(-(2**63), 2**63 - 1)
gids = st.binary(min_size=16, max_size=16)


@given(int64, int64, gids)
def test_attachments_survive_the_wire(sequence: int, timestamp: int, gid: bytes) -> None:
    packed = wire.pack_attachment(sequence, timestamp, gid)
    assert len(packed) == 33
    assert wire.unpack_attachment(packed) == (sequence, timestamp, gid)


PARSERS: list[Callable[[str], object]] = [
    wire.parse_key,
    wire.parse_token,
    wire.parse_qos,
    wire.demangle_type,
    wire.mangle_type,
]


@given(st.sampled_from(PARSERS), st.text() | st.text(alphabet="@ros2_lv/0123456789:,%MPNN\ud800"))
def test_other_text_is_a_wire_error(parse: Callable[[str], object], text: str) -> None:
    result: object = WireError
    with contextlib.suppress(WireError):
        result = parse(text)
    assert result


@given(st.integers(0, len(TOKEN) - 1), st.text(max_size=3))
def test_a_damaged_token_is_a_wire_error_or_another_token(at: int, damage: str) -> None:
    text = TOKEN[:at] + damage + TOKEN[at + 1 :]
    try:
        token = wire.parse_token(text)
        again = wire.format_token(token)
    except WireError:
        return
    assert plain(wire.parse_token(again)) == plain(token)


def plain(token: wire.NodeToken | wire.EndpointToken) -> object:
    """A token, in whose profile a policy of ROS 2's system default, which is 0, is the one that it stands for."""
    return token if isinstance(token, wire.NodeToken) else token._replace(qos=resolved(token.qos))


ONE_MATCH = [each for distro in DISTROS for each in tokens(distro) if each.count("/") == 12]


@given(st.sampled_from(ONE_MATCH), st.dictionaries(st.integers(0, 12), st.text(alphabet="a0/%*-.:,MPSCN", max_size=3)))
def test_a_token_that_is_read_by_one_match_is_read_as_field_by_field(text: str, damage: dict[int, str]) -> None:
    text = "/".join(damage.get(at, field) for at, field in enumerate(text.split("/")))
    found = list[object]()
    for parse in (wire.parse_token, parsed_by_field):
        try:
            found.append(parse(text))
        except WireError as error:
            found.append(str(error))
    assert found[0] == found[1]


@given(st.binary())
def test_other_bytes_are_no_attachment(raw: bytes) -> None:
    assert wire.is_attachment(raw) is (len(raw) == 33 and raw[16] == 16)
    if wire.is_attachment(raw):
        assert wire.unpack_attachment(raw).gid == raw[17:]
    else:
        with pytest.raises(WireError):
            wire.unpack_attachment(raw)


@given(
    st.binary(max_size=40) | st.binary(min_size=33, max_size=33) | st.builds(wire.pack_attachment, int64, int64, gids)
)
def test_the_quick_look_at_an_attachment_agrees_with_the_careful_one(raw: bytes) -> None:
    if wire.is_attachment(raw):
        wire.check_attachment(raw)
        assert wire.unpack_attachment(raw).gid == wire.gid_in(raw)
    else:
        for look in (wire.unpack_attachment, wire.check_attachment):
            with pytest.raises(WireError):
                look(raw)


def cut_attachments(source: str) -> list[str]:
    """Return all places in a module where something called attachment is indexed or sliced."""
    if "attachment" not in source:  # most of them: they need no parsing
        return []
    cuts = (each.value for each in ast.walk(ast.parse(source)) if isinstance(each, ast.Subscript))
    return [text for text in map(ast.unparse, cuts) if text.endswith("attachment")]


def test_no_module_outside_wire_knows_where_anything_is_in_an_attachment() -> None:
    assert cut_attachments("gid = sample.attachment[17:]; attachment[16]") == ["sample.attachment", "attachment"]
    house = Path(wire.__file__).parents[1]
    outside = [each for each in house.rglob("*.py") if each.parent != Path(wire.__file__).parent]
    assert len(outside) > 300
    assert [each.name for each in outside if cut_attachments(each.read_text(encoding="utf-8"))] == []


@pytest.mark.parametrize(
    "name", ["", "//", "/a//b", "/a*", "/a?b", "/a%b", "/a b", "/a/", "/ä", "/a\n", "/a$*", "/", "a"]
)
def test_names_that_would_break_a_key_are_refused(name: str) -> None:
    with pytest.raises(WireError, match="expected a full topic"):
        wire.format_key(wire.DataKey(0, name, "std_msgs/msg/String", HASH))


@pytest.mark.parametrize("parse", PARSERS)
def test_a_megabyte_is_refused_at_once(parse: Callable[[str], object]) -> None:
    begin = time.perf_counter()
    for hostile in ("a/" * 500_000, "a" * 1_000_000, TOKEN + "%a" * 500_000, "1:" * 500_000):
        with pytest.raises(WireError) as caught:
            parse(hostile)
        assert len(str(caught.value)) < 400
    assert time.perf_counter() - begin < 5.0  # 2 ms; what goes back at every character takes minutes


def test_a_megabyte_is_not_announced() -> None:
    token = wire.NodeToken(0, "a", "0", "/", "/", "x" * 1_000_000)
    with pytest.raises(WireError, match="at most"):
        wire.format_token(token)
    key = wire.DataKey(0, "/" + "x" * (wire.LONGEST - 5), "std_msgs/msg/String", HASH)
    with pytest.raises(WireError, match="a key has at most"):
        wire.format_key(key)


@pytest.mark.parametrize(
    "text",
    [
        TOKEN.replace("/MP/", "/XX/"),
        TOKEN.replace("@ros2_lv", "@ros2"),
        TOKEN.replace("TypeHashNotSupported", "RIHS01_12"),
        TOKEN.replace("dds_::String_", "String"),
        TOKEN.replace(":1:,1", ":9:,1"),
        TOKEN.replace("/0/3/", "/0//"),
        TOKEN.replace("/0/3/", "//3/"),
        "@ros2_lv/0/ab/0/0/MP/%/%/talker",
        TOKEN + "/",
        TOKEN + "/more//",
        TOKEN + "/*",
        TOKEN.rpartition("/")[0],
    ],
)
def test_malformed_tokens(text: str) -> None:
    with pytest.raises(WireError):
        wire.parse_token(text)


def test_an_attachment_gets_another_sender_or_another_time() -> None:
    asked, answered = wire.pack_attachment(5, 100, b"a" * 16), wire.pack_attachment(1, 200, b"b" * 16)
    assert wire.numbers_in(asked) + wire.sender_part(b"c" * 16) == wire.pack_attachment(5, 100, b"c" * 16)
    assert wire.answer_to(asked, answered) == wire.pack_attachment(5, 200, b"a" * 16)
    assert wire.answer_to(asked, b"nonsense") == asked
