"""Options, a settings file or a run's summary -> checked settings of one painting.

A new setting is a field of a group in `groups`, with its `Option`: command line, Python, settings
files and documents read it from there.
"""

from dqpaint.settings.commands import COMMANDS
from dqpaint.settings.declaration import Option, Setting, settings_of
from dqpaint.settings.file import (
    READABLE, RUN_SCHEMA, Code, SettingsFile, Trusted, beside, check_code, read_given,
)
from dqpaint.settings.groups import DEFAULT_CONTROLLER, SMALLEST
from dqpaint.settings.keywords import check_keywords, keywords
from dqpaint.settings.model import (
    SETTINGS, Settings, check_recorded, make_settings, read_choices,
    validated,
)
from dqpaint.settings.options import (
    DevelopOptions, DrawOptions, PreviewOptions, ReplayOptions, RunOptions,
)
from dqpaint.settings.project import find_project, read_project, with_defaults
from dqpaint.settings.readers import parse_disturbances, parse_gains, read_spread

__all__ = [
    "COMMANDS",
    "DEFAULT_CONTROLLER",
    "READABLE",
    "RUN_SCHEMA",
    "SETTINGS",
    "SMALLEST",
    "Code",
    "DevelopOptions",
    "DrawOptions",
    "Option",
    "PreviewOptions",
    "ReplayOptions",
    "RunOptions",
    "Setting",
    "Settings",
    "SettingsFile",
    "Trusted",
    "beside",
    "check_code",
    "check_keywords",
    "check_recorded",
    "find_project",
    "keywords",
    "make_settings",
    "parse_disturbances",
    "parse_gains",
    "read_choices",
    "read_given",
    "read_project",
    "read_spread",
    "settings_of",
    "validated",
    "with_defaults",
]
