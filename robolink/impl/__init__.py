"""What the public modules of the same names build on, placed where rclpy has it."""
