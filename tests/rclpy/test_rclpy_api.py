"""rclpy's face: every public name and signature of rclpy 8.0 is here too, but for those listed with a reason.

`data/rclpy_api.json` holds the facts: names, and parameters as text, as they stand in rclpy's source. A signature here
may have more than rclpy's, behind it and optional; types are our own.
"""

from __future__ import annotations

import fnmatch
import importlib
import inspect
import json
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from robolink import Context, Node
from robolink.lifecycle import LifecycleNode

TABLE = json.loads((Path(__file__).parents[1] / "data" / "rclpy_api.json").read_text())
MODULES: dict[str, dict[str, Any]] = TABLE["modules"]

ABSENT = {
    "*.__del__": "what nobody holds any more is let go without it",
    "*.add_future": "rclpy's wait sets; a callback that waits for a future is a task of the executor",
    "*.remove_future": "rclpy's wait sets; a callback that waits for a future is a task of the executor",
    "*.add_to_wait_set": "takes a C wait set; Waitable.entities() says what an executor runs",
    "*.is_ready": "takes a C wait set; Waitable.entities() says what an executor runs",
    "*.take_data": "takes from a C handle; Waitable.entities() says what an executor runs",
    "action.*.execute": "takes what take_data gave; Waitable.entities() says what an executor runs",
    "waitable.Waitable.execute": "takes what take_data gave; Waitable.entities() says what an executor runs",
    "event_handler.EventHandler.execute": "ours is given what our executor has taken",
    "event_handler.EventHandler.get_num_entities": "fills a C wait set",
    "context.g_logging_*": "counts the users of the C library's logging",
    "executors.TimeoutObject": "how rclpy's spinning keeps its deadline inside",
    "impl.implementation_singleton.package": "where rclpy's C library is",
    "impl.rcutils_logger.CallerId": "the logger's inside: where a line was logged",
    "impl.rcutils_logger.*Context": "the logger's inside: what its filters remember; for type checkers",
    "impl.rcutils_logger.LoggingArgs": "for type checkers",
    "impl.rcutils_logger.LoggingFilter": "the logger's inside; its keywords are the same",
    "impl.rcutils_logger.Once": "the logger's inside; its keywords are the same",
    "impl.rcutils_logger.Throttle": "the logger's inside; its keywords are the same",
    "impl.rcutils_logger.SkipFirst": "the logger's inside; its keywords are the same",
    "impl.rcutils_logger.supported_filters": "the logger's inside; its keywords are the same",
    "impl.rcutils_logger.get_filters_from_kwargs": "the logger's inside; its keywords are the same",
    "signals.SignalHandlerGuardCondition": "wakes a C wait set; executors here are told by their context",
    "type_support.Srv.*": "each service class has its own; their base has none",
    "type_support.*MetaClass": "describes rosidl's generated classes to type checkers",
    "type_support.PyCapsule": "describes rosidl's generated classes to type checkers",
    "type_support.ProtocolType": "describes rosidl's generated classes to type checkers",
    "utilities.g_*": "rclpy's module variables; get_default_context() gives the context",
}
"""What is left out, and why; patterns of names below rclpy."""

OTHERWISE = {
    "client.Client.__init__": "made by Node.create_client; rclpy's takes a C handle",
    "service.Service.__init__": "made by Node.create_service; rclpy's takes a C handle",
    "publisher.Publisher.__init__": "made by Node.create_publisher; rclpy's takes a C handle",
    "subscription.Subscription.__init__": "made by Node.create_subscription; rclpy's takes a C handle",
    "event_handler.*EventHandler.__init__": "made by the event callbacks; rclpy's takes a C handle",
    "*.__exit__": "what ended the block changes nothing: the three are one *args",
    "*.TopicEndpointInfo.__init__": "None stands for a new TypeHash: rclpy's default is one for all",
}
"""Whose parameters are others on purpose, and why."""


class Callee(NamedTuple):
    """A function or method of rclpy."""

    module: str
    owner: str
    name: str
    signature: str

    @property
    def path(self) -> str:
        return ".".join(part for part in (self.module, self.owner, self.name) if part)


def listed(path: str, table: dict[str, str]) -> bool:
    return any(fnmatch.fnmatchcase(path, pattern) for pattern in table)


def home(module: str) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # modules of an older name say so, as rclpy's do
        return importlib.import_module(f"robolink.{module}" if module else "robolink")


def names() -> Iterator[tuple[str, str]]:
    """Every name that a module has; below a class: `Class.name`."""
    for module, facts in MODULES.items():
        yield from ((module, name) for name in (*facts.get("names", ()), *facts.get("functions", ())))
        for cls, parts in facts.get("classes", {}).items():
            yield module, cls
            for kind in ("calls", "properties", "attributes"):
                yield from ((module, f"{cls}.{name}") for name in parts.get(kind, ()))


def callees() -> Iterator[Callee]:
    for module, facts in MODULES.items():
        for name, signature in facts.get("functions", {}).items():
            yield Callee(module, "", name, signature)
        for cls, parts in facts.get("classes", {}).items():
            for name, signature in parts.get("calls", {}).items():
                if not name.startswith("__") or name in ("__init__", "__new__", "__exit__", "__call__"):
                    yield Callee(module, cls, name, signature)


def is_left_out(module: str, name: str) -> bool:
    """Whether a name, or the class that it is in, is left out."""
    parts = name.split(".")
    return any(listed(".".join(filter(None, [module, *parts[:upto]])), ABSENT) for upto in range(1, len(parts) + 1))


@pytest.mark.parametrize("module", sorted(MODULES))
def test_every_module_is_there(module: str) -> None:
    assert home(module)


@pytest.mark.parametrize("module", sorted(MODULES))
def test_every_name_is_there(module: str) -> None:
    missing = []
    for _, name in (each for each in names() if each[0] == module and not is_left_out(*each)):
        found = home(module)
        for part in name.split("."):
            found = getattr(found, part, inspect.Parameter.empty)
        if found is inspect.Parameter.empty and not is_slot(module, name):
            missing.append(name)
    assert missing == []


def is_slot(module: str, name: str) -> bool:
    """Whether it is an attribute that a class's instances have: it is annotated, or `__init__` speaks of it."""
    owner, _, attribute = name.partition(".")
    cls = getattr(home(module), owner, None)
    for each in getattr(cls, "__mro__", ()):
        code = getattr(vars(each).get("__init__"), "__code__", None)
        if attribute in getattr(each, "__annotations__", {}) or (code is not None and attribute in code.co_names):
            return True
    return False


def parameters(signature: str, namespace: dict[str, Any]) -> list[inspect.Parameter]:
    """The parameters that a text of rclpy's states; defaults are worth what they are worth in our module."""
    text = signature.rpartition("@")[2].partition(" ")[2] if signature.startswith("@") else signature
    scope = vars(home("qos")) | {"Duration": home("duration").Duration, "_TYPE_HASH_SIZE": 32} | namespace
    made = eval(f"lambda {text}: None", scope)  # text of our own data file
    return list(inspect.signature(made).parameters.values())


def difference(theirs: list[inspect.Parameter], ours: list[inspect.Parameter]) -> str:
    """Say in what ours differ; nothing if whoever calls theirs can call ours."""
    rest = {each.name: each for each in ours}
    takes_any = any(each.kind is each.VAR_KEYWORD for each in ours)
    order = [each.name for each in ours if each.kind is not each.VAR_KEYWORD]
    for at, their in enumerate(theirs):
        our = rest.pop(their.name, None)
        if their.kind in (their.VAR_KEYWORD, their.VAR_POSITIONAL):
            continue
        if our is None:
            return f"no parameter '{their.name}'" + (" of its own" if takes_any else "")
        if our.kind is not their.kind:
            return f"'{their.name}' is {our.kind.description}, theirs {their.kind.description}"
        if order[at : at + 1] != [their.name] and their.kind is not their.KEYWORD_ONLY:
            return f"'{their.name}' stands elsewhere"
        if not same_default(their.default, our.default):
            return f"'{their.name}' defaults to {our.default!r}, theirs to {their.default!r}"
    more = [each.name for each in rest.values() if each.default is each.empty and each.kind not in (2, 4)]
    return f"more that must be given: {', '.join(more)}" if more else ""


def same_default(theirs: Any, ours: Any) -> bool:
    return theirs is ours or (type(theirs) is type(ours) and theirs == ours)


def our_parameters(callee: Callee) -> list[inspect.Parameter]:
    found = getattr(home(callee.module), callee.owner) if callee.owner else home(callee.module)
    if callee.name in ("__init__", "__new__"):
        if not inspect.isfunction(found.__init__) and issubclass(found, Exception):  # takes whatever there is
            return [inspect.Parameter("args", inspect.Parameter.VAR_POSITIONAL)]
        return list(inspect.signature(found).parameters.values())
    member = inspect.getattr_static(found, callee.name, None) or getattr(found, callee.name)
    bound = isinstance(member, (staticmethod, classmethod)) or not callee.owner
    made = list(inspect.signature(getattr(found, callee.name)).parameters.values())
    return made if bound else made[1:]


def their_parameters(callee: Callee) -> list[inspect.Parameter]:
    made = parameters(callee.signature, vars(home(callee.module)))
    is_static = "@staticmethod" in callee.signature
    return made[1:] if callee.owner and not is_static else made


CALLEES = [
    each
    for each in callees()
    if not is_left_out(each.module, ".".join(filter(None, [each.owner, each.name])))
    and not listed(each.path, OTHERWISE)
]


def test_every_signature_takes_what_rclpys_takes() -> None:
    said = {each.path: difference(their_parameters(each), our_parameters(each)) for each in CALLEES}
    assert {path: text for path, text in said.items() if text} == {}


USED = [
    ("action.client", "GoalStatus"),
    ("action.server", "GoalStatus"),
    ("clock", "Duration"),
    ("clock", "ClockType"),
    ("executors", "ExternalShutdownException"),
    ("lifecycle.node", "TransitionCallbackReturn"),
    ("lifecycle.node", "LifecycleState"),
    ("service", "ServiceIntrospectionState"),
    ("time", "Duration"),
    ("qos_event", "SubscriptionEventCallbacks"),
]
"""What programs take from a module that only imports it; counted in public programs."""


@pytest.mark.parametrize(("module", "name"), USED)
def test_names_that_programs_take_from_elsewhere(module: str, name: str) -> None:
    assert getattr(home(module), name)


PRIVATE = """
_allow_undeclared_parameters _clients _clock _context _default_callback_group _descriptors _destroyed _guards
_logger _logger_service _managed_entities _on_set_parameters_callbacks _parameter_overrides _parameter_service
_parameters _post_set_parameters_callbacks _pre_set_parameters_callbacks _publishers _rate_group _services
_state_machine _subscriptions _time_source _timers _type_description_service handle
"""
"""What a node of rclpy's has as well, so that no program uses it for something else; `_destroyed` harms nobody."""

SINCE_LYRICAL = """
get_action_names_and_types get_action_client_names_and_types_by_node get_action_server_names_and_types_by_node
get_servers_info_by_service get_clients_info_by_service
"""
"""Names that a node has since rclpy of 2026, which the list of rclpy 8 does not have."""


@pytest.mark.parametrize("kind", [Node, LifecycleNode])
def test_a_subclass_of_node_may_use_every_name_that_rclpy_leaves_free(kind: type[Node], context: Context) -> None:
    node = kind("robot", context=context)
    reserved = {each for each in {*dir(kind), *vars(node)} if each[0] == "_" and (each[-1] == "_" or "__" in each)}
    classes = [each for room in ("node", "lifecycle.node") for each in MODULES[room]["classes"].values()]
    theirs = {name for each in classes for part in ("attributes", "calls", "properties") for name in each.get(part, ())}
    assert {*dir(kind), *vars(node)} - reserved - theirs - {*PRIVATE.split(), *SINCE_LYRICAL.split()} == set()


def test_each_exception_to_the_rule_is_one() -> None:
    every = [".".join(filter(None, each)) for each in names()]
    assert [pattern for pattern in ABSENT if not fnmatch.filter(every, pattern)] == []
    paths = [each.path for each in callees()]
    assert [pattern for pattern in OTHERWISE if not fnmatch.filter(paths, pattern)] == []


@pytest.mark.parametrize(
    ("theirs", "ours", "said"),
    [
        ("a, b=1", "a, b=1, c=2", ""),
        ("a, *, b=1", "a, *, c=0, b=1, **more", ""),
        ("a, **kwargs", "a, *, b=1", ""),
        ("a", "b", "no parameter 'a'"),
        ("a, b", "b, a", "'a' stands elsewhere"),
        ("a", "a, c", "more that must be given: c"),
        ("a=1", "a=2", "'a' defaults to 2, theirs to 1"),
        ("a=1", "a=True", "'a' defaults to True, theirs to 1"),
        ("a", "*, a", "'a' is keyword-only, theirs positional or keyword"),
    ],
)
def test_the_comparison_finds_what_differs(theirs: str, ours: str, said: str) -> None:
    assert difference(parameters(theirs, {}), parameters(ours, {})) == said
