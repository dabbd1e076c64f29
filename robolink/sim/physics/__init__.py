"""What knows pymunk: bodies out of descriptions, what they run into, and where there is room for them."""
