#!/usr/bin/env bash
# evo 1.38.1 (evaluation of odometry and SLAM): when trajectories are associated by their times, one pose may stand for
# two. For each time of the shorter trajectory the nearest time of the longer one is taken if it is near enough, and what
# was taken already is taken again: three poses of a ground truth make four pairs, two of them with the same pose, and
# that moment counts twice in the error. It comes about where the stamps of the shorter one jitter or arrive in bursts
# while the other has a gap. Nothing is said, and the number of pairs looks right.
#
# Seen with Python 3.11, Linux x86_64. One would guess that a pose is in one pair at most, as in the script associate.py
# of TUM's RGB-D benchmark.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check evo==1.38.1
cat > "$folder/associated.py" <<'PY'
import numpy as np
from evo.core import metrics, sync
from evo.core.trajectory import PoseTrajectory3D


def trajectory(times, x):
    zeros = np.zeros(len(times))
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
    return PoseTrajectory3D(np.column_stack((x, zeros, zeros)), turns, np.array(times))


truth = trajectory([0.0, 1.004, 2.0, 5.0, 6.0], [0.0, 1.0, 2.0, 5.0, 6.0])
estimate = trajectory([0.0, 1.0, 1.008, 2.0], [0.0, 2.0, 2.0, 2.0])  # 1 m off at one place, of four
pairs = sync.associate_trajectories(truth, estimate)
print(*pairs[0].timestamps, end=", ")
error = metrics.APE(metrics.PoseRelation.translation_part)
error.process_data(pairs)
print(f"rmse {error.get_statistic(metrics.StatisticsType.rmse):.3f}")
PY
seen=$("$folder/venv/bin/python" "$folder/associated.py")
echo "$seen"
[ "$seen" = "0.0 1.004 1.004 2.0, rmse 0.707" ] || { echo "a pose is in one pair only now, or the pairs differ: it has changed"; exit 1; }
