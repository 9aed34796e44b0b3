"""SECURITY.md and what is installed: what they say is so, as far as it can be tried.

What runs code, and what not, is in tests/settings/test_file.py and tests/studies/test_verify.py;
times and ends in tests/painting/test_time_limit.py and tests/studies/test_endings.py, and the
commands for Dask in tests/studies/test_cluster_security.py.
"""

import re
from pathlib import Path

import pytest

from dqpaint.settings import Settings
from tests.tools.hashes import HASHES, PINS, hashes_text

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "SECURITY.md").read_text("utf-8")


def test_the_page_is_found_and_has_one_place_for_a_contact():
    assert "(SECURITY.md)" in (ROOT / "README.md").read_text("utf-8")
    assert PAGE.count("<!-- place to fill") == 1
    assert "an hour if nothing is said" in PAGE
    assert Settings().timeout == 3600.0


def pinned(path):
    names = re.findall(r"^([\w.-]+==[\w.+!]+)", path.read_text("utf-8"), re.MULTILINE)
    return sorted(re.sub(r"[-_.]+(?=.*==)", "-", name).lower() for name in names)


def test_every_version_that_is_tested_has_a_hash_and_no_address():
    assert pinned(HASHES) == pinned(PINS)
    lines = [line for line in HASHES.read_text("utf-8").splitlines() if not line.startswith("#")]
    assert all(re.fullmatch(r"\S+==\S+ --hash=sha256:[0-9a-f]{64}", line) for line in lines)


def test_a_file_without_a_hash_is_no_line():
    about = {"name": "b", "version": "1"}
    whole = {"metadata": about, "download_info": {"archive_info": {"hashes": {"sha256": "0f"}}}}
    assert hashes_text({"install": [whole]}).endswith("\nb==1 --hash=sha256:0f\n")
    with pytest.raises(ValueError, match="no SHA-256 of b"):
        hashes_text({"install": [{"metadata": about, "download_info": {"archive_info": {}}}]})
