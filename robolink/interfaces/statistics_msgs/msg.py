"""The messages of statistics_msgs: what was measured of topics and processes over a span of time."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.message import Message, Sequence, float64, string, uint8


class StatisticDataType(Message):
    """The codes for what a data point is; only its constants are used."""

    STATISTICS_DATA_TYPE_UNINITIALIZED: ClassVar[uint8] = 0
    STATISTICS_DATA_TYPE_AVERAGE: ClassVar[uint8] = 1
    STATISTICS_DATA_TYPE_MINIMUM: ClassVar[uint8] = 2
    STATISTICS_DATA_TYPE_MAXIMUM: ClassVar[uint8] = 3
    STATISTICS_DATA_TYPE_STDDEV: ClassVar[uint8] = 4
    STATISTICS_DATA_TYPE_SAMPLE_COUNT: ClassVar[uint8] = 5


class StatisticDataPoint(Message):
    """One number, and what it is: a code of StatisticDataType. NaN stands for a number that is not known."""

    data_type: uint8
    data: float64


class MetricsMessage(Message):
    """Statistics of a measurement from `window_start` to `window_stop`.

    `measurement_source_name` is the node, topic or process that was looked at, `metrics_source` what was measured
    there (``message_age``, ``cpu_percentage``), `unit` the unit of it (``ms``, ``percent``).
    """

    measurement_source_name: string
    metrics_source: string
    unit: string
    window_start: Time
    window_stop: Time
    statistics: Sequence[StatisticDataPoint]
