"""Programs of students in processes of their own: limits, a watchdog, and what is wrong with them in words."""
