"""Letters and drawings from elsewhere, through the command line: messages, and soon."""

from pathlib import Path

import pytest

from tests.support.svg import OPEN, nested_uses
from tests.support.work import checked

CASES = {
    'text "3 €" height 9 mm': ("E261", "1:9", '= help: use "3 EUR"'),
    'move to (0, 0)\ntext "A" font "script" height 9 mm': ("E260", "2:15", 'mean "scripts"?'),
    'path "rows.csv" unit mm': ("E295", "1:6", "line 2: this row has 'b' where a number"),
    'path "long.csv" unit mm': ("E294", "1:6", "more than 500,000 rows"),
    'svg "uses.svg"': ("E298", "1:5", "with every 'use' it has about 10^"),
    'svg "large.svg"': ("E298", "1:5", "its paths have 2,400,000 numbers"),
    'svg "huge.svg"': ("E294", "1:5", "larger than 10 MB"),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Files of every kind that is refused."""
    made = tmp_path_factory.mktemp("elsewhere")
    (made / "rows.csv").write_text("1,2\na,b\n".replace("a", "3"))
    with (made / "long.csv").open("w") as file:
        for _ in range(10):
            file.write("1.5,2.5\n2.5,3.5\n" * 500_000)
    (made / "uses.svg").write_text(nested_uses(40))
    (made / "large.svg").write_text(f'{OPEN}<path d="M{"1 1 " * 1_200_000}"/></svg>')
    (made / "huge.svg").write_bytes(b" " * 10_000_001)
    return made


@pytest.mark.slow
@pytest.mark.parametrize("text", CASES)
def test_refused_at_once(folder: Path, text: str) -> None:
    code, place, words = CASES[text]
    file = folder / "a.traj"
    file.write_text(text + "\n", "utf-8")
    answer = checked(file)
    assert answer.calls < 4_000_000
    assert answer.code == 1
    assert answer.said.startswith(f"error[{code}]: ")
    assert f"a.traj:{place}\n" in answer.said
    assert words in answer.said
