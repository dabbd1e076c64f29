"""Publish `Lifecycle HelloWorld #N` on /lifecycle_chatter each second, while the node is active.

robolink run lifecycle lifecycle_talker
"""

from __future__ import annotations

from typing import Any

from robolink.counterparts.program import spin_program
from robolink.interfaces.std_msgs.msg import String
from robolink.lifecycle import LifecycleNode, LifecyclePublisher, LifecycleState, TransitionCallbackReturn
from robolink.timer import Timer

SUCCESS = TransitionCallbackReturn.SUCCESS


class LifecycleTalker(LifecycleNode):
    """A managed node that publishes a count. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("lc_talker", **options)
        self.count = 0
        self.chatter: LifecyclePublisher[String] | None = None
        self.timer: Timer | None = None

    def on_timer(self) -> None:
        """Publish the next count, which goes nowhere while the node is inactive."""
        self.count += 1
        message = String(data=f"Lifecycle HelloWorld #{self.count}")
        if self.chatter is None:
            return
        if self.chatter.is_activated:
            self.get_logger().info(f"Lifecycle publisher is active. Publishing: [{message.data}]")
            self.chatter.publish(message)
        else:
            self.get_logger().info("Lifecycle publisher is currently inactive. Messages are not published.")

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the publisher and the timer."""
        self.chatter = self.create_lifecycle_publisher(String, "lifecycle_chatter", 10)
        self.timer = self.create_timer(1.0, self.on_timer)
        self.get_logger().info("on_configure() is called.")
        return SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish from now on."""
        self.get_logger().info("on_activate() is called.")
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish no longer."""
        self.get_logger().info("on_deactivate() is called.")
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Destroy the publisher and the timer."""
        self._release()
        self.get_logger().info("on cleanup is called.")
        return SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Destroy the publisher and the timer."""
        self._release()
        self.get_logger().info(f"on shutdown is called from state {state.label}.")
        return SUCCESS

    def _release(self) -> None:
        if self.timer is not None:
            self.destroy_timer(self.timer)
        if self.chatter is not None:
            self.destroy_lifecycle_publisher(self.chatter)
        self.timer = self.chatter = None


def main(args: list[str] | None = None) -> None:
    """Publish while active, until Ctrl-C."""
    spin_program(lambda words: LifecycleTalker(), args)


if __name__ == "__main__":
    main()
