"""The exit codes of programs that end in different ways."""

import os
import subprocess
import sys
import textwrap
import time

from probe import say

COMMAND = (
    [sys.executable]
    if "robolink" not in sys.modules
    else [os.path.join(os.path.dirname(sys.executable), "robolink"), "run"]
)


def run(label, code):
    path = "exit_code.py"
    open(path, "w").write("import rclpy, sys, threading, time\n" + textwrap.dedent(code))
    t = time.monotonic()
    try:
        p = subprocess.run([*COMMAND, path], capture_output=True, text=True, timeout=15)
        say(
            label,
            p.returncode,
            p.stdout.split(),
            p.stderr.strip().splitlines()[-1:] if p.returncode in (0, 1) else "",
            "slow" if time.monotonic() - t > 6 else "",
        )
    except subprocess.TimeoutExpired:
        say(label, "hangs")


run("no shutdown", "rclpy.init(); n = rclpy.create_node('n70'); print('end')")
run(
    "no shutdown, thread",
    "rclpy.init(); n = rclpy.create_node('n70'); threading.Thread(target=rclpy.spin, args=(n,), daemon=True).start(); time.sleep(0.3); print('end')",
)
run("exception", "rclpy.init(); n = rclpy.create_node('n70'); raise ValueError('x')")
run("sys.exit 3", "rclpy.init(); n = rclpy.create_node('n70'); sys.exit(3)")
run(
    "sys.exit in callback",
    "rclpy.init(); n = rclpy.create_node('n70'); n.create_timer(0.1, lambda: sys.exit(5)); rclpy.spin(n)",
)
run("sys.exit str", "rclpy.init(); sys.exit('message')")
run(
    "exception in callback",
    "rclpy.init(); n = rclpy.create_node('n70'); n.create_timer(0.1, lambda: 1/0); rclpy.spin(n)",
)
run(
    "raise SystemExit after spin",
    "rclpy.init(); n = rclpy.create_node('n70'); n.create_timer(0.1, rclpy.shutdown); rclpy.spin(n); print('after')",
)
run(
    "print after shutdown",
    "rclpy.init(); n = rclpy.create_node('n70'); n.destroy_node(); rclpy.shutdown(); print('bye'); n.get_logger().info('after shutdown')",
)
run("not initialised", "n = rclpy.create_node('n70')")
run(
    "exit in thread",
    "rclpy.init(); n = rclpy.create_node('n70'); threading.Timer(0.3, rclpy.shutdown).start(); rclpy.spin(n); print('after')",
)
run(
    "main guard",
    "def main(args=None):\n    rclpy.init(args=args)\n    print(__name__, len(sys.argv))\nif __name__ == '__main__':\n    main()",
)
run("atexit", "import atexit; atexit.register(lambda: print('atexit', rclpy.ok())); rclpy.init(); print('x')")
