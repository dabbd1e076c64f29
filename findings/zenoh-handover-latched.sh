#!/usr/bin/env bash
# eclipse-zenoh 1.10.2: with ZENOH_RUNTIME='(acc:(handover:rx))', and with the example of Zenoh's own documentation
# (rx and acc handed over to app, which has two workers), a subscriber that asks an advanced publisher for its history, a
# sample of 20 MB by TCP, often waits for 5 s and more, though nobody is slow: instead of 0.05 s it takes 5 or 10 s, or
# the sample does not come within 12 s. In one of six to one of three tries with the first, in half of them or more
# with the second. So long the publisher's process receives nothing. Without the variable no try takes 0.1 s.
#
# The cache answers on the thread that has read the question, and waits for room to send. That thread has polled the
# sockets itself, and wakes no other one, so that nobody hears that a socket has room again (tokio's issue 4730). By
# default another runtime polls them.
#
# Seen with Python 3.11, Linux x86_64, two cores. One would guess that two workers suffice, or more: four stall as well.
set -eu
folder=$(mktemp -d)
trap 'kill -9 $(jobs -p) 2>/dev/null || true; rm -rf "$folder"' EXIT
python3 -m venv "$folder/peer"
"$folder/peer/bin/pip" install -q --disable-pip-version-check eclipse-zenoh==1.10.2
cat > "$folder/publisher.py" <<'PY'
import sys, time
import zenoh
from zenoh import ext

session = zenoh.open(zenoh.Config.from_json5("""{
    mode: "peer", timestamping: {enabled: true}, listen: {endpoints: ["tcp/127.0.0.1:%s"]},
    scouting: {multicast: {enabled: false}}, transport: {shared_memory: {enabled: false}},
}""" % sys.argv[1]))
publisher = ext.declare_advanced_publisher(session, "map", cache=ext.CacheConfig(max_samples=1), publisher_detection=True)
publisher.put(bytes(20_000_000))
print("ready", flush=True)
time.sleep(60)
PY
cat > "$folder/late.py" <<'PY'
import os, socket, subprocess, sys, time
import zenoh
from zenoh import ext

with socket.socket() as free:
    free.bind(("127.0.0.1", 0))
    port = free.getsockname()[1]
with subprocess.Popen([sys.executable, sys.argv[1], str(port)], stdout=subprocess.PIPE) as other:
    other.stdout.readline()
    os.environ.pop("ZENOH_RUNTIME", None)  # the publisher's alone
    session = zenoh.open(zenoh.Config.from_json5("""{
        mode: "peer", timestamping: {enabled: true}, connect: {endpoints: ["tcp/127.0.0.1:%s"]}, listen: {endpoints: []},
        scouting: {multicast: {enabled: false}}, transport: {shared_memory: {enabled: false}},
    }""" % port))
    time.sleep(0.5)
    begin = time.monotonic()
    history = ext.HistoryConfig(detect_late_publishers=True, max_samples=1)
    late = ext.declare_advanced_subscriber(session, "map", zenoh.handlers.FifoChannel(4), history=history)
    while late.try_recv() is None and time.monotonic() - begin < 12:
        time.sleep(0.01)
    print(round(time.monotonic() - begin, 2), flush=True)
    other.kill()
PY
play() {  # play NAME TRIES: until one takes more than 3 s; sets `stalls` to the number of those
    stalls=0
    for ((try = 0; try < $2 && !stalls; try++)); do
        took=$(timeout -s KILL 60 "$folder/peer/bin/python" "$folder/late.py" "$folder/publisher.py")
        echo "$1: the history took $took s"
        if [ "${took%.*}" -ge 3 ]; then stalls=1; fi
    done
}
unset ZENOH_RUNTIME
play default 10
[ "$stalls" -eq 0 ] || { echo "expected no stall by default: zenoh has changed, or this machine is very busy"; exit 1; }
export ZENOH_RUNTIME='(acc:(handover:rx))'
play "acc handed over to rx" 40
[ "$stalls" -gt 0 ] || { echo "expected a stall: zenoh has changed"; exit 1; }
export ZENOH_RUNTIME='(rx:(handover:app),acc:(handover:app),app:(worker_threads:2),tx:(max_blocking_threads:1))'
play "the documented example" 40
[ "$stalls" -gt 0 ] || { echo "expected a stall: zenoh has changed"; exit 1; }
