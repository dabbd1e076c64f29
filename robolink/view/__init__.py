"""View: a WebSocket server that shows a running system, or a bag, in the browser and to Foxglove's clients."""
