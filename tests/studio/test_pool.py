"""The workers: the newest request wins, what hangs is ended, and only the folder is read."""

import asyncio

import pytest

from dqpaint.core import find_drawing
from dqpaint.studio.work.messages import (
    Failure,
    Forecast,
    Frame,
    Reading,
    Request,
    Run,
    RunPage,
    Shown,
    Verdict,
)  # fmt: skip
from dqpaint.studio.work.pool import Worker

pytestmark = pytest.mark.slow
STAR = find_drawing("star").read_text()
SHORT = "speed 300 mm/s\nmove to (0, 0, 0) mm\nline to (40, 0, 0) mm\n"
LONGEST = 120.0  # [s] a loaded machine may take


def ask(folder, kind, *requests, until=(), pause=0.0):
    """The answers to requests, one after the other, until one of some kind to the last."""

    async def main():
        answers = [[] for _ in requests]
        done = asyncio.Event()
        worker = Worker(kind, [folder], asyncio.get_running_loop())
        try:
            for i, request in enumerate(requests):
                last = i == len(requests) - 1

                def hear(answer, i=i, last=last):
                    answers[i].append(answer)
                    if last and isinstance(answer, until):
                        done.set()

                worker.submit("page", request, hear)
                await asyncio.sleep(0 if last else pause)
            await asyncio.wait_for(done.wait(), LONGEST)
        finally:
            worker.close()
        return answers

    return asyncio.run(main())


def request(folder, text, choices=None, **more):
    return Request(text, str(folder / "a.traj"), choices or {}, 160, 90, **more)


def test_the_newest_of_many_edits_wins(tmp_path):
    edits = [request(tmp_path, STAR + f"# {i}\n", want="picture") for i in range(30)]
    found = ask(tmp_path, "read", *edits, until=Shown)

    assert sum(isinstance(one, Shown) for several in found[:-1] for one in several) <= 2
    assert [type(one) for one in found[-1]] == [Reading, Shown]


def test_an_error_is_told_with_its_place_and_fix(tmp_path):
    text = "speed 60 mm/s\nlinee to (1, 2) mm\n"
    ((reading,),) = ask(tmp_path, "read", request(tmp_path, text, want="picture"), until=Reading)

    (found, *_) = reading.findings
    assert (found.code, found.line, text[found.start : found.end]) == ("E120", 2, "linee")
    assert found.fix is not None
    assert found.fix[3] == "line"


def test_a_run_has_a_forecast_both_tiers_and_its_frames(tmp_path):
    last = None

    def frames_of(answers):
        return [one for one in answers if isinstance(one, Frame)]

    (found,) = ask(
        tmp_path, "run", request(tmp_path, SHORT, {"controller": "p"}),
        until=(Frame, Failure),
    )  # fmt: skip
    runs = [one for one in found if isinstance(one, Run)]

    assert isinstance(found[0], Forecast)
    assert [one.tier for one in runs] == ["ideal", "physics"]
    last = runs[-1]
    assert last.links.shape[0] == len(last.frame_time)
    assert last.links.shape[2] == 7
    assert {one.title for one in last.curves} >= {"position error", "joint angles"}
    assert last.image[:4] == b"\x89PNG"
    assert frames_of(found)


def test_a_law_that_hangs_is_ended_by_the_next_request(tmp_path):
    law = tmp_path / "hang.py"
    law.write_text("def hang(seen, gains):\n    while True:\n        pass\n")
    found = ask(
        tmp_path, "run", request(tmp_path, SHORT, {"controller": str(law), "plant": "ideal"}),
        request(tmp_path, SHORT, {"controller": "p"}), until=Run, pause=6.0,
    )  # fmt: skip

    assert not any(isinstance(one, Run) for one in found[0])
    assert any(isinstance(one, Run) for one in found[1])


@pytest.mark.parametrize(
    "text",
    ['path "/etc/passwd" height 10 mm', 'svg "{outside}" height 10 mm', 'include "{outside}"',
     'robot "{outside}"\nline to (1, 0, 0) mm'],
)  # fmt: skip
def test_files_outside_are_not_read(tmp_path, text):
    folder = tmp_path / "in"
    folder.mkdir()
    outside = tmp_path / "outside.svg"
    outside.write_text('<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0L9 9"/></svg>')
    asked = request(folder, text.format(outside=outside), want="picture")
    ((reading, *_),) = ask(folder, "read", asked, until=Reading)

    assert reading.fault or any(one.is_error for one in reading.findings)


def test_a_page_and_a_verdict(tmp_path):
    pytest.importorskip("viser")
    first = request(tmp_path, SHORT, {"controller": "p"}, want="page")
    (found,) = ask(tmp_path, "run", first, until=(RunPage, Failure))
    assert b"</html>" in found[-1].html

    both = request(tmp_path, SHORT, {"controller": "p"}, want="verdict",
                   other=(SHORT, {"controller": "hinf"}))  # fmt: skip
    (found,) = ask(tmp_path, "run", both, until=(Verdict, Failure))
    assert "mm" in found[-1].says
    assert "5 pairs" in found[-1].says
