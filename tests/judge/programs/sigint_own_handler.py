# signal: INT 0.4

"""Ctrl-C where the program sets a handler after init."""

import signal
import time

import rclpy
from rclpy.signals import SignalHandlerOptions

print(
    [
        int(x) if not hasattr(x, "name") else (x.name)
        for x in (
            SignalHandlerOptions.NO,
            SignalHandlerOptions.ALL,
            SignalHandlerOptions.SIGINT,
            SignalHandlerOptions.SIGTERM,
        )
    ]
)
rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
n = rclpy.create_node("n28")
n.create_timer(0.1, lambda: None)
got = []
signal.signal(signal.SIGINT, lambda s, f: got.append(s))
print("READY", flush=True)
t = time.monotonic()
while time.monotonic() - t < 1:
    rclpy.spin_once(n, timeout_sec=0.2)
print(got, rclpy.ok())
rclpy.shutdown()
