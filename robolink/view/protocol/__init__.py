"""View protocol: Foxglove's WebSocket messages, and robolink's additions, as pure encoders and decoders.

The page's subprotocol robolink.v1 is Foxglove's JSON and binary operations, and these (numbers are little endian):

- server 0x80: a batch of messages, at most 60 a second: `[u32 length, u32 subscription, u64 time of arrival in ns,
  payload]`, repeated.
- client 0x80, one byte: a batch is done. With two batches unacknowledged the server stores the newest message of
  each publisher of each topic.
- `subscribe`: `rate` in Hz for each subscription, the newest message of each publisher in each period.
- `advertise` of a client: `stopAfter` in seconds, zeros are published when nothing came for so long (1 s without
  it).
- `subscribeStatistics`: once a second `statistics`; of each channel `rate`, `bandwidth`, `age`, `count`,
  `publishers`, `subscriptions`, of the server `clients`, `cpu`, `dropped`. While a client subscribes to them, all
  topics are received; those above 2 MB/s that nobody else looks at only for one of 11 seconds, without `age`
  meanwhile.
- `record`: `command` start or stop, `path`; the server answers with `recording`, once a second.
- `stop`: `held` true presses STOP, false releases it; it needs the token. The server sends `stop` to each page, at
  first and when anything of it has changed: `held`, the nodes that `obeyed` listen, and `unheard`, topics of commands
  with the nodes that move and do not listen.
- `learn`: of `robolink learn view`, `command` show, check, hint or reset with the `name` of an exercise, or
  language with en or pt. All but show need the token. The server sends `learn`, the list with its states, and
  `exercise`, all of one: text, hints shown, and the `report` of its last check with the `track` of the robots.
- `connectionGraphUpdate` also has `nodes`, and the `type` of each topic and service.
- `advertise` and `advertiseServices` also have what is `hidden`.
- `serverInfo` has `robolink`; its `types` are definitions (ros2msg) of what the page publishes.
"""
