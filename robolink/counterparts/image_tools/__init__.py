"""Counterparts of image_tools: a camera, or a picture that is drawn, as messages, and their window."""
