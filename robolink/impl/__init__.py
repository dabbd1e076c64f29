"""Implementation of logging, and the stand-in for rclpy's C library, placed where rclpy has them."""
