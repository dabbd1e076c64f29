"""Managed (lifecycle) nodes: they are configured, activated, deactivated and cleaned up on request.

class Camera(LifecycleNode):
    def on_configure(self, state):
        self.images = self.create_lifecycle_publisher(Image, "image", 10)
        return TransitionCallbackReturn.SUCCESS
"""

from robolink.lifecycle.managed_entity import ManagedEntity, SimpleManagedEntity, TransitionCallbackReturn
from robolink.lifecycle.node import LifecycleNode, LifecycleNodeMixin, LifecycleState
from robolink.lifecycle.publisher import LifecyclePublisher

Node = LifecycleNode
NodeMixin = LifecycleNodeMixin
State = LifecycleState
Publisher = LifecyclePublisher

# Node and Publisher are not listed: a star import must not hide the plain ones.
__all__ = [
    "LifecycleNode",
    "LifecycleNodeMixin",
    "LifecyclePublisher",
    "LifecycleState",
    "ManagedEntity",
    "SimpleManagedEntity",
    "TransitionCallbackReturn",
]
