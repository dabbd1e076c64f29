"""View protocol: Foxglove's WebSocket messages, and robolink's additions, as pure encoders and decoders."""
