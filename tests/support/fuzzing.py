"""Fuzz of every shipped program: hostile messages, requests, responses and parameters, in virtual time.

Each program of `fuzzed_programs` runs in a host of its own. All its topics, services, actions and parameters are found
in the graph, and so are those of others that it calls, which are served with hostile responses.
"""

from __future__ import annotations

import contextlib
import math
import os
import random
import sys
import tempfile
import time
from collections import deque
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

from robolink import Node, logging
from robolink.control import keyboard
from robolink.host import Host
from robolink.impl.log_output import Record, output
from robolink.interfaces import find_announced
from robolink.interfaces.rcl_interfaces import msg, srv
from robolink.launch.shared_process import Member
from robolink.message import encode, type_hash
from robolink.parameter import Parameter
from robolink.qos import QoSProfile
from robolink.text.tracebacks import formatted
from robolink.wire import DataKey, EndpointKind, EndpointToken, format_key, pack_attachment
from tests.support.fuzzed_programs import Fuzzed
from tests.support.hostile_values import Hostile

PAUSES = (0.0, 0.0, 0.01, 0.01, 0.05, 0.05, 0.3, 1.2)
"""Seconds of virtual time after a burst."""
BURST = 12
"""Most messages and calls between two pauses."""
PENDING = 8
"""Most requests of one service that wait for a response."""
MOST_STARTS = 20
"""Times that a program is started, and again for every three messages."""


class Ended(NamedTuple):
    """An end that should not have been: the error's text, and what had been sent last."""

    error: str
    last: list[str]


class Outcome(NamedTuple):
    """Result of one program's fuzz."""

    sent: int
    calls: int
    answers: int
    kinds: int
    """Number of the topics, services and clients that were met."""
    starts: int
    slowest: float
    """CPU time of the slowest burst, in seconds."""
    ended: list[Ended]


class Fuzzer(Node):
    """The node that publishes, calls and serves."""

    def __init__(self) -> None:
        super().__init__("fuzzer")


class Typist:
    """A keyboard on which somebody types at random."""

    def __init__(self, *_: object) -> None:
        self._dice = random.Random(5)

    def read(self) -> str:
        """Return some keys, none that ends a program."""
        return "".join(self._dice.choices("wasdijkluo zxe,.\x1bAB[\u00e9\0", k=self._dice.randrange(3)))

    def close(self) -> None:
        """Nothing was opened."""


class Attack:
    """One program in a host, and what is sent to it.

    Args:
        fuzzed: The program.
        seed: Seed of all chance.
    """

    def __init__(self, fuzzed: Fuzzed, seed: int) -> None:
        self.fuzzed, self.dice = fuzzed, random.Random(f"{seed} {fuzzed.name}")
        self.hostile = Hostile(self.dice)
        self.sent, self.calls, self.answers, self.starts = 0, 0, 0, 1
        self.slowest = 0.0
        self.ended: dict[str, Ended] = {}
        self._met: set[tuple[EndpointKind, str]] = set()
        self._last: deque[tuple[str, Any]] = deque(maxlen=4)
        self._log: deque[str] = deque(maxlen=5)
        self._publishers: dict[tuple[str, str], Any] = {}
        self._driven: set[str] = set()
        self._clients: dict[str, Any] = {}
        self._waiting: dict[str, deque[Any]] = {}
        self._served: dict[str, Any] = {}

    def begin(self, host: Host) -> None:
        """Start the program in a host."""
        self.host, self.node = host, host.start_node(Fuzzer)
        for topic, name in self.fuzzed.published.items():
            self._publishers[topic, name] = self.node.create_publisher(find_announced(name), topic, 10)
        self.program = host.start("fuzzed", [Member("fuzzed", self.fuzzed.name, list(self.fuzzed.args))])
        host.run(1.0)
        if self.program.is_over and not self.fuzzed.ends:
            self._note_end()

    def go_on(self, messages: int) -> None:
        """Send this many messages and requests, as long as the program starts at all."""
        logging.add_handler(self._note)
        try:
            until = self.sent + self.calls + messages
            while self.sent + self.calls < until and self.starts < MOST_STARTS + messages // 3:
                self._burst()
        finally:
            logging.remove_handler(self._note)

    @property
    def outcome(self) -> Outcome:
        """Outcome so far."""
        counts = self.sent, self.calls, self.answers, len(self._met), self.starts
        return Outcome(*counts, round(self.slowest, 2), list(self.ended.values()))

    def _note(self, record: Record) -> None:
        self._log.append(record.message)

    def _burst(self) -> None:
        tokens = self._tokens()
        begun = time.process_time()
        for _ in range(self.dice.randint(1, BURST)):
            if tokens:
                self._act(self.dice.choice(tokens))
            else:
                self.sent += 1  # a program that neither hears nor serves: time passes all the same
        self._settle(self.dice.choice(PAUSES))
        self.slowest = max(self.slowest, time.process_time() - begun)

    def _settle(self, seconds: float) -> None:
        """Let time pass, and start the program again if it has ended."""
        self.host.run(seconds)
        if not self.program.is_over:
            return
        if self.program.error is not None or not self.fuzzed.ends:
            self._note_end()
        self.starts += 1
        self.host.restart("fuzzed")
        self.host.run(0.5)

    def _note_end(self) -> None:
        error = self.program.error
        text = formatted(error, error.__traceback__) if error is not None else f"exit {self.program.returncode}"
        told = text if error is not None else "\n".join([text, *self._log])
        self.ended.setdefault(
            _place(text), Ended(told[-3000:], [f"{name} {_brief(message)}" for name, message in self._last])
        )

    # What there is

    def _tokens(self) -> list[EndpointToken]:
        """Return the program's ends, and have its clients answered; parameters and /clock come as often as others."""
        tokens = [each for each in self.node.context.graph.endpoints(*EndpointKind) if each.node_name != "fuzzer"]
        for each in tokens:
            if each.kind is EndpointKind.PUBLISHER and each.type_name in _COMMANDS and each.name not in self._driven:
                self._watch(each)
        tokens = [each for each in tokens if each.kind is not EndpointKind.PUBLISHER]
        self._met.update((each.kind, each.name) for each in tokens)
        for each in tokens:
            if each.kind is EndpointKind.CLIENT and each.name not in self._served:
                self._serve(each)
        own = [each for each in tokens if each.kind is not EndpointKind.CLIENT]
        of_all = [each for each in own if each.name.rpartition("/")[2] in _EVERYBODYS]
        several = [each for each in own if each not in of_all]
        return [*several * max(1, 2 * len(of_all) // max(1, len(several))), *of_all]

    def _watch(self, token: EndpointToken) -> None:
        """See that a program never commands a speed that is not finite."""
        self._driven.add(token.name)

        def check(command: Any) -> None:
            twist = getattr(command, "twist", command)
            if not all(math.isfinite(getattr(part, axis)) for part in (twist.linear, twist.angular) for axis in "xyz"):
                last = [f"{name} {_brief(message)}" for name, message in self._last]
                self.ended.setdefault(f"drives {token.name}", Ended(f"it commands {twist} on {token.name}", last))

        if not self.fuzzed.name.startswith("topic_tools"):  # those pass on what they get
            self.node.create_subscription(find_announced(token.type_name), token.name, check, 10)

    def _serve(self, token: EndpointToken) -> None:
        kind = find_announced(token.type_name)

        def answer(request: Any, response: Any) -> Any:
            return self.hostile.message(kind.Response)

        self._served[token.name] = self.node.create_service(kind, token.name, answer)

    # What is sent

    def _act(self, token: EndpointToken) -> None:
        kind = find_announced(token.type_name)
        if token.kind is EndpointKind.SUBSCRIPTION:
            self._publish(token, kind)
        elif token.name.endswith("/set_parameters") and self.dice.random() < 0.8:
            self._call(token, kind, self._parameter_request())
        else:
            self._call(token, kind, self.hostile.message(kind.Request))

    def _publish(self, token: EndpointToken, kind: Any) -> None:
        key = token.name, token.type_name
        if key not in self._publishers:
            profile = QoSProfile(depth=10, durability=token.qos.durability, reliability=token.qos.reliability)
            self._publishers[key] = self.node.create_publisher(kind, token.name, profile)
        message = self.hostile.message(kind)
        self._last.append((token.name, message))
        if self.dice.random() < 0.05:
            self._last.append(("damaged, that is", ""))
            message = self.hostile.payload(encode(message))
        self._publishers[key].publish(message)
        self.sent += 1

    def _call(self, token: EndpointToken, kind: Any, request: Any) -> None:
        self.calls += 1
        self._last.append((token.name, request))
        if self.dice.random() < 0.03:
            self._last.append(("damaged, that is", ""))
            key = format_key(DataKey(token.domain, token.name, token.type_name, type_hash(kind)))
            attachment = pack_attachment(1, 0, b"x" * 16)
            self._keep(token.name, _Raw(self, key, self.hostile.payload(encode(request)), attachment))
            return
        client = self._clients.get(token.name)
        if client is None:
            client = self._clients[token.name] = self.node.create_client(kind, token.name)
        future = client.call_async(request)
        future.add_done_callback(self._answered)
        self._keep(token.name, _Asked(client, future))

    def _keep(self, name: str, call: Any) -> None:
        waiting = self._waiting.setdefault(name, deque())
        waiting.append(call)
        while len(waiting) > PENDING:
            waiting.popleft().close()

    def _answered(self, future: Any) -> None:
        self.answers += 1
        if not future.cancelled():
            future.exception()

    def _parameter_request(self) -> Any:
        nodes = self.program.nodes
        known = [each for node in nodes for each in node._parameters.values()] or [Parameter("x", value=1)]
        chosen = self.dice.choices(known, k=self.dice.randint(1, 2))
        return srv.SetParameters.Request(parameters=[self._parameter(each) for each in chosen])

    def _parameter(self, known: Any) -> Any:
        value = self.hostile.message(msg.ParameterValue, 0.5)
        if self.dice.random() < 0.8:
            value.type = known.type_.value
        if known.name == "use_sim_time":
            value.bool_value = self.dice.random() < 0.2
        return msg.Parameter(name=known.name, value=value)


class _Asked:
    """A request that waits for its response."""

    def __init__(self, client: Any, future: Any) -> None:
        self._client, self._future = client, future

    def close(self) -> None:
        self._client.remove_pending_request(self._future)


class _Raw:
    """Bytes of a request, and whatever comes back."""

    def __init__(self, attack: Attack, key: str, payload: bytes, attachment: bytes) -> None:
        self._call = attack.node.context.transport.call(key, payload, attachment, lambda response: None)

    def close(self) -> None:
        self._call.close()


_COMMANDS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_EVERYBODYS = (
    "describe_parameters",
    "get_parameter_types",
    "get_parameters",
    "list_parameters",
    "set_parameters",
    "set_parameters_atomically",
    "get_type_description",
)


def _brief(message: Any) -> str:
    text = repr(message)
    return text if len(text) < 1500 else f"{text[:1500]} ... ({len(text)} characters)"


def _place(text: str) -> str:
    """Return where a traceback ends and its last line, by which two ends are the same."""
    lines = [each.strip() for each in text.splitlines()]
    places = [each for each in lines if each.startswith("File ")]
    return (places[-1] if places else "") + lines[-1].partition(":")[0]


@contextlib.contextmanager
def apart() -> Iterator[None]:
    """Work in a folder of its own, with a terminal on which somebody types, and lines of the log to nobody."""
    kept = {name: getattr(keyboard, name) for name in ("sys", "PosixKeyboard", "WindowsKeyboard", "_in_background")}
    here, console, home = Path.cwd(), output.console, os.environ.get("HOME", "")
    with tempfile.TemporaryDirectory(prefix="robolink-fuzz-") as folder:
        deep = Path(folder, "a", "b")
        deep.mkdir(parents=True)
        try:
            os.chdir(deep)
            os.environ["HOME"] = str(deep)
            output.console = None
            setattr(keyboard, "sys", SimpleNamespace(stdin=_Terminal(), platform=sys.platform))  # noqa: B010 - the name is the module's, not its own
            keyboard.PosixKeyboard = keyboard.WindowsKeyboard = Typist  # type: ignore[misc,assignment]
            keyboard._in_background = lambda terminal: False
            yield
        finally:
            os.chdir(here)
            os.environ["HOME"] = home
            output.console = console
            for name, value in kept.items():
                setattr(keyboard, name, value)


class _Terminal:
    """Standard input that is a terminal."""

    closed = False

    def isatty(self) -> bool:
        return True

    def fileno(self) -> int:
        return 0

    def close(self) -> None:
        """It stays."""


def attacked(fuzzed: Fuzzed, messages: int, seed: int) -> Outcome:
    """Fuzz one program in this process, and return what came of it."""
    attack = Attack(fuzzed, seed)
    with apart(), Host(seed=seed) as host:
        attack.begin(host)
        attack.go_on(messages)
    return attack.outcome
