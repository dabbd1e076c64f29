"""Goals that succeed, abort, are rejected or cancelled, and what their callbacks may do wrong."""

import threading
import time

import rclpy
from probe import say, show, took
from rclpy.action import *
from rclpy.action.server import ServerGoalHandle
from rclpy.executors import MultiThreadedExecutor
from test_msgs.action import Fibonacci

rclpy.init()
n = rclpy.create_node("n55")
log = []


def execute(g):
    log.append(("exec", g.request.order, str(g.status), g.is_active, g.is_cancel_requested))
    for i in range(g.request.order):
        if g.is_cancel_requested:
            g.canceled()
            return Fibonacci.Result(sequence=[9])
        g.publish_feedback(Fibonacci.Feedback(sequence=[i]))
        time.sleep(0.05)
    if g.request.order == 2:
        g.abort()
        return Fibonacci.Result(sequence=[2])
    if g.request.order == 1:
        return Fibonacci.Result(sequence=[1])
    if g.request.order == 4:
        raise ValueError("in execute")
    if g.request.order == 5:
        return None
    if g.request.order == 6:
        g.succeed()
        g.succeed()
    g.succeed()
    return Fibonacci.Result(sequence=[0, 1])


s = ActionServer(
    n,
    Fibonacci,
    "a55",
    execute,
    goal_callback=lambda g: GoalResponse.REJECT if g.order == 99 else GoalResponse.ACCEPT,
    cancel_callback=lambda g: CancelResponse.ACCEPT if g.request.order != 30 else CancelResponse.REJECT,
    callback_group=rclpy.callback_groups.ReentrantCallbackGroup(),
)
c = ActionClient(n, Fibonacci, "a55")
e = MultiThreadedExecutor(4)
e.add_node(n)
th = threading.Thread(target=e.spin, daemon=True)
th.start()
took("wait none", lambda: ActionClient(n, Fibonacci, "zz").wait_for_server(0.3), unit=0.5)
show("wait", lambda: c.wait_for_server(3))
show("ready", c.server_is_ready)


def w(f, t=3):
    t0 = time.monotonic()
    while not f.done() and time.monotonic() - t0 < t:
        time.sleep(0.01)
    return f.result() if f.done() else "pending"


fb = []


def goal(order, cancel=None):
    g = w(
        c.send_goal_async(Fibonacci.Goal(order=order), feedback_callback=lambda m: fb.append(list(m.feedback.sequence)))
    )
    if not g.accepted:
        return ("rejected", g.status)
    rf = g.get_result_async()
    if cancel is not None:
        time.sleep(cancel)
        r = w(g.cancel_goal_async())
        log.append(("cancel", r.return_code, len(r.goals_canceling)))
    r = w(rf)
    return (g.accepted, r if isinstance(r, str) else (r.status, list(r.result.sequence)), g.status)


for o in (3, 1, 2, 99, 0):
    fb.clear()
    log.clear()
    show(f"goal {o}", lambda: goal(o))
    time.sleep(0.1)
    say(log, fb)
log.clear()
show("cancel", lambda: goal(20, 0.2))
say(log)
log.clear()
show("cancel rejected", lambda: goal(30, 0.1))
say(log[1:])
show("attributes handle", lambda: sorted(x for x in dir(ServerGoalHandle) if not x.startswith("_")))
show("attributes server", lambda: sorted(x for x in dir(s) if not x.startswith("_")))
show("attributes client", lambda: sorted(x for x in dir(c) if not x.startswith("_")))
show("send wrong", lambda: c.send_goal_async("x"))
show("send sync wrong", lambda: c.send_goal("x"))
show("send_goal sync", lambda: (lambda r: (r.status, list(r.result.sequence)))(c.send_goal(Fibonacci.Goal(order=0))))
for o in (4, 6):
    show(f"goal {o}", lambda: goal(o))
    time.sleep(0.2)
show("thread alive", th.is_alive)
