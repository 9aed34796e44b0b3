"""The journal of a study: what was done is read back, damage is told, no other file is touched."""

import hashlib
import json
import math
import os
import random
import re

import pytest

from dqpaint.errors import DqpaintError, OutputError
from dqpaint.studies.runner import journal
from dqpaint.studies.runner.journal import HEAD, NAME, Journal, decode_line, encode_line
from dqpaint.studies.runner.run import Result
from tests.support.folders import files
from tests.support.power_cuts import Recorder, lay_down

FIRST = Result("a" * 64, "done", "", {"x_m": 0.1 + 0.2, "tiny": 1e-300}, wall=0.5)
SECOND = Result("b" * 64, "failed", "warum? ç\n")
THIRD = Result("c" * 64, "done", "", {"x_m": -1.5})


def written(folder, *results):
    with Journal(folder) as one:
        for result in results:
            one.add(result)
    return folder / NAME


def hashed(text):
    """A line whose hash fits, whatever it says."""
    rest = text.encode()[1:]
    return HEAD + hashlib.sha256(rest).hexdigest()[:16].encode() + b'", ' + rest + b"\n"


def test_lines_are_read_back_as_they_were():
    for result in (FIRST, SECOND, THIRD):
        assert decode_line(encode_line(result)) == result
        assert json.loads(encode_line(result))["key"] == result.key  # it is a line of JSON
    with pytest.raises(ValueError, match="not JSON compliant"):
        encode_line(Result("a", "done", figures={"x": math.nan}))


LINES = {
    "none": (b"\n", "not the result"),
    "other": (b'{"precious": 1}\n', "not the result"),
    "deep": (b"[" * 100_000 + b"\n", "not the result"),
    "hash": (encode_line(FIRST).replace(b"1e-300", b"2e-300"), "hash"),
    "key": (encode_line(FIRST).replace(b"aa", b"ab", 1), "hash"),
    "no hash": (HEAD + b"\n", "hash"),
    "status": (hashed('{"key": "a", "status": "weird", "figures": {"x": 1.0}}'), "version"),
    "list": (hashed('{"key": [1], "status": "done", "figures": {"x": 1.0}}'), "version"),
    "null": (hashed('{"key": "a", "status": "done", "figures": null}'), "version"),
    "text": (hashed('{"key": "a", "status": "done", "figures": {"x": "1"}}'), "version"),
    "nested": (hashed('{"key": ' + "[" * 100_000 + "}"), "version"),
    "empty": (hashed('{"key": "a", "status": "done", "figures": {}}'), "no figures"),
    "nan": (hashed('{"key": "a", "status": "done", "figures": {"x": NaN}}'), "not finite"),
    "infinite": (hashed('{"key": "a", "status": "done", "figures": {"x": 1e999}}'), "not finite"),
}


@pytest.mark.parametrize("what", LINES)
def test_a_line_that_is_no_result_is_told_with_its_place(tmp_path, what):
    line, why = LINES[what]
    with pytest.raises(ValueError, match=why):
        decode_line(line)
    path = written(tmp_path, FIRST)
    whole = path.read_bytes() + line + encode_line(SECOND)
    path.write_bytes(whole)
    with pytest.raises(DqpaintError, match=f"{NAME}' line 2 .*{why}"):
        Journal(tmp_path)
    assert path.read_bytes() == whole
    assert files(tmp_path) == [NAME]


@pytest.mark.parametrize("left", [1, 6, len(HEAD), 25, 40, 120, len(encode_line(SECOND)) - 1])
def test_a_line_that_was_cut_off_is_kept_aside_and_no_other(tmp_path, left):
    path = written(tmp_path, FIRST)
    tail = encode_line(SECOND)[:left]
    path.write_bytes(encode_line(FIRST) + tail)
    with Journal(tmp_path) as one:
        assert one.results == {FIRST.key: FIRST}
        assert "runs-cut-1.txt" in one.notes[0]
        one.add(THIRD)
    assert (tmp_path / "runs-cut-1.txt").read_bytes() == tail
    assert path.read_bytes() == encode_line(FIRST) + encode_line(THIRD)


def test_what_a_power_cut_leaves_behind_whole_lines_is_kept_aside(tmp_path):
    path = written(tmp_path, FIRST)
    for number, tail in enumerate([b"\0" * 300, HEAD + b"12" + b"\0" * 40], 1):
        path.write_bytes(encode_line(FIRST) + tail)
        with Journal(tmp_path) as one:
            assert one.results == {FIRST.key: FIRST}
        assert (tmp_path / f"runs-cut-{number}.txt").read_bytes() == tail


FOREIGN = [b'{"precious": 1}', b'{"precious": 1}\n', b"{", b"{\n", b"\0\0", b"colour", b"\n",
           b'{"key": "mine"}', b'{"key": "mine"}\n', b"\xff\xfe", os.urandom(3000)]  # fmt: skip


@pytest.mark.parametrize("data", FOREIGN)
def test_a_file_of_someone_else_is_not_touched(tmp_path, data):
    path = tmp_path / NAME
    path.write_bytes(data)
    with pytest.raises(DqpaintError, match=re.escape(NAME)):
        Journal(tmp_path)
    assert path.read_bytes() == data
    assert files(tmp_path) == [NAME]


def test_a_journal_without_hashes_is_told_from_other_files(tmp_path):
    (tmp_path / NAME).write_text(json.dumps(vars(FIRST)) + "\n" + '{"key": "cut o')
    with pytest.raises(DqpaintError, match="older dqpaint"):
        Journal(tmp_path)


def test_links_pipes_and_folders_are_no_journals(tmp_path):
    thesis = tmp_path / "thesis.txt"
    for number, (make, name) in enumerate({
        lambda path: path.symlink_to(thesis): "a link",
        lambda path: path.symlink_to(tmp_path / "nowhere"): "a link",
        os.mkfifo: "a pipe",
        os.mkdir: "a folder",
        lambda path: path.symlink_to("/dev/zero"): "a link",
    }.items()):  # fmt: skip
        folder = tmp_path / str(number)
        folder.mkdir()
        make(folder / NAME)
        thesis.write_text("words")
        with pytest.raises(DqpaintError, match=f"{NAME}' is {name}"):
            Journal(folder)
        assert thesis.read_text() == "words"
    assert not (tmp_path / "nowhere").exists()


def test_damage_of_any_kind_is_told_or_changes_no_result(tmp_path):
    """A hundred journals damaged at random: bits, bytes, pieces, lines lost, doubled or moved."""
    truth = {one.key: one for one in (FIRST, SECOND, THIRD)}
    whole = b"".join(map(encode_line, truth.values()))
    chance = random.Random(7)
    told = 0
    for i in range(100):
        data = bytearray(whole)
        at = chance.randrange(len(data))
        size = chance.choice([1, 2, 40, 500])
        kind = i % 6
        if kind == 0:
            data[at] ^= 1 << chance.randrange(8)
        elif kind == 1:
            data[at : at + size] = bytes(len(data[at : at + size]))
        elif kind == 2:
            del data[at : at + size]
        elif kind == 3:
            data[at:at] = chance.randbytes(size)
        elif kind == 4:
            del data[at:]
        else:
            lines = whole.splitlines(keepends=True) * 2
            chance.shuffle(lines)
            data = b"".join(lines[: chance.randrange(1, 7)])
        path = tmp_path / str(i) / NAME
        path.parent.mkdir()
        path.write_bytes(data)
        try:
            with Journal(path.parent) as one:
                assert one.results.items() <= truth.items()
        except DqpaintError as problem:
            told += NAME in str(problem)
            assert path.read_bytes() == data
    assert 20 < told < 80  # else the damage is always of one kind


def test_a_power_cut_loses_no_run_that_was_kept(tmp_path, monkeypatch):
    results = [FIRST, SECOND, THIRD]
    (tmp_path / "made").mkdir()
    with Recorder(tmp_path / "made") as recorder, Journal(tmp_path / "made") as one:
        for result in results:
            one.add(result)
            recorder.said(result)
    monkeypatch.setattr(os, "fsync", lambda _handle: None)
    told = count = 0
    for number, (state, said) in enumerate(recorder.cuts()):
        lay_down(tmp_path / str(number), state)
        count += 1
        try:
            with Journal(tmp_path / str(number)) as one:
                found = list(one.results.values())
        except DqpaintError:
            assert not said  # zeros in place of the very first line are no line of ours
            told += 1
        else:
            assert len(found) >= len(said)
            assert found == results[: len(found)]
    assert count > 10
    assert told == 1


def test_a_journal_is_one_study_s_at_a_time(tmp_path):
    with Journal(tmp_path), pytest.raises(DqpaintError, match="another study"):
        Journal(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        Journal(tmp_path / "file")


def test_a_full_disk_leaves_whole_lines(tmp_path, monkeypatch):
    write = os.write

    def half(handle, data):
        if room:
            return write(handle, data[: room.pop()])
        raise OSError(28, "No space left on device")

    path = written(tmp_path, FIRST)
    with Journal(tmp_path) as one:
        room = [20]
        monkeypatch.setattr(journal.os, "write", half)
        with pytest.raises(OutputError, match="No space left"):
            one.add(SECOND)
        assert one.results == {FIRST.key: FIRST}
        assert path.read_bytes() == encode_line(FIRST)
        room = [5, 7, 10_000]  # a write may take a part
        one.add(SECOND)
    assert path.read_bytes() == encode_line(FIRST) + encode_line(SECOND)


def test_what_is_kept_is_known_at_once(tmp_path):
    with Journal(tmp_path) as one:
        for result in (FIRST, SECOND):
            one.add(result)
            assert one.results[result.key] is result
