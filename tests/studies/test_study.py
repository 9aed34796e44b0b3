"""The declaration of a study, and what is made from it."""

import inspect

import pytest

import dqpaint
from dqpaint.cli.studies import BUILT_IN
from dqpaint.core import Folder
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.studies.declared import STUDIES, Study


def test_the_list_of_commands_says_what_the_studies_say():
    first = {name: inspect.getdoc(kind).partition("\n")[0] for name, kind in STUDIES.items()}
    assert first == BUILT_IN


@pytest.mark.parametrize("name", ["compare", "sweep", "tune", "replay"])
def test_python_takes_the_parameters_and_says_what_they_are(name):
    function = getattr(dqpaint, name)
    parameters = inspect.signature(function).parameters
    for one in STUDIES[name].parameters():
        assert one.keyword in parameters
        assert f"{one.keyword}: " in function.__doc__


@pytest.mark.parametrize(
    ("name", "given", "told"),
    [
        ("sweep", {"vry": "k=1,2"}, "'vary'"),
        ("sweep", {"vary": "k=1,2", "runs": 1.5}, "runs 1.5 "),
        ("sweep", {"vary": "k=1,2", "jobs": 2, "cluster": "there"}, "not both"),
        ("verify", {"plant": "ideal"}, "'plant'"),
        ("replay", {"settings": "a.toml"}, "'settings'"),
    ],
)
def test_what_a_study_does_not_take_is_refused(tmp_path, name, given, told):
    with pytest.raises(UsageError, match=told):
        dqpaint.study(name, "star", folder=tmp_path / "s", **given)
    assert not (tmp_path / "s").exists()


def test_a_name_that_is_no_study_is_told():
    with pytest.raises(UnknownNameError, match="sweep"):
        dqpaint.study("swep", "star")


def test_a_plugin_is_a_study():
    folder = Folder("study", "dqpaint.studies.declared", adapt=STUDIES._adapt)
    with pytest.raises(UsageError, match=r"'it' is not a subclass of dqpaint\..*Study"):
        folder._adapt("it", dict)
    assert folder._adapt("it", STUDIES["sweep"]) is STUDIES["sweep"]
    assert issubclass(STUDIES["sweep"], Study)
