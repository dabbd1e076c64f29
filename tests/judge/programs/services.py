"""Calls that are answered, time out, are cancelled or are wrong, and the attributes of both ends."""

import threading
import time

import rclpy
from probe import show, took, until
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from std_srvs.srv import SetBool, Trigger

rclpy.init()
n = rclpy.create_node("n16")
c = n.create_client(Trigger, "s16")
took("wait none", c.wait_for_service, 0.3, unit=1)
took("wait zero", c.wait_for_service, 0)
show("ready", c.service_is_ready)
took("wait neg-ish", c.wait_for_service, timeout_sec=0.0)
sv = n.create_service(Trigger, "s16", lambda q, r: (setattr(r, "message", "hi"), r)[1])
show("wait", lambda: c.wait_for_service(3))
show("ready", c.service_is_ready)
show("wait forever", lambda: c.wait_for_service())
show("call_async str", lambda: c.call_async("x"))
show("call_async None", lambda: c.call_async(None))
show("call_async Response", lambda: c.call_async(Trigger.Response()))
show("call_async wrong type", lambda: c.call_async(SetBool.Request()))
show("call wrong", lambda: c.call("x"))
show("call_async class", lambda: c.call_async(Trigger.Request))
f = c.call_async(Trigger.Request())
show("pending", lambda: f.done())
rclpy.spin_until_future_complete(n, f, timeout_sec=2)
show("result", f.result)
e = SingleThreadedExecutor()
e.add_node(n)
th = threading.Thread(target=e.spin, daemon=True)
th.start()
show("call from main", lambda: c.call(Trigger.Request()))
show("call timeout ok", lambda: c.call(Trigger.Request(), timeout_sec=2.0))
e.shutdown()
th.join()
took("call timeout nobody spins", lambda: c.call(Trigger.Request(), timeout_sec=0.3))
fs = [c.call_async(Trigger.Request()) for _ in range(3)]
show("remove_pending", lambda: c.remove_pending_request(fs[0]))
show("remove twice", lambda: c.remove_pending_request(fs[0]))
until(n, lambda: fs[1].done() and fs[2].done())
show("done", lambda: [x.done() for x in fs])
fu = c.call_async(Trigger.Request())
fu.cancel()
show("cancelled call", lambda: (until(n, lambda: False, 0.5), fu.done(), fu.cancelled()))
show("srv_name", lambda: (c.srv_name, sv.srv_name))
show("service_name", lambda: (c.service_name, sv.service_name))
show("srv_type", lambda: c.srv_type.__name__)
show("logger_name", lambda: (c.logger_name, sv.logger_name))
show("destroy", lambda: n.destroy_client(c))
show("twice", lambda: n.destroy_client(c))
show("call destroyed", lambda: c.call_async(Trigger.Request()))
show("wait destroyed", lambda: c.wait_for_service(0.1))
show("ready destroyed", c.service_is_ready)
show("srv destroy", lambda: n.destroy_service(sv))
show("twice", lambda: n.destroy_service(sv))
show("send after", lambda: sv.send_response(Trigger.Response(), None))
show("attributes", lambda: sorted(x for x in dir(c) if not x.startswith("_")))
show("attributes s", lambda: sorted(x for x in dir(sv) if not x.startswith("_")))
c = n.create_client(Trigger, "nobody")
f = c.call_async(Trigger.Request())
took("nobody", lambda: rclpy.spin_until_future_complete(n, f, timeout_sec=0.5))
show("done", f.done)
show("wait str", lambda: c.wait_for_service("1"))


def one(q):
    return Trigger.Response()


sv = n.create_service(Trigger, "s16b", one)
c = n.create_client(Trigger, "s16b")
c.wait_for_service(2)
f = c.call_async(Trigger.Request())
show("callback with one arg", lambda: rclpy.spin_until_future_complete(n, f, timeout_sec=1))
n.destroy_service(sv)
sv = n.create_service(Trigger, "s16c", lambda q, r: (time.sleep(0.01), r)[1])
sv2 = n.create_service(Trigger, "s16c", lambda q, r: r)
show("two servers", lambda: sv2.srv_name)
with n.create_client(Trigger, "w") as w:
    show("with", lambda: w.srv_name)
show("after with", lambda: w.call_async(Trigger.Request()))
