"""Every reader of files of others takes its seeds or refuses them, and what was changed at random.

`tests/tools/fuzz.py` goes on from here with as many as there is time for.
"""

import random
import re

import pytest

from tests.support.changed_bytes import changed
from tests.support.readers import CORPUS, READERS, Reader, attempt, corpus, finite

EACH = 25
BY_LIBRARIES = [name for name in READERS if "libraries" in name]


def folder_of(name):
    return re.sub(r"\W+", "-", name.lower())


@pytest.mark.parametrize("name", [name for name in READERS if name not in BY_LIBRARIES])
@pytest.mark.filterwarnings("ignore:builtin type:DeprecationWarning")
def test_seeds_are_taken_and_mutants_do_no_harm(tmp_path, name):
    reader, path = READERS[name], tmp_path / f"input{READERS[name].ending}"
    seeds, chance = corpus(name), random.Random(name)
    assert any([attempt(reader, data, path) for data in seeds])
    for _ in range(EACH):
        data = changed(chance.choice(seeds), seeds, reader.words, chance)
        attempt(reader, reader.mended(data), path)


@pytest.mark.slow
@pytest.mark.parametrize("name", BY_LIBRARIES)
def test_what_passes_does_no_harm_to_the_libraries(tmp_path, name):
    reader, path = READERS[name], tmp_path / f"input{READERS[name].ending}"
    assert all([attempt(reader, data, path) for data in reader.seeds()])


def test_a_corpus_belongs_to_a_reader():
    assert {one.name for one in CORPUS.iterdir()} <= {folder_of(name) for name in READERS}


@pytest.mark.parametrize("harm", [lambda *_: 1 / 0, lambda *_: finite([1.0, float("nan")])])
def test_harm_is_seen(tmp_path, harm):
    reader = Reader(harm, READERS["points"].seeds)
    with pytest.raises((ZeroDivisionError, AssertionError)):
        attempt(reader, b"1,2\n", tmp_path / "input.csv")
