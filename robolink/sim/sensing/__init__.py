"""What robots sense: who is due when, what there is to be seen, and how each kind of sensor measures it."""
