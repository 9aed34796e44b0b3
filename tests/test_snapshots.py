"""What messages and commands say is what the snapshots keep."""

from difflib import unified_diff

import pytest

from tests.tools.snapshots import COMMAND, FOLDER, SNAPSHOTS


@pytest.mark.parametrize("name", [
    "messages.txt", pytest.param("commands.txt", marks=pytest.mark.slow),
])  # fmt: skip
def test_the_wording_is_the_one_that_is_kept(name):
    kept = (FOLDER / name).read_text("utf-8").splitlines()
    said = SNAPSHOTS[name]().splitlines()
    differences = list(unified_diff(kept, said, "kept", "said now", lineterm="", n=2))
    if differences:
        pytest.fail("\n".join([*differences, f"if this is meant: {COMMAND}"]), pytrace=False)


def test_each_snapshot_is_compared():
    assert {path.name for path in FOLDER.iterdir()} == set(SNAPSHOTS)
