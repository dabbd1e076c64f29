"""Whatever a peer announces, sends, asks or answers: a node refuses it, says so once, and goes on working."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink import Context, Node, VirtualTime, logging
from robolink.exceptions import ServiceError
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import encode
from robolink.qos import QoSProfile
from robolink.transport import Query
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import NO_HASH, EndpointKind, format_token, pack_attachment
from tests.support.spins import done, spin_for

ATTACHMENT = pack_attachment(1, 2, b"*" * 16)
PLAIN = QoSProfile(depth=100)


class Lab:
    """A node that subscribes, publishes, serves and calls, and a stranger on the same network."""

    def __init__(self) -> None:
        bus = Bus()
        self.context = Context(transport=MemoryTransport(bus=bus), time=VirtualTime())
        self.context.init([])
        self.node = Node("node", context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.got: list[int] = []
        self.publisher = self.node.create_publisher(Int32, "topic", 10)
        self.subscription = self.node.create_subscription(Int32, "topic", self.on_number, PLAIN)
        self.service = self.node.create_service(SetBool, "switch", lambda request, response: response)
        self.client = self.node.create_client(SetBool, "switch")
        self.elsewhere = self.node.create_client(SetBool, "elsewhere")
        self.stranger = MemoryTransport(bus=bus)

    def on_number(self, message: Int32) -> None:
        self.got.append(message.data)

    def keys(self, endpoint: Any) -> list[str]:
        """The two keys that it may have."""
        return [endpoint.key, endpoint.key.rpartition("/")[0] + "/" + NO_HASH]

    def works(self) -> bool:
        """Whether a message still arrives and a call is still answered."""
        self.got.clear()
        self.publisher.publish(Int32(data=42))
        spin_for(self.executor, 0.1)
        answer = done(self.executor, self.client.call_async(SetBool.Request()))
        return 42 in self.got and isinstance(answer, SetBool.Response)


@pytest.fixture
def lab() -> Lab:
    return Lab()


def fields(lab: Lab) -> st.SearchStrategy[str]:
    """Tokens of which some fields are wrong, and some that only look hostile."""
    tokens = [each._endpoint.token for each in (lab.publisher, lab.subscription, lab.service, lab.client)]
    texts = [format_token(token._replace(session="ab")).split("/") for token in tokens]
    junk = st.text(max_size=8) | st.sampled_from(["", "%", "..", "*", "$*", "MP", "SC", "-1", NO_HASH, "a" * 5000])

    def damaged(text: list[str], changes: dict[int, str]) -> str:
        return "/".join(changes.get(at, field) for at, field in enumerate(text))

    return st.builds(damaged, st.sampled_from(texts), st.dictionaries(st.integers(3, 12), junk, max_size=3))


def blobs(*valid: bytes) -> st.SearchStrategy[bytes]:
    return st.binary(max_size=64) | st.sampled_from([*valid, b"", b"\x00\x01\x00\x00" + b"\xff" * 8])


LAB = Lab()
payloads = blobs(encode(Int32(data=7)), encode(SetBool.Request()))
attachments = blobs(ATTACHMENT, ATTACHMENT[:-1], ATTACHMENT + b"\x00")
tokens = fields(LAB) | st.text().map("@ros2_lv/0/".__add__)


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(
    announced=st.lists(tokens, max_size=5),
    sent=st.lists(st.tuples(st.booleans(), payloads, attachments), max_size=5),
    asked=st.lists(st.tuples(st.booleans(), payloads, attachments), max_size=5),
    answered=st.lists(st.tuples(payloads, attachments), max_size=3),
)
def test_a_node_survives_everything(
    announced: list[str],
    sent: list[tuple[bool, bytes, bytes]],
    asked: list[tuple[bool, bytes, bytes]],
    answered: list[tuple[bytes, bytes]],
) -> None:
    logging.set_console_handler(None)
    lab = Lab()
    with lab.context:
        handles = [lab.stranger.announce(token) for token in announced]
        outlets = [lab.stranger.advertise(key, PLAIN) for key in lab.keys(lab.subscription._endpoint)]
        for on_humble, payload, attachment in sent:
            outlets[on_humble].put(payload, attachment)
        for on_humble, payload, attachment in asked:
            lab.stranger.call(lab.keys(lab.service._endpoint)[on_humble], payload, attachment, lambda _: None)
        lab.stranger.serve(lab.elsewhere._endpoint.key, answers(answered))
        future = lab.elsewhere.try_call_async(SetBool.Request())
        assert lab.works()
        assert future.done()
        future.exception()
        for handle in handles:
            handle.close()
        assert lab.works()
        assert lab.node.get_node_names() == ["node"]


def answers(answered: list[tuple[bytes, bytes]]) -> Callable[[Query], None]:
    def answer(query: Query) -> None:
        for payload, attachment in answered:
            query.reply(payload, attachment)
        query.close()

    return answer


def test_a_reply_without_attachment_is_refused_and_a_good_one_taken(lab: Lab, log_lines: list[Record]) -> None:
    fine = encode(SetBool.Response(message="fine"))
    lab.stranger.serve(lab.elsewhere._endpoint.key, answers([(fine, b""), (b"\x00", ATTACHMENT), (fine, ATTACHMENT)]))
    for _ in range(2):
        assert done(lab.executor, lab.elsewhere.call_async(SetBool.Request())).message == "fine"
    assert lab.elsewhere.call(SetBool.Request(), timeout_sec=30.0).message == "fine"
    assert lab.elsewhere.malformed == 6
    (line,) = log_lines
    refused = "/elsewhere: refused an answer that is not a std_srvs/srv/SetBool: an attachment has 33 bytes"
    assert refused in line.message


def test_a_call_with_bad_answers_only_fails_and_says_why(lab: Lab, log_lines: list[Record]) -> None:
    fine = encode(SetBool.Response())
    lab.stranger.serve(lab.elsewhere._endpoint.key, answers([(fine, b"short")]))
    future = lab.elsewhere.try_call_async(SetBool.Request())
    with pytest.raises(ServiceError, match="the answer cannot be read: an attachment has 33 bytes, got 5"):
        done(lab.executor, future)
    with pytest.raises(ServiceError, match="the answer cannot be read"):
        lab.elsewhere.try_call(SetBool.Request(), timeout_sec=1.0)
    assert len(log_lines) == 1


def test_a_request_without_attachment_is_refused(lab: Lab, log_lines: list[Record]) -> None:
    ends: list[Any] = []
    for attachment in (b"", b"", ATTACHMENT[1:]):
        lab.stranger.call(lab.service._endpoint.key, encode(SetBool.Request()), attachment, ends.append)
    spin_for(lab.executor, 0.1)
    assert ends == [None, None, None]
    assert lab.service.malformed == 3
    assert len(log_lines) == 1
    assert lab.works()


def test_a_stranger_cannot_speak_for_this_session(lab: Lab) -> None:
    """A token with our own session's id that we have not announced says nothing."""
    token = lab.publisher._endpoint.token._replace(endpoint_id="99")
    lab.stranger.announce(format_token(token))
    lab.stranger.announce(format_token(lab.publisher._endpoint.token)).close()
    assert lab.node.count_publishers("topic") == 1
    assert lab.context.graph.endpoints(EndpointKind.PUBLISHER, name="/topic") == [lab.publisher._endpoint.token]
