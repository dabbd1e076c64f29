#!/usr/bin/env python3
from more_interfaces.msg import AddressBook
import rclpy
from rclpy.node import Node


class AddressBookPublisher(Node):

    def __init__(self):
        super().__init__('address_book_publisher')
        self.publisher = self.create_publisher(AddressBook, 'address_book', 10)
        self.timer = self.create_timer(1.0, self.publish_msg)

    def publish_msg(self):
        msg = AddressBook()
        msg.first_name = 'John'
        msg.last_name = 'Doe'
        msg.phone_number = '1234567890'
        msg.phone_type = msg.PHONE_TYPE_MOBILE
        print(f'Publishing Contact\nFirst:{msg.first_name}  Last:{msg.last_name}')
        self.publisher.publish(msg)


def main():
    rclpy.init()
    rclpy.spin(AddressBookPublisher())


if __name__ == '__main__':
    main()
