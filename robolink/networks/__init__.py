"""Networks by name: which others a session may meet, and Zenoh's settings for that."""
