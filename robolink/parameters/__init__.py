"""Rules for parameters: ranges, callbacks that judge a change, and descriptors."""
