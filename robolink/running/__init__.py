"""Execution: entities, their queues, the ready queue, callback threads, and the time that they run by."""
