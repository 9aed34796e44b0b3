"""Records: as data classes, and copied as `dataclasses.replace` copies them."""

from dataclasses import replace

import pytest

from dqpaint.core.records import replaced
from dqpaint.diagnostics.diagnostic import Span
from dqpaint.language.pen.stroke_state import StrokeState
from dqpaint.program.program import Profile

STATE = StrokeState(speed=0.3, profile=Profile("cubic", (0.1, 0.2)), blend=0.01)


def test_alike_records_are_equal_and_have_one_hash() -> None:
    assert Span(3, 7) == Span(3, 7) != Span(3, 8)
    assert len({Span(3, 7), Span(3, 7), Profile("cubic"), Profile("cubic")}) == 2
    assert Profile("cubic") != Span(3, 7)


def test_a_copy_is_another_record_with_the_changes_alone() -> None:
    copy = replaced(STATE, speed=0.5, blend=0.0)
    assert copy == replace(STATE, speed=0.5, blend=0.0)
    assert (STATE.speed, STATE.blend) == (0.3, 0.01)
    assert copy.profile is STATE.profile


def test_a_record_has_no_other_values() -> None:
    with pytest.raises(AttributeError):
        replaced(STATE, sped=0.5)
    with pytest.raises(AttributeError):
        STATE.sped = 0.5  # type: ignore[attr-defined]
