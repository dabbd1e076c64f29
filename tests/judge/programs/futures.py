"""Futures that are done, are cancelled, fail, or are awaited."""

import gc
import sys

import rclpy
from probe import say, show
from rclpy.task import Future, Task

f = Future()
show("repr-ish", lambda: str(f).split("Future")[0][-1:] if "Future" in str(f) else str(f))
show("bool", lambda: bool(f))
show("result pending", f.result)
show("exception pending", f.exception)
show("done", f.done)
show("cancelled", f.cancelled)
log = []
f.add_done_callback(lambda x: log.append(("a", x is f)))
f.set_result(1)
say(log)
f.add_done_callback(lambda x: log.append("late"))
say(log)
show("set twice", lambda: f.set_result(2))
show("r", f.result)
show("cancel after done", f.cancel)
show("cancelled", f.cancelled)
show("done", f.done)
f = Future()
f.cancel()
show("cancelled", lambda: (f.done(), f.cancelled()))
show("result of cancelled", f.result)
show("set after cancel", lambda: f.set_result(3))
show("r", lambda: (f.done(), f.cancelled(), f.result()))
f = Future()
f.add_done_callback(lambda x: log.append("c"))
f.cancel()
say(log)
f = Future()
f.set_exception(ValueError("v"))
show("exc", f.exception)
show("res", f.result)
f = Future()
f.set_exception("text")
show("exc str", f.exception)
f = Future()
show("add None", lambda: f.add_done_callback(None))
f = Future()
show("add 3 then done", lambda: (f.add_done_callback(lambda: 0), f.set_result(1)))
f = Future()
f.add_done_callback(lambda x: 1 / 0)
show("done callback raises", lambda: f.set_result(1))
show("done", f.done)
g = lambda x: log.append("g")
f = Future()
f.add_done_callback(g)
show("remove", lambda: f.remove_done_callback(g))
show("remove unknown", lambda: f.remove_done_callback(g))
f.set_result(1)
say(log)
f = Future()
f.set_exception(ValueError("never asked"))
del f
gc.collect()
sys.stderr.flush()
show("await outside", lambda: [x for x in Future().__await__()][:0] if False else "skip")
f = Future()
it = f.__await__()
show("await yields", lambda: type(next(it)).__name__)
f.set_result(9)
show("await ends", lambda: next(it))


async def co():
    return 7


t = Task(co, (), {}) if False else Task(co)
show("task", lambda: (t(), t.done(), t.result())[1:])


def fn(a, b=1):
    return a + b


t = Task(fn, args=(1,), kwargs={"b": 4})
show("task fn", lambda: (t(), t.result()))
t = Task(lambda: 1 / 0)
show("task raises", t)
show("exc", t.exception)
show("res", t.result)
t = Task(co)
t.cancel()
show("cancel task", lambda: (t.done(), t.cancelled()))
show("run cancelled", t)
show("executing", lambda: Task(co).executing())
show("Future executor arg", lambda: Future(executor=None).done())
show("context manager", lambda: hasattr(Future, "__enter__"))
show("attributes", lambda: sorted(x for x in dir(Future) if not x.startswith("_")))
show("task attributes", lambda: sorted(x for x in dir(Task) if not x.startswith("_")))
