"""Clients of services: the asking side."""

from __future__ import annotations

import functools
import queue
import time
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import CallbackGroup
from robolink.endpoint import Endpoint, Owner
from robolink.entity import Receiver
from robolink.exceptions import (
    DecodeError,
    ExternalShutdownException,
    InvalidHandle,
    ServiceError,
    TransportError,
    WireError,
)
from robolink.inbox import Inbox
from robolink.logging import get_logger
from robolink.message import Message, decoder, encoder, service_type
from robolink.qos import QoSProfile
from robolink.task import Future
from robolink.transport.base import Handle
from robolink.wire import NO_HASH, EndpointKind, unpack_attachment

if TYPE_CHECKING:
    from robolink.executors import Executor


_RELEASED = object()
_UNREADABLE = (DecodeError, WireError, TransportError)


class _Call:
    """One question under way."""

    straight = False

    def __init__(self, client: Client, inbox: Inbox, future: Future[Any]) -> None:
        self.client, self.future = client, future
        self.sequence_number = 0
        self.sink: functools.partial[Any] = inbox.sink(self)
        self.handle: Handle | None = None
        self.bad: Exception | None = None
        """Why the last answer could not be read."""

    def deliver(self, arrived: Any) -> None:
        """Hand an answer, or the end of all answers, to the client."""
        self.client.deliver((self, arrived))


class Client(Receiver):
    """Asks one service; made by `Node.create_client`."""

    serves = True

    def __init__(
        self,
        owner: Owner,
        srv_type: type[Any],
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup,
    ) -> None:
        super().__init__(owner.context.inbox, 0)  # an answer only completes a future: that may be done at any time
        self.group = callback_group
        callback_group.add_entity(self)
        self.srv_type = service_type(srv_type)
        self.srv_name = srv_name
        self.qos_profile = qos_profile
        self._context = owner.context
        self._encode = encoder(srv_type.Request)
        self._decode = decoder(srv_type.Response)
        self._endpoint = Endpoint(owner, EndpointKind.CLIENT, srv_name, srv_type, qos_profile)
        self._transport = self._endpoint.transport
        self._calls: set[_Call] = set()
        self._outside: set[queue.SimpleQueue[Any]] = set()
        self._destroyed = False
        self.malformed = 0
        """How many answers could not be read."""
        self._endpoint.announce()
        self._context.on_shutdown(self._release)

    def redirect(self, inbox: Inbox) -> None:
        """Have the answers that are still to come arrive in this inbox."""
        super().redirect(inbox)
        for call in list(self._calls):
            inbox.take_over(call.sink)

    def call(self, request: Message, timeout_sec: float | None = None) -> Any:
        """Ask and wait for the answer; in a callback as well: what serves goes on meanwhile.

        Raises TypeError for a request of another type, TimeoutError when no answer comes in `timeout_sec` seconds,
        ServiceError (a RuntimeError) when nobody serves, or only what this very call keeps from serving.
        """
        executor = self.executor
        if executor is None or not executor.spins_here:
            return self._call_from_outside(request, timeout_sec)
        self._refuse_deadlock(executor)
        deadline = None if timeout_sec is None else self._context.time.steady() + int(timeout_sec * 1e9)
        future = self.call_async(request)
        executor.serve_until(future.done, deadline)
        if not future.done():
            self.remove_pending_request(future)
            raise self._timeout(timeout_sec)
        return future.result()

    def _call_from_outside(self, request: Message, timeout_sec: float | None) -> Any:
        packed = self._packed(request)
        answers: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._outside.add(answers)
        handle = self._transport.call(self._key(), *packed, answers.put)
        try:
            return self._first_readable(answers, timeout_sec)
        except queue.Empty:
            raise self._timeout(timeout_sec) from None
        finally:
            self._outside.discard(answers)
            handle.close()

    def _first_readable(self, answers: queue.SimpleQueue[Any], timeout_sec: float | None) -> Any:
        """Wait for an answer; one that cannot be read is passed over, since another server may do better."""
        deadline = None if timeout_sec is None else time.monotonic() + timeout_sec
        bad: Exception | None = None
        while True:
            answer = answers.get(timeout=None if deadline is None else max(0.0, deadline - time.monotonic()))
            if answer is _RELEASED:
                raise ExternalShutdownException(f"service {self.srv_name}: the context ended before the answer came")
            if answer is None:
                raise self._no_answer(bad)
            try:
                return self._read(answer)
            except _UNREADABLE as error:
                bad = self._refuse(error)

    def _key(self) -> str:
        """Where to ask: where Humble's servers listen when there are no others."""
        endpoint = self._endpoint
        servers = list(endpoint.others.values())
        only_humble = bool(servers) and all(each.type_hash == NO_HASH for each in servers)
        return endpoint.humble_key if only_humble else endpoint.key

    def _release(self) -> None:
        for answers in list(self._outside):
            answers.put(_RELEASED)

    def _timeout(self, timeout_sec: float | None) -> TimeoutError:
        return TimeoutError(f"service {self.srv_name}: no answer within {timeout_sec} s")

    def _refuse_deadlock(self, executor: Executor) -> None:
        """Say at once when the only server waits for this callback to end."""
        local = [each for node in executor.get_nodes() for each in node.services if each.srv_name == self.srv_name]
        if not local or any(each.callback_group.can_execute(each) for each in local):
            return
        # Unless others serve it too: other processes, other executors.
        if len(self._context.graph.endpoints(EndpointKind.SERVICE, name=self.srv_name)) <= len(local):
            raise ServiceError(
                f"service {self.srv_name} is served only by the callback group that this call keeps busy;"
                " give the service or the caller a callback group of its own, or use call_async"
            )

    def call_async(self, request: Message) -> Future[Any]:
        """Ask; the answer comes through the future, once something spins.

        The future gets a ServiceError when nobody serves or the server goes away before it has answered.
        """
        packed = self._packed(request)
        executor = self.executor
        future: Future[Any] = Future(executor=executor)
        inbox = self._parking if executor is None else executor.inbox
        call = _Call(self, inbox, future)
        self._calls.add(call)
        call.sequence_number = unpack_attachment(packed[1]).sequence
        call.handle = self._transport.call(self._key(), *packed, call.sink)
        return future

    def _packed(self, request: Message) -> tuple[bytes, bytes]:
        if not isinstance(request, self.srv_type.Request):
            raise TypeError(f"Expected {self.srv_type.Request}, got {type(request)}")
        if self._destroyed:
            raise InvalidHandle(f"the client of {self.srv_name} has been destroyed")
        return self._encode(request), self._endpoint.attachment()

    def execute(self, taken: tuple[_Call, Any]) -> None:
        """Complete the future of a call."""
        call, arrived = taken
        if call not in self._calls:
            return
        try:
            answer = None if arrived is None else self._read(arrived)
        except _UNREADABLE as error:
            call.bad = self._refuse(error)  # another server may do better; the end of all answers comes in any case
            return
        self._calls.discard(call)
        if call.handle is not None:
            call.handle.close()
        if answer is None:
            call.future.set_exception(self._no_answer(call.bad))
        else:
            call.future.set_result(answer)

    def _read(self, arrived: Any) -> Any:
        payload, attachment = self._transport.read(arrived)
        unpack_attachment(attachment)
        return self._decode(payload)

    def _no_answer(self, bad: Exception | None) -> ServiceError:
        if bad is None:
            return ServiceError(f"service {self.srv_name}: nobody serves it, or the server went away")
        return ServiceError(f"service {self.srv_name}: the answer cannot be read: {bad}")

    def _refuse(self, error: Exception) -> Exception:
        self.malformed += 1
        if self.malformed == 1:
            get_logger(self.logger_name).warning(
                f"{self.srv_name}: refused an answer that is no {self._endpoint.type_name}: {error}"
                " (the next ones are only counted)"
            )
        return error

    def remove_pending_request(self, future: Future[Any]) -> None:
        """Give up a call: its future will not be completed."""
        for call in [each for each in self._calls if each.future is future]:
            self._calls.discard(call)
            if call.handle is not None:
                call.handle.close()

    def get_pending_request(self, sequence_number: int) -> Future[Any]:
        """Give the future of a call under way. Raises KeyError when there is none of that number."""
        for call in self._calls:
            if call.sequence_number == sequence_number:
                return call.future
        raise KeyError(sequence_number)

    def service_is_ready(self) -> bool:
        """Whether somebody serves this name with this type."""
        return self._endpoint.count_others() > 0

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait until somebody serves; whether so within `timeout_sec` seconds. The end of the context ends it."""
        graph, clock = self._context.graph, self._context.time
        if clock.virtual and timeout_sec is not None:
            if not self.service_is_ready():
                clock.sleep(int(timeout_sec * 1e9))
        else:
            graph.wait_for(lambda: self.service_is_ready() or not self._context.ok(), timeout_sec)
        return self.service_is_ready()

    @property
    def service_name(self) -> str:
        """The service's fully qualified name."""
        return self.srv_name

    @property
    def logger_name(self) -> str:
        """The name of the logger that belongs to the node."""
        return self._endpoint.logger_name

    def destroy(self) -> None:
        """Ask no more. Safe to call twice."""
        if self._destroyed:
            return
        self._destroyed = True
        for call in list(self._calls):
            self.remove_pending_request(call.future)
        self._endpoint.close()
        self.detach()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: Any) -> None:
        self.destroy()
