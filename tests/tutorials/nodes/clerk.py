"""Types of one's own: a clerk who has parcels stacked, and notes what the warehouse tells of it."""

import rclpy
from parcel_interfaces.msg import Load, Shelf
from parcel_interfaces.srv import Stack
from rclpy.node import Node


class Clerk(Node):
    def __init__(self):
        super().__init__('clerk')
        self.notes = []
        self.create_subscription(Load, 'loads', lambda load: self.note(f'{load.parcels} parcels came'), 10)
        self.create_subscription(Shelf, 'shelves', self.measure, 10)
        self.warehouse = self.create_client(Stack, 'stack')

    def measure(self, shelf):
        self.note(f'the shelf at y={shelf.corner.y} is {shelf.width} m wide')

    def note(self, text):
        self.notes.append(text)
        self.get_logger().info(text)


with rclpy.init():
    clerk = Clerk()
    clerk.warehouse.wait_for_service()
    stacked = clerk.warehouse.call_async(Stack.Request(small=1, medium=2, large=3))
    rclpy.spin_until_future_complete(clerk, stacked)
    clerk.note(f'stacked {stacked.result().total}')
    while rclpy.ok() and len(clerk.notes) < 3:
        rclpy.spin_once(clerk)
