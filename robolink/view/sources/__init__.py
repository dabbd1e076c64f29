"""Sources of what the view shows: a running system, or a bag."""
