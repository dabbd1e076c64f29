"""init, shutdown and their context, in order and out of order, with good and bad arguments."""

import os

import rclpy
from probe import kindof, say, show

show("ok before init", rclpy.ok)
show("shutdown before init", rclpy.shutdown)
show("try_shutdown before init", rclpy.try_shutdown)
show("create_node before init", rclpy.create_node, "n")
show("get_global_executor before init", lambda: type(rclpy.get_global_executor()).__name__)
show("domain id before init", lambda: rclpy.utilities.get_default_context().get_domain_id())
kindof("init", rclpy.init)
show("ok", rclpy.ok)
show("init twice", rclpy.init)
show("shutdown", rclpy.shutdown)
show("ok after", rclpy.ok)
show("shutdown twice", rclpy.shutdown)
show("try_shutdown after", rclpy.try_shutdown)
kindof("init again", rclpy.init)
show("domain", lambda: rclpy.get_default_context().get_domain_id() == int(os.environ["ROS_DOMAIN_ID"]))
show("try_shutdown", rclpy.try_shutdown)
with rclpy.init() as c:
    say("context manager", type(c).__name__, rclpy.ok())
say("after context manager", rclpy.ok())
with rclpy.init(args=["x", "--ros-args", "-r", "__node:=q"]) as c:
    say(rclpy.create_node("n").get_name())
    rclpy.shutdown()
say("after", rclpy.ok())
show("init with domain", lambda: rclpy.init(domain_id=11))
show("domain", lambda: rclpy.get_default_context().get_domain_id())
rclpy.shutdown()
show("negative domain", lambda: rclpy.init(domain_id=-1))
rclpy.try_shutdown()
show("bad args type", lambda: rclpy.init(args="abc"))
rclpy.try_shutdown()
show("args ints", lambda: rclpy.init(args=[1, 2]))
rclpy.try_shutdown()
show("rmw", rclpy.get_rmw_implementation_identifier) if False else None
show("unknown ros arg", lambda: rclpy.init(args=["--ros-args", "--nonsense"]))
say(rclpy.ok())
rclpy.try_shutdown()
show("bad remap", lambda: rclpy.init(args=["--ros-args", "-r", "a b"]))
show("bad param", lambda: rclpy.init(args=["--ros-args", "-p", "a"]))
show("bad log level", lambda: rclpy.init(args=["--ros-args", "--log-level", "loud"]))
show("missing params file", lambda: rclpy.init(args=["--ros-args", "--params-file", "/nonexistent.yaml"]))
show("dangling -p", lambda: rclpy.init(args=["--ros-args", "-p"]))
