"""diagnostic_updater: tasks that tell the state of a robot's parts, which an updater publishes on /diagnostics."""

from robolink.companions.diagnostic_updater.status import DiagnosticStatusWrapper
from robolink.companions.diagnostic_updater.tasks import (
    CompositeDiagnosticTask,
    DiagnosticTask,
    FunctionDiagnosticTask,
    Heartbeat,
)
from robolink.companions.diagnostic_updater.topics import DiagnosedPublisher, HeaderlessTopicDiagnostic, TopicDiagnostic
from robolink.companions.diagnostic_updater.updater import DiagnosticTaskVector, Updater
from robolink.companions.diagnostic_updater.watching import (
    FrequencyStatus,
    FrequencyStatusParam,
    TimeStampStatus,
    TimeStampStatusParam,
)

__all__ = [
    "CompositeDiagnosticTask",
    "DiagnosedPublisher",
    "DiagnosticStatusWrapper",
    "DiagnosticTask",
    "DiagnosticTaskVector",
    "FrequencyStatus",
    "FrequencyStatusParam",
    "FunctionDiagnosticTask",
    "HeaderlessTopicDiagnostic",
    "Heartbeat",
    "TimeStampStatus",
    "TimeStampStatusParam",
    "TopicDiagnostic",
    "Updater",
]
