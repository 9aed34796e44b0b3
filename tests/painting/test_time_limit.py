"""A run's time is over: it ends where it is, in its own code and in a law's."""

import threading
import time

import pytest

import dqpaint
from dqpaint.errors import DqpaintError, TimeLimitError, UsageError
from dqpaint.painting.time_limit import limit_time
from dqpaint.settings import make_settings

SHORT = 0.1
FOR_EVER = 1000.0
LINE = "period 10 ms\nspeed 60 mm/s\nstart at (0, 0) mm\nline to (40, 20) mm\n"


def test_what_sleeps_is_ended_and_what_is_in_time_is_not():
    with pytest.raises(TimeLimitError, match=r"after 0\.1 s; --timeout 0\.4"), limit_time(SHORT):
        time.sleep(FOR_EVER)
    with limit_time(SHORT) as check:
        check()
    time.sleep(2 * SHORT)  # no signal comes afterwards


@pytest.mark.slow
def test_what_catches_everything_meets_it_again():
    with limit_time(SHORT):
        for _ in range(2):
            with pytest.raises(TimeLimitError):
                time.sleep(FOR_EVER)


def test_a_thread_has_the_check_alone():
    said = []

    def work():
        with limit_time(SHORT) as check:
            time.sleep(2 * SHORT)
            try:
                check()
            except TimeLimitError as problem:
                said.append(problem)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert len(said) == 1


def test_a_law_that_sleeps_is_named_and_nothing_is_written(tmp_path, monkeypatch):
    (tmp_path / "law.py").write_text(
        "import time\n\ndef law(seen, k=1.0):\n    time.sleep(1000)\n    return seen.twist_d\n"
    )
    (tmp_path / "line.traj").write_text(LINE)
    with pytest.raises(TimeLimitError, match=r"^law\.py:4: the run has not ended after 0\.5 s"):
        dqpaint.draw(
            tmp_path / "line.traj", controller=tmp_path / "law.py", plant="ideal",
            size=(16, 16), timeout=0.5,
        )  # fmt: skip


@pytest.mark.slow
def test_a_law_that_is_slow_and_deaf_is_ended_between_two_steps(tmp_path):
    (tmp_path / "law.py").write_text(
        "import time\n\ndef law(seen, k=1.0):\n    end = time.monotonic() + 0.02\n"
        "    while time.monotonic() < end:\n        try:\n            time.sleep(0.01)\n"
        "        except Exception:\n            pass\n    return seen.twist_d\n"
    )
    (tmp_path / "line.traj").write_text(LINE)
    with pytest.raises(DqpaintError, match=r"has not ended after 0\.3 s"):
        dqpaint.draw(
            tmp_path / "line.traj", controller=tmp_path / "law.py", plant="ideal",
            size=(16, 16), timeout=0.3,
        )  # fmt: skip


@pytest.mark.parametrize("wrong", [0.0, -1.0, 1.1e7, float("nan"), float("inf")])
def test_times_that_are_none_are_refused(wrong):
    with pytest.raises(UsageError, match="timeout"):
        make_settings(timeout=wrong)


def test_the_longest_time_is_taken():
    assert make_settings(timeout=1e7).timeout == 1e7
