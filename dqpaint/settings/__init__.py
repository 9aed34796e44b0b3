"""Options, a settings file or a run's summary -> checked settings of one painting.

A new option is a field of `model.Settings`.
"""

from dqpaint.settings.file import SettingsFile, beside, read_given
from dqpaint.settings.model import (
    DEFAULT_CONTROLLER,
    SMALLEST,
    Settings,
    check_recorded,
    make_settings,
    parse_disturbances,
    parse_gains,
    parse_size,
)

__all__ = [
    "DEFAULT_CONTROLLER",
    "SMALLEST",
    "Settings",
    "SettingsFile",
    "beside",
    "check_recorded",
    "make_settings",
    "parse_disturbances",
    "parse_gains",
    "parse_size",
    "read_given",
]
