"""BibTeX of a run and of a law: what it names is what was used, and nothing is invented."""

import json
import re
from pathlib import Path

import pytest
import yaml

import dqpaint
from dqpaint.controllers import CONTROLLERS
from dqpaint.errors import DqpaintError
from dqpaint.outputs import citation, summary
from tests.support.commands import LINE

ROOT = Path(__file__).parents[2]
ENTRY = re.compile(r"@(\w+)\{([^,\n]+),\n((?:  \w+ = \{.*\},\n)+)\}")


def entries(text):
    """The entries of a BibTeX text by key; all but comments belongs to one, braces balance."""
    rest = ENTRY.sub("", text)
    assert [line for line in rest.splitlines() if line and not line.startswith("% ")] == []
    assert "@" not in rest
    assert text.count("{") == text.count("}")
    found = {
        key: dict(re.findall(r"  (\w+) = \{(.*)\},", fields))
        for _, key, fields in ENTRY.findall(text)
    }
    assert len(found) == len(ENTRY.findall(text))
    return found


@pytest.fixture(scope="module")
def run():
    painting = dqpaint.draw(text=LINE, size=(64, 36), engine="mujoco", controller="hybrid")
    return summary.summarise(painting)


def written(tmp_path, found):
    path = tmp_path / "run.json"
    path.write_text(found if isinstance(found, str) else json.dumps(found))
    return str(path)


def test_a_run_cites_what_it_used(run, tmp_path):
    run = {**run, "versions": {**run["versions"], "mujoco": "9.8.7", "dqpaint": "0.0.9"}}
    found = entries(citation.of_run(written(tmp_path, run)))
    assert set(found) == {
        "dqpaint", "kussaba-2017", "mayhew-2011", "arm-iiwa", "mujoco", "pin",
    }  # fmt: skip
    assert found["mujoco"]["version"] == "9.8.7"  # as recorded, not as installed
    assert found["dqpaint"]["version"] == "0.0.9"
    assert found["pin"]["version"] == run["versions"]["pin"]
    run = {**run, "engine": None, "settings": {**run["settings"], "kinematics": "screws"}}
    assert not {"mujoco", "pin"} & set(entries(citation.of_run(written(tmp_path, run))))


def test_dqpaint_is_cited_as_its_own_file_says():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    own = entries(citation.of_law("pi"))["dqpaint"]
    assert own["author"] == "{%s}" % cited["authors"][0]["name"]  # noqa: UP031  braces
    assert (own["title"], own["version"]) == (cited["title"], str(cited["version"]))
    assert own["note"] == cited["license"]


@pytest.mark.parametrize("name", list(CONTROLLERS))
def test_every_law_has_the_papers_of_its_source(name):
    text, source = citation.of_law(name), CONTROLLERS[name].source
    found = entries(text)
    years = {about["year"] for about in found.values() if "year" in about}
    assert years == set(re.findall(r"\b(?:19|20)\d\d\b", source))
    named = len(found) > 1
    assert named == any(word[0].isupper() for word in source.split()), source
    for about in list(found.values())[1:]:
        assert "title" in about or "looked up" in about["note"]
        assert not {"doi", "url"} & set(about)


def test_a_law_of_ones_own_is_cited_by_its_hash(run, tmp_path):
    law = {**run["law"], "source": "my_law{.py", "sha256": "ab" * 32}
    about = entries(citation.of_run(written(tmp_path, {**run, "law": law})))["law-hybrid"]
    assert about["title"] == r"my\_law(.py"
    assert "ab" * 32 in about["note"]
    law = {**law, "source": "a\n@misc (b, 50 % of it", "sha256": None}
    assert "dqpaint" in entries(citation.of_run(written(tmp_path, {**run, "law": law})))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "JSON"),
        ("[" * 100_000, "nested"),
        ("[]", "summary"),
        ('{"schema": "dqpaint-run-2"}', "law and versions"),
        ('{"schema": "dqpaint-run-2", "law": {}, "versions": {}}', "robot"),
        ('{"schema": ["dqpaint-run-2"]}', "summary"),
    ],
)
def test_what_is_no_summary_is_one_sentence(text, said, tmp_path):
    with pytest.raises(DqpaintError) as fault:
        citation.of_run(written(tmp_path, text))
    assert said in str(fault.value)
    assert "\n" not in str(fault.value)


def test_a_missing_file_or_law_is_named(tmp_path):
    with pytest.raises(DqpaintError, match=r"none\.json"):
        citation.of_run(str(tmp_path / "none.json"))
    with pytest.raises(DqpaintError, match="hinf"):
        citation.of_law("hinff")
