"""Text of a choice -> a registered object and its values; files written whole; versions.

Nothing here depends on robots, light or the language.
"""

from dqpaint.core import bags, tables
from dqpaint.core.atomic_files import (
    NotRegularError, make_folder, open_folder, open_regular, rewrite, write_new,
)
from dqpaint.core.bounds import DEFAULT_MAX_SAMPLES, LARGEST_IMAGE, LARGEST_MAX_SAMPLES
from dqpaint.core.events import log
from dqpaint.core.examples import example_names, examples_folder, find_drawing
from dqpaint.core.file_sets import finish_interrupted, write_together
from dqpaint.core.inputs import picture_size, read_regular, stat_regular
from dqpaint.core.libraries import PINOCCHIO, Library, library_versions
from dqpaint.core.named_values import (
    FILE_PATTERN, Values, choice_name, make_choice, number_or_text, pydantic_reason, read_choice,
)
from dqpaint.core.number_table import NumberTable
from dqpaint.core.records import record, replaced
from dqpaint.core.registry import Folder, Registry, subclass
from dqpaint.core.texts import (
    Sections, latex_equation, read_sections, unicode_equation, unicode_prose,
)
from dqpaint.core.user_files import (
    AnswerError, Guarded, UserCode, file_digest, find_file, find_in_file, short_name, split_spec,
)

__all__ = [
    "DEFAULT_MAX_SAMPLES", "FILE_PATTERN", "LARGEST_IMAGE", "LARGEST_MAX_SAMPLES", "PINOCCHIO",
    "AnswerError", "Folder", "Guarded", "Library", "NotRegularError", "NumberTable", "Registry",
    "Sections", "UserCode", "Values", "bags",
    "choice_name", "example_names", "examples_folder", "file_digest", "find_drawing",
    "find_file", "find_in_file", "finish_interrupted", "latex_equation", "library_versions", "log",
    "make_choice", "make_folder", "number_or_text", "open_folder", "open_regular", "picture_size",
    "pydantic_reason", "read_choice", "read_regular", "read_sections", "record", "replaced",
    "rewrite", "short_name", "split_spec", "stat_regular", "subclass", "tables", "unicode_equation",
    "unicode_prose", "write_new", "write_together",
]
