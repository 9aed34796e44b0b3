"""Every reader of files of others takes its seeds or refuses them, and what was changed at random.

`tests/tools/fuzz.py` goes on from here with as many as there is time for.
"""

import io
import random
import re
import zipfile

import pytest

from dqpaint.brushes import images
from dqpaint.core import number_table
from dqpaint.core.inputs import xml_tree
from dqpaint.language.imports.svg import guard
from dqpaint.language.syntax import source
from dqpaint.painting import film_file
from dqpaint.robots.loading import load_file
from dqpaint.robots.urdf import meshes, tree
from dqpaint.settings import file
from tests.support.changed_bytes import changed
from tests.support.readers import CORPUS, READERS, Reader, attempt, corpus, finite

EACH = 25
EDGES = [  # a reader, where its limit stands, and how much of it a seed has
    ("image", images, "LARGEST_IMAGE", len), ("image", images, "MOST_PIXELS", lambda _: 7 * 9),
    ("film", film_file, "LARGEST_FILE", len),
    ("film", film_file, "LARGEST_UNPACKED",
     lambda data: sum(one.file_size for one in zipfile.ZipFile(io.BytesIO(data)).infolist())),
    ("URDF", tree, "LARGEST_FILE", len),
    ("URDF", tree, "MOST_LINKS", lambda data: data.count(b"<link name=")),
    ("URDF", tree, "MOST_JOINTS", lambda data: data.count(b'type="revolute"')),
    ("URDF", xml_tree, "MOST_ELEMENTS", lambda data: len(re.findall(rb"<\w", data))),
    ("URDF", xml_tree, "DEEPEST", lambda _: 4), ("robot card", load_file, "LARGEST_CARD", len),
    ("settings, TOML", file, "LARGEST", len), ("settings, JSON", file, "LARGEST", len),
    ("recorded run", number_table, "LARGEST_FILE", len), ("drawing", source, "MOST_BYTES", len),
    ("mesh, OBJ", meshes, "LARGEST_FILE", len), ("mesh, STL", meshes, "LARGEST_FILE", len),
    ("svg", guard, "MOST_ELEMENTS", lambda data: len(re.findall(rb"<\w", data))),
]  # fmt: skip
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


@pytest.mark.parametrize(("name", "where", "limit", "has"), EDGES)
def test_what_is_at_a_limit_is_taken_and_beyond_it_refused(
    tmp_path, monkeypatch, name, where, limit, has
):
    reader, path = READERS[name], tmp_path / f"input{READERS[name].ending}"
    data = next(data for data in reader.seeds() if attempt(reader, data, path))
    for less in (0, 1):
        monkeypatch.setattr(where, limit, has(data) - less)
        assert attempt(reader, data, path) == (not less)


def test_a_corpus_belongs_to_a_reader():
    assert {one.name for one in CORPUS.iterdir()} <= {folder_of(name) for name in READERS}


@pytest.mark.parametrize("harm", [lambda *_: 1 / 0, lambda *_: finite([1.0, float("nan")])])
def test_harm_is_seen(tmp_path, harm):
    reader = Reader(harm, READERS["points"].seeds)
    with pytest.raises((ZeroDivisionError, AssertionError)):
        attempt(reader, b"1,2\n", tmp_path / "input.csv")
