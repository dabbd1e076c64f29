"""Types of one's own: a warehouse that stacks parcels and tells of it."""

import rclpy
from geometry_msgs.msg import Point
from parcel_interfaces.msg import Load, Shelf
from parcel_interfaces.srv import Stack
from rclpy.executors import ExternalShutdownException


def main():
    try:
        with rclpy.init():
            warehouse = rclpy.create_node('warehouse')
            loads = warehouse.create_publisher(Load, 'loads', 10)
            shelves = warehouse.create_publisher(Shelf, 'shelves', 10)

            def stack(parcels, done):
                done.total = parcels.small + parcels.medium + parcels.large
                loads.publish(Load(parcels=done.total))
                shelves.publish(Shelf(corner=Point(x=1.0, y=2.0), width=done.total / 2))
                return done

            warehouse.create_service(Stack, 'stack', stack)
            rclpy.spin(warehouse)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
