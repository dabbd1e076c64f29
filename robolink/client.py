"""Clients of services: the calling side."""

from __future__ import annotations

import functools
import queue
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.callback_groups import CallbackGroup
from robolink.exceptions import (
    BlockingCallError,
    DecodeError,
    ExternalShutdownException,
    InvalidHandle,
    ServiceError,
    SessionReplacedError,
    TransportError,
    WireError,
)
from robolink.graph.endpoint import Endpoint, Owner
from robolink.logging import get_logger
from robolink.message import Message, decoder, encoder, service_type
from robolink.qos import QoSProfile
from robolink.running.entity import CLIENT, NOTHING, Entity
from robolink.running.inbox import Inbox
from robolink.service_introspection import REQUEST_SENT, RESPONSE_RECEIVED, ServiceEnd
from robolink.service_introspection import ServiceIntrospectionState as ServiceIntrospectionState
from robolink.task import Future, asyncio_loop
from robolink.transport.base import Handle, Sink
from robolink.wire import NO_HASH, EndpointKind, unpack_attachment

if TYPE_CHECKING:
    from robolink.running.ports import Loop

SrvType = TypeVar("SrvType")  # names that programs import from here
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")

_RELEASED = object()
_UNREADABLE = (DecodeError, WireError, TransportError)


class _Call:
    """Call under way, until its answer or the end of all answers."""

    straight = False

    def __init__(self, client: BaseClient, inbox: Inbox, future: Future[Any], fails: bool) -> None:
        self.client, self.future, self.fails = client, future, fails
        self.sequence_number = 0
        self.sink: functools.partial[Any] = inbox.sink(self)
        self.handle: Handle | None = None
        self.bad: Exception | None = None
        """Error by which the last answer could not be read."""
        self.waiting = 0
        """Number of answers that wait for the client's turn."""
        self.has_ended = False
        """True if the end of all answers came while some waited: it needs no turn of its own."""

    def deliver(self, arrived: Any) -> None:
        """Hand an answer, or the end of all answers, to the client."""
        if arrived is not None:
            self.waiting += 1
        elif self.waiting:
            self.has_ended = True
            return
        self.client.deliver((self, arrived))

    def forget_if_cancelled(self) -> None:
        """Abandon the call once its future is cancelled: the answer comes too late then."""
        if self.future.cancelled():
            self.client.remove_pending_request(self.future)


class BaseClient(ServiceEnd):
    """Base of Client and AsyncClient: calls under way, and their answers.

    Args:
        owner: Node that it belongs to, as the graph knows it.
        srv_type: Service class.
        srv_name: Fully qualified name of the service.
        qos_profile: Quality of service.
        callback_group: Group of the client.
    """

    rank = CLIENT
    serves = quick = True
    is_gated = False  # an answer only completes a future, and the callback that waits for it may keep its group busy

    def __init__(
        self,
        owner: Owner,
        srv_type: type[Any],
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup,
    ) -> None:
        super().__init__(owner.context.inbox, 0, callback_group)
        self.srv_type = service_type(srv_type)
        self.srv_name = self._service_name = srv_name  # `create_...` sets the first to the name as written
        self.qos_profile = qos_profile
        self._context = owner.context
        self._encode = encoder(srv_type.Request)
        self._decode = decoder(srv_type.Response)
        self._endpoint = Endpoint(owner, EndpointKind.CLIENT, srv_name, srv_type, qos_profile)
        self._transport = self._endpoint.transport
        self._calls: set[_Call] = set()
        self._destroyed = False
        self.malformed = 0
        """Number of answers that could not be read."""
        self._silent = False
        self._keeps_: object = None
        """The node, which lives while anybody refers to the client."""
        self._endpoint.announce()

    @property
    def is_waiting(self) -> bool:
        """True while a call is under way."""
        return bool(self._calls)

    def redirect(self, inbox: Inbox) -> None:
        """Redirect the answers that are still to come to this inbox."""
        super().redirect(inbox)
        for call in list(self._calls):
            inbox.take_over(call.sink)

    def _key(self) -> str:
        """Return the key to ask: that of Humble's servers if there are no others."""
        endpoint = self._endpoint
        servers = endpoint.others.copy().values()  # as they are now: another thread may add one
        for each in servers:
            if each.type_hash != NO_HASH:
                return endpoint.key
        return endpoint.humble_key if servers else endpoint.key

    def _send_(self, request: bytes, sink: Sink) -> Handle:
        """Send a serialized request; `sink` gets what `Transport.read` reads as a response, then None once."""
        return self._transport.call(self._key(), request, self._endpoint.attachment(), sink)

    def _ask(self, request: Message, *, fails: bool) -> Future[Any]:
        packed = self._packed(request)
        executor = self.executor
        future: Future[Any] = Future(executor=executor)
        inbox = self._parking if executor is None else executor._queue_.inbox
        call = _Call(self, inbox, future, fails)
        self._calls.add(call)
        future.when_done(call.forget_if_cancelled)
        call.sequence_number = unpack_attachment(packed[1]).sequence
        call.handle = self._transport.call(self._key(), *packed, call.sink)
        return future

    def _packed(self, request: Message) -> tuple[bytes, bytes]:
        if not isinstance(request, self.srv_type.Request):
            raise TypeError(f"Expected {self.srv_type.Request}, got {type(request)}")
        if self._destroyed:
            raise self._gone_(f"the client of {self.service_name}")
        packed = self._encode(request), self._endpoint.attachment()
        if self.introspection is not None:
            requested = unpack_attachment(packed[1])
            self.introspection.tell(REQUEST_SENT, request, requested.sequence, requested.gid)
        return packed

    def take(self) -> Any:
        """Return the oldest answer of a call that is still under way, or NOTHING."""
        taken = super().take()
        if taken is NOTHING:
            return taken
        call, arrived = taken
        if arrived is not None:
            call.waiting -= 1
        return taken if call in self._calls else NOTHING  # after its answer, no turn

    def execute(self, taken: tuple[_Call, Any]) -> None:
        """Complete the future of a call."""
        call, arrived = taken
        if call not in self._calls:
            return
        try:
            answer = None if arrived is None else self._read(arrived)
        except _UNREADABLE as error:
            call.bad, answer = self._refuse(error), None
            if not call.has_ended or call.waiting:
                return  # another server may do better; the end of all answers comes in any case
        if call.handle is not None and not call.has_ended:
            call.handle.close()
        if answer is None and not call.fails:
            self._warn_of_silence(call)
            return  # and the call stays among those under way, where whoever waits for it is kept
        self._calls.discard(call)
        call.future.set_executor(self.executor)
        if answer is None:
            call.future.set_exception(self._no_answer(call.bad))
        else:
            self._silent = False
            call.future.set_result(answer)

    def _warn_of_silence(self, call: _Call) -> None:
        if not self._silent:
            self._silent = True
            get_logger(self.logger_name).warning(
                f"{self._no_answer(call.bad)}; the future of this call will never be done"
                " (until there is an answer, other such calls are not told)"
            )

    def _read(self, arrived: Any) -> Any:
        payload, attachment = self._transport.read(arrived)
        requested = unpack_attachment(attachment)
        response = self._decode(payload)
        if self.introspection is not None:
            self.introspection.tell(RESPONSE_RECEIVED, response, requested.sequence, requested.gid)
        return response

    def _no_answer(self, bad: Exception | None) -> ServiceError:
        if bad is None:
            return ServiceError(f"service {self.service_name}: nobody serves it, or the server went away")
        if isinstance(bad, SessionReplacedError):
            return ServiceError(f"service {self.service_name}: {bad}")
        return ServiceError(f"service {self.service_name}: the answer cannot be read: {bad}")

    def _refuse(self, error: Exception) -> Exception:
        if isinstance(error, SessionReplacedError):
            return error
        self.malformed += 1
        if self.malformed == 1:
            get_logger(self.logger_name).warning(
                f"{self.service_name}: refused an answer that is not a {self._endpoint.type_name}: {error}"
                " (the next ones are only counted)"
            )
        return error

    def remove_pending_request(self, future: Future[Any]) -> None:
        """Abandon the call of this `future`, which will not be completed."""
        for call in [each for each in list(self._calls) if each.future is future]:
            self._calls.discard(call)
            if call.handle is not None:
                call.handle.close()

    def get_pending_request(self, sequence_number: int) -> Future[Any]:
        """Return the future of the call under way with this `sequence_number`. Raises KeyError if there is none."""
        for call in list(self._calls):
            if call.sequence_number == sequence_number:
                return call.future
        raise KeyError(sequence_number)

    def service_is_ready(self) -> bool:
        """True if somebody serves this name with this type."""
        self._check_(f"client of {self.srv_name}")
        return self._endpoint.count_others() > 0

    def destroy(self) -> None:
        """End the client, and abandon its calls. Safe to call twice."""
        if self._destroyed:
            return
        self._destroyed = True
        self._keeps_ = None
        for call in list(self._calls):
            self.remove_pending_request(call.future)
        if self.introspection is not None:
            self.introspection.close()
        self._endpoint.close()
        self.detach()


class Client(BaseClient):
    """Calls one service; made by `Node.create_client`.

    Args:
        owner: Node that it belongs to, as the graph knows it.
        srv_type: Service class.
        srv_name: Fully qualified name of the service.
        qos_profile: Quality of service.
        callback_group: Group of the client.
    """

    def __init__(
        self,
        owner: Owner,
        srv_type: type[Any],
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup,
    ) -> None:
        super().__init__(owner, srv_type, srv_name, qos_profile, callback_group)
        self._outside: set[queue.SimpleQueue[Any]] = set()
        self._context.on_shutdown(self._release)

    def call(self, request: Message, timeout_sec: float | None = None) -> Any:
        """Call the service and wait for the response; in a callback as well, since services go on meanwhile.

        Args:
            request: Request of the service's type.
            timeout_sec: Longest wait in seconds; None waits for ever.

        Returns:
            The response.

        Raises:
            TypeError: if the request is of another type.
            TimeoutError: if no response comes in time.
            ServiceError: (a RuntimeError) at once if the call would be a deadlock, since only a callback group that
                it keeps busy itself could answer; without a timeout also if nobody serves, or the server goes away.
        """
        return self._call(request, timeout_sec, patient=timeout_sec is not None)

    def try_call(self, request: Message, timeout_sec: float | None = None) -> Any:
        """Call as `call` does, but raise a ServiceError as soon as it is known that no response will come.

        Args:
            request: Request of the service's type.
            timeout_sec: Longest wait in seconds; None waits for ever.
        """
        return self._call(request, timeout_sec, patient=False)

    def _call(self, request: Message, timeout_sec: float | None, *, patient: bool) -> Any:
        executor = self.executor
        if executor is None and self.node is not None and self.node._runs_itself_ and asyncio_loop() is not None:
            raise BlockingCallError
        if executor is None or not executor.spins_here:
            return self._call_from_outside(request, timeout_sec, patient)
        # rclpy stops here for ever: the only thread waits for an answer that only it could receive.
        with executor.waiting_for(self._only_servers(executor)) as would_wait_for_itself:
            if would_wait_for_itself:
                raise ServiceError(
                    f"service {self.service_name} is served only by the callback group that this call keeps busy;"
                    " give the service or the caller a callback group of its own, or use call_async"
                )
            return self._call_in_callback(executor, request, timeout_sec, patient)

    def _only_servers(self, executor: Loop) -> list[Entity]:
        """Return the executor's own servers of this service if nobody else serves it and none of them may be free."""
        served = (each for node in executor.get_nodes() for each in node._entity_store_.all_services())
        local: list[Entity] = [each for each in served if each.service_name == self.service_name]
        is_free = any(each.callback_group.can_execute(each) for each in local)
        if not local or (is_free and not executor.parallel):
            return []
        everywhere = self._context.graph.endpoints(EndpointKind.SERVICE, name=self.service_name)
        return local if len(everywhere) <= len(local) else []

    def _call_in_callback(self, executor: Loop, request: Message, timeout_sec: float | None, patient: bool) -> Any:
        deadline = None if timeout_sec is None else self._context.time.steady() + int(timeout_sec * 1e9)
        future = self.try_call_async(request)
        executor.serve_until(future, deadline)
        if future.done() and (future.exception() is None or not patient):
            return future.result()
        executor.serve_until(Future(), deadline)
        self.remove_pending_request(future)
        raise self._timeout(timeout_sec, future.exception())

    def _call_from_outside(self, request: Message, timeout_sec: float | None, patient: bool) -> Any:
        packed = self._packed(request)
        answers: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._outside.add(answers)
        handle = self._transport.call(self._key(), *packed, answers.put)
        try:
            return self._first_readable(answers, timeout_sec, patient)
        finally:
            self._outside.discard(answers)
            handle.close()

    def _first_readable(self, answers: queue.SimpleQueue[Any], timeout_sec: float | None, patient: bool) -> Any:
        """Wait for an answer; one that cannot be read is passed over, since another server may do better."""
        time = self._context.time
        deadline = None if timeout_sec is None else time.steady() + int(timeout_sec * 1e9)
        bad: Exception | None = None
        reason: ServiceError | None = None
        while True:
            try:
                answer = time.take(answers, deadline)
            except queue.Empty:
                raise self._timeout(timeout_sec, reason) from None
            if answer is _RELEASED:
                raise ExternalShutdownException(
                    f"service {self.service_name}: the context ended before the answer came"
                )
            if answer is None:
                reason = self._no_answer(bad)
                if not patient:
                    raise reason
                continue
            try:
                return self._read(answer)
            except _UNREADABLE as error:
                bad = self._refuse(error)

    def _release(self) -> None:
        for answers in list(self._outside):
            answers.put(_RELEASED)

    def _timeout(self, timeout_sec: float | None, reason: BaseException | None) -> TimeoutError:
        text = f"service {self.service_name}: no answer within {timeout_sec} s"
        return TimeoutError(text if reason is None else f"{text}: {str(reason).partition(': ')[2]}")

    # Never done, since rclpy's programs call early, spin with a timeout and look.
    def call_async(self, request: Message) -> Future[Any]:
        """Call the service with `request`, and return the future of the response, which comes while something spins.

        The future is never done if nobody serves or the server goes away, as in rclpy; a warning says so. Raises
        TypeError for a request of another type.
        """
        return self._ask(request, fails=False)

    def try_call_async(self, request: Message) -> Future[Any]:
        """Call with `request` as `call_async` does; the future gets a ServiceError once no response can come."""
        return self._ask(request, fails=True)

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait until somebody serves this name with this type, or the context ends.

        Args:
            timeout_sec: Longest wait in seconds; None waits for ever, 0 or less does not wait.

        Returns:
            True if somebody serves it.
        """
        try:
            return self._context.wait_until(self.service_is_ready, timeout_sec)
        except InvalidHandle:
            if self._context.ok():
                raise
            return False  # the context ended between two looks, and destroyed this client

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: Any) -> None:
        self.destroy()
