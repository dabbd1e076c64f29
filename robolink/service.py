"""Services: the serving side, which answers requests."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Coroutine
from types import CoroutineType
from typing import Any, ClassVar, NamedTuple, TypeVar

from robolink.callback_groups import CallbackGroup
from robolink.exceptions import DecodeError, OverwrittenError, WireError
from robolink.graph.endpoint import Endpoint, Owner
from robolink.logging import get_logger
from robolink.message import Message, decoder, encoder, service_type
from robolink.qos import QoSProfile
from robolink.running.entity import SERVICE
from robolink.service_introspection import REQUEST_RECEIVED, RESPONSE_SENT, ServiceEnd
from robolink.service_introspection import ServiceIntrospectionState as ServiceIntrospectionState
from robolink.text.callbacks import named
from robolink.transport.base import Query
from robolink.wire import EndpointKind, pack_attachment, unpack_attachment

SrvType = TypeVar("SrvType")  # names that programs import from here
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")

MOST_WAITING = 1000
"""Most requests that wait for the executor: QoS's depth of 10 is for topics. Beyond it the oldest ends unanswered."""


class RequestHeader(NamedTuple):
    """Header of a request, by which the response finds the caller.

    Args:
        query: Query of the transport, which takes the reply.
        sequence_number: Number of the call, in the order of its client's.
        client_gid: Global id of the client, 16 bytes.
    """

    query: Query
    sequence_number: int
    client_gid: bytes


class Service(ServiceEnd):
    """Answers requests of one type under one name; made by `Node.create_service`.

    Args:
        owner: Node that it belongs to, as the graph knows it.
        srv_type: Service class.
        srv_name: Fully qualified name of the service.
        callback: Function, or coroutine function, called as `callback(request, response)`; it returns the response.
        callback_group: Group of the callback.
        qos_profile: Quality of service.
    """

    rank = SERVICE
    serves = True
    CALLBACK_TAKES: ClassVar[tuple[str, ...]] = ("request", "response")
    """Names of the arguments of a callback, for errors about it."""

    def __init__(
        self,
        owner: Owner,
        srv_type: type[Any],
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
    ) -> None:
        super().__init__(owner.context.inbox, MOST_WAITING, callback_group, self._make_room)
        self.srv_type = service_type(srv_type)
        self.srv_name = self._service_name = srv_name  # `create_...` sets the first to the name as written
        self.callback = callback
        self.qos_profile = qos_profile
        self.malformed = 0
        """Number of requests that could not be decoded, or were refused undecoded."""
        self.look_first: Callable[[bytes], tuple[Any, str]] | None = None
        """Check of a request before it is decoded: returns the response that refuses it, and why; or (None, '')."""
        self._endpoint = Endpoint(owner, EndpointKind.SERVICE, srv_name, srv_type, qos_profile)
        self._transport = self._endpoint.transport
        self._handles = [self._transport.serve(self._endpoint.key, self.sink)]
        self._endpoint.speak_humble = self._speak_humble
        self._endpoint.announce()

    # Made when first asked: most services of a node, those for its parameters, never are.

    @functools.cached_property
    def _decode(self) -> Callable[[bytes], Any]:
        return decoder(self.srv_type.Request)

    @functools.cached_property
    def _encode(self) -> Callable[[Any], bytes]:
        return encoder(self.srv_type.Response)

    def _speak_humble(self, key: str) -> None:
        """Serve Humble's key too from now on; a client calls one of them."""
        # At the first Humble node anywhere, not at the first client: that one calls before its token has arrived.
        self._handles.append(self._transport.serve(key, self.sink))
        if self._destroyed:  # meanwhile
            self._close()

    def _make_room(self, arrived: Any) -> Any:
        """Return a request to be stored; the one that must give way, or comes too late, ends without an answer."""
        if self._destroyed:
            self._end(arrived)
            return None
        waiting = self.mailbox.waiting
        if len(waiting) == waiting.maxlen:
            self._end(waiting[0])
        return arrived

    def _end(self, arrived: Any) -> None:
        """End a call without an answer."""
        with contextlib.suppress(OverwrittenError):  # it has ended, then
            self._transport.accept(arrived).close()

    def execute(self, taken: Any) -> Any:
        """Decode the request, call the callback, answer. A request that cannot be decoded ends without an answer."""
        try:
            query = self._transport.accept(taken)
        except OverwrittenError as error:
            self._refuse(str(error))
            return None
        try:
            # One without ROS 2's attachment is refused, as rmw_zenoh does: what works here works with a real robot.
            asker = unpack_attachment(query.attachment)
            if self.look_first is not None:
                refusal, reason = self.look_first(query.payload)
                if reason:
                    self._refuse(reason)
                    return self.send_response(refusal, RequestHeader(query, asker.sequence, asker.gid))
            request = self._decode(query.payload)
        except (DecodeError, WireError) as error:
            self._refuse(f"it is not a {self._endpoint.type_name}: {error}")
            query.close()
            return None
        header = RequestHeader(query, asker.sequence, asker.gid)
        if self.introspection is not None:
            self.introspection.tell(REQUEST_RECEIVED, request, asker.sequence, asker.gid)
        try:
            return self.respond(request, header)
        except BaseException:
            query.close()
            raise

    def respond(self, request: Message, header: RequestHeader) -> Any:
        """Call the callback with `request` and send its response; if it is a coroutine, return one that does so later.

        `header` is that of the request.
        """
        response = self.callback(request, self.srv_type.Response())
        if isinstance(response, CoroutineType):
            return self._answer_later(response, header)
        self.send_response(response, header)
        return None

    async def _answer_later(self, response: Coroutine[Any, Any, Any], header: RequestHeader) -> None:
        try:
            self.send_response(await response, header)
        finally:
            header.query.close()

    def send_response(self, response: Message, header: RequestHeader) -> None:
        """Send a response.

        Args:
            response: Response of the service's type.
            header: Header of the request.

        Raises:
            TypeError: if the response is of another type.
            EncodeError: (a TypeError and ValueError) if a field does not fit its type; the text names it.
        """
        if not isinstance(response, self.srv_type.Response):
            raise TypeError(self._wrong_response(response))
        now = self._endpoint.context.time.now()
        header.query.reply(self._encode(response), pack_attachment(header.sequence_number, now, header.client_gid))
        header.query.close()
        if self.introspection is not None:
            requested = header.sequence_number, header.client_gid
            self.introspection.tell(RESPONSE_SENT, response, *requested)

    def _wrong_response(self, response: object) -> str:
        expected = f"the callback of service {self.service_name} must return a {self.srv_type.__name__}.Response"
        advice = "" if response is not None else f": is `return response` missing at the end of {named(self.callback)}?"
        return f"{expected}, got {response!r:.80}{advice}"

    def _refuse(self, reason: str) -> None:
        self.malformed += 1
        if self.malformed == 1:
            get_logger(self.logger_name).warning(
                f"{self.service_name}: refused a request: {reason} (the next ones are only counted)"
            )

    def destroy(self) -> None:
        """End the service; callers that wait are told so. Safe to call twice."""
        if self._destroyed:
            return
        self._destroyed = True
        if self.introspection is not None:
            self.introspection.close()
        self._close()
        self.detach()
        self._parking.sweep()
        while len(self.mailbox):
            self._end(self.mailbox.take())

    def _close(self) -> None:
        for handle in self._handles:
            handle.close()
        self._endpoint.close()

    def __enter__(self) -> Service:
        return self

    def __exit__(self, *_: Any) -> None:
        self.destroy()
