"""A lifecycle node through its transitions, with callbacks that fail."""

import rclpy
import rclpy.lifecycle as LC
from lifecycle_msgs.msg import Transition, TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState
from probe import say, show, until
from rclpy.lifecycle import *
from rclpy.lifecycle import TransitionCallbackReturn
from std_msgs.msg import String

rclpy.init()
log = []


class L(LifecycleNode):
    ret = {}

    def __init__(self, name, **k):
        super().__init__(name, **k)
        self.pub = self.create_lifecycle_publisher(String, "t57", 1)

    def r(self, n, s):
        log.append((n, s.label, s.state_id))
        x = self.ret.get(n, TransitionCallbackReturn.SUCCESS)

    def go(self, n, s):
        self.r(n, s)
        x = self.ret.get(n, TransitionCallbackReturn.SUCCESS)
        if isinstance(x, Exception):
            raise x
        return x

    def on_configure(self, s):
        return self.go("configure", s)

    def on_activate(self, s):
        super().on_activate(s)
        return self.go("activate", s)

    def on_deactivate(self, s):
        super().on_deactivate(s)
        return self.go("deactivate", s)

    def on_cleanup(self, s):
        return self.go("cleanup", s)

    def on_shutdown(self, s):
        return self.go("shutdown", s)

    def on_error(self, s):
        return self.go("error", s)


n = L("n57")
show("state", lambda: n._state_machine.current_state)
show("publish inactive", lambda: n.pub.publish(String()))
show("activated", lambda: n.pub.is_activated)
for t in (
    "trigger_activate",
    "trigger_configure",
    "trigger_configure",
    "trigger_activate",
    "trigger_deactivate",
    "trigger_cleanup",
    "trigger_configure",
    "trigger_shutdown",
    "trigger_configure",
):
    log.clear()
    show(t, lambda: getattr(n, t)().name)
    say(f"after {t}", log, n._state_machine.current_state)
n = L("m57")
n.trigger_configure()
n.trigger_activate()
show("activated", lambda: n.pub.is_activated)
show("publish", lambda: n.pub.publish(String()))
for ret in (TransitionCallbackReturn.FAILURE, TransitionCallbackReturn.ERROR, ValueError("x"), None, True, "s"):
    k = L("k57")
    k.ret = {"configure": ret}
    log.clear()
    show(f"configure {getattr(ret, 'name', ret)!r}", lambda: k.trigger_configure().name)
    say(f"after {getattr(ret, 'name', ret)!r}", [x[0] for x in log], k._state_machine.current_state)
k = L("k57")
k.ret = {"configure": TransitionCallbackReturn.ERROR, "error": TransitionCallbackReturn.FAILURE}
log.clear()
show("error fails", lambda: k.trigger_configure().name)
say("after that", [x[0] for x in log], k._state_machine.current_state)
k = L("k57")
k.ret = {"configure": TransitionCallbackReturn.ERROR, "error": ValueError("e")}
log.clear()
show("error raises", lambda: k.trigger_configure().name)
say("after that", [x[0] for x in log], k._state_machine.current_state)
k = L("k57")
k.trigger_configure()
k.ret = {"activate": TransitionCallbackReturn.FAILURE}
show("activate fails", lambda: k.trigger_activate().name)
say("after that", k._state_machine.current_state, k.pub.is_activated)
n = L("s57")
g = rclpy.create_node("g57")
ev = []
g.create_subscription(
    TransitionEvent,
    "/s57/transition_event",
    lambda m: ev.append((m.transition.id, m.transition.label, m.start_state.label, m.goal_state.label)),
    10,
)
ex = rclpy.executors.SingleThreadedExecutor()
ex.add_node(n)
ex.add_node(g)


def call(t, name, req):
    c = g.create_client(t, f"/s57/{name}")
    c.wait_for_service(2)
    f = c.call_async(req)
    until(ex, f.done)
    return f.result()


show("get_state", lambda: call(GetState, "get_state", GetState.Request()))
show("change", lambda: call(ChangeState, "change_state", ChangeState.Request(transition=Transition(id=1))))
show(
    "by label", lambda: call(ChangeState, "change_state", ChangeState.Request(transition=Transition(label="activate")))
)
show("wrong", lambda: call(ChangeState, "change_state", ChangeState.Request(transition=Transition(id=1))))
show("unknown", lambda: call(ChangeState, "change_state", ChangeState.Request(transition=Transition(id=77))))
show("unknown label", lambda: call(ChangeState, "change_state", ChangeState.Request(transition=Transition(label="zz"))))
show(
    "shutdown by label",
    lambda: call(ChangeState, "change_state", ChangeState.Request(transition=Transition(label="shutdown"))),
)
show("state", lambda: call(GetState, "get_state", GetState.Request()).current_state)
n2 = L("s58")
until(ex, lambda: False, 0.3)
say(ev)
show(
    "states",
    lambda: [
        (x.id, x.label)
        for x in call(GetAvailableStates, "get_available_states", GetAvailableStates.Request()).available_states
    ],
)
show(
    "transitions",
    lambda: [
        (x.transition.id, x.transition.label, x.start_state.label, x.goal_state.label)
        for x in call(
            GetAvailableTransitions, "get_available_transitions", GetAvailableTransitions.Request()
        ).available_transitions
    ],
)
show(
    "graph",
    lambda: [
        (x.transition.id, x.transition.label, x.start_state.id, x.goal_state.id)
        for x in call(
            GetAvailableTransitions, "get_transition_graph", GetAvailableTransitions.Request()
        ).available_transitions
    ],
)


class Def(LifecycleNode):
    pass


d = Def("def57")
show(
    "defaults",
    lambda: [
        f().name
        for f in (d.trigger_configure, d.trigger_activate, d.trigger_deactivate, d.trigger_cleanup, d.trigger_shutdown)
    ],
)
show("no comm", lambda: Def("nc", enable_communication_interface=False).trigger_configure().name)
show("attrs", lambda: sorted(x for x in dir(LifecycleNode) if not x.startswith("_")))
show("module attrs", lambda: sorted(x for x in dir(LC) if x[0].isupper()))
show("returns", lambda: sorted(TransitionCallbackReturn.__members__))


class ME(SimpleManagedEntity):
    def on_activate(self, s):
        log.append("me activate")
        return super().on_activate(s)


k = Def("me57")
k.add_managed_entity(ME())
k.trigger_configure()
log.clear()
k.trigger_activate()
say(log)
m = SimpleManagedEntity()
show(
    "managed",
    lambda: (m.is_activated, m.on_activate(None).name, m.is_activated, m.on_deactivate(None).name, m.is_activated),
)
show("destroy", k.destroy_node)
