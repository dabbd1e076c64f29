"""Nav2's nav2_msgs: the actions that make a robot drive somewhere."""
