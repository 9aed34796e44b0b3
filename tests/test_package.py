"""The page and the metadata of the package, as hatch_build.py makes them."""

import importlib.util
import re
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import pytest
import yaml

from dqpaint import __version__

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text("utf-8")


@pytest.fixture
def hook(monkeypatch):
    """The module, whose base class comes with the build tool."""
    interface = ModuleType("hatchling.metadata.plugin.interface")
    interface.MetadataHookInterface = object
    for name in ("hatchling", "hatchling.metadata", "hatchling.metadata.plugin"):
        monkeypatch.setitem(sys.modules, name, ModuleType(name))
    monkeypatch.setitem(sys.modules, interface.__name__, interface)
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def links(text):
    return re.findall(r"\]\(([^)\s]+)\)", text)


def test_without_an_address_the_page_has_no_broken_link(hook):
    page = hook.page(README, "")
    assert "![" not in page
    assert all(link.startswith(("https:", "http:")) for link in links(page))
    assert hook.urls("") == {}


def test_with_an_address_all_links_are_absolute(hook):
    source = "https://example.org/dqpaint"
    page = hook.page(README, source)
    assert all(link.startswith(("https:", "http:", "#")) for link in links(page))
    assert f"]({source}/raw/main/gallery/star-hinf.png)]({source}/blob/main/gallery/" in page
    assert page.count("![") == README.count("![")
    assert all(url.startswith(source) for url in hook.urls(source).values())


def test_what_a_package_says_of_itself():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    metadata = project["project"]
    for name in metadata["license-files"]:
        assert (ROOT / name).is_file(), name
    assert any("Hershey" in (ROOT / n).read_text("utf-8") for n in metadata["license-files"])
    for name in project["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]:
        assert (ROOT / name).exists(), name
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert cited["version"] == __version__
    assert [one["name"] for one in cited["authors"]] == ["The dqpaint developers"]
    assert [one["name"] for one in metadata["authors"]] == ["The dqpaint developers"]
    assert cited["license"] == metadata["license"]


def test_reports_of_faults_ask_for_the_doctor():
    for path in (ROOT / ".github/ISSUE_TEMPLATE").glob("*.yml"):
        form = yaml.safe_load(path.read_text("utf-8"))
        assert "http" not in path.read_text("utf-8")
        if path.stem != "config":
            fields = {one["id"]: one for one in form["body"]}
            assert "dqpaint doctor" in fields["doctor"]["attributes"]["label"]
            assert path.stem != "fault" or fields["doctor"]["validations"]["required"]
    assert (ROOT / "CODE_OF_CONDUCT.md").read_text("utf-8").count("CONTACT") == 1
