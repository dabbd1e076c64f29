# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.statistics_msgs.msg

__all__ = ["MetricsMessage", "StatisticDataPoint", "StatisticDataType"]

class MetricsMessage(robolink.message.Message):
    """Statistics of a measurement from `window_start` to `window_stop`.

    `measurement_source_name` is the node, topic or process that was looked at, `metrics_source` what was measured
    there (``message_age``, ``cpu_percentage``), `unit` the unit of it (``ms``, ``percent``).
    """
    measurement_source_name: builtins.str
    metrics_source: builtins.str
    unit: builtins.str
    window_start: robolink.interfaces.builtin_interfaces.msg.Time
    window_stop: robolink.interfaces.builtin_interfaces.msg.Time
    statistics: collections.abc.MutableSequence[robolink.interfaces.statistics_msgs.msg.StatisticDataPoint]
    def __init__(self, *, measurement_source_name: builtins.str = ..., metrics_source: builtins.str = ..., unit: builtins.str = ..., window_start: robolink.interfaces.builtin_interfaces.msg.Time = ..., window_stop: robolink.interfaces.builtin_interfaces.msg.Time = ..., statistics: collections.abc.Iterable[robolink.interfaces.statistics_msgs.msg.StatisticDataPoint] = ...) -> None: ...
class StatisticDataPoint(robolink.message.Message):
    """One number, and what it is: a code of StatisticDataType. NaN stands for a number that is not known."""
    data_type: builtins.int
    data: builtins.float
    def __init__(self, *, data_type: builtins.int = ..., data: builtins.float = ...) -> None: ...
class StatisticDataType(robolink.message.Message):
    """The codes for what a data point is; only its constants are used."""
    STATISTICS_DATA_TYPE_UNINITIALIZED: typing.ClassVar[builtins.int]
    STATISTICS_DATA_TYPE_AVERAGE: typing.ClassVar[builtins.int]
    STATISTICS_DATA_TYPE_MINIMUM: typing.ClassVar[builtins.int]
    STATISTICS_DATA_TYPE_MAXIMUM: typing.ClassVar[builtins.int]
    STATISTICS_DATA_TYPE_STDDEV: typing.ClassVar[builtins.int]
    STATISTICS_DATA_TYPE_SAMPLE_COUNT: typing.ClassVar[builtins.int]
    def __init__(self) -> None: ...
