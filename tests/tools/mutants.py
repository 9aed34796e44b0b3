"""Small faults planted one at a time -> how many the tests of their own room find.

`python -m tests.tools.mutants FILE [COUNT SEED]` plants COUNT faults (500 if not said), drawn by
SEED from the algebra, motion, laws, film, journal and statistics, each subject by its size. A line
of JSON a fault goes to FILE; called again it goes on from there. `python -m tests.tools.mutants
FILE again` tries those again that survived, after tests were added.

A copy of the repository is worked in. A process that has the libraries but nothing of dqpaint is
forked for each fault; it runs those everyday tests of the room that call the function with the
fault, the quick ones first, until one fails; if none does, all everyday tests of the room, and then
those of other rooms that call the function (`elsewhere`).
"""

import ast
import contextlib
import copy
import importlib
import json
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
SUBJECTS = {
    "algebra": (["dqpaint/dq.py"], ["tests/test_dq.py"]),
    "motion": (["dqpaint/motion"], ["tests/motion"]),
    "laws": (["dqpaint/controllers"], ["tests/controllers"]),
    "film": (["dqpaint/light"], ["tests/light"]),
    "journal": (
        ["dqpaint/studies/runner/journal.py", "dqpaint/core/records.py",
         "dqpaint/core/file_sets.py", "dqpaint/core/atomic_files.py"],
        ["tests/studies/test_journal.py", "tests/core"],
    ),
    "statistics": (
        ["dqpaint/studies/experiment/statistics.py", "dqpaint/studies/experiment/comparisons.py",
         "dqpaint/studies/replay/claims.py", "dqpaint/metrics/judgement.py",
         "dqpaint/metrics/oscillation.py"],
        ["tests/studies/test_statistics.py", "tests/studies/test_comparisons.py",
         "tests/studies/test_claims.py", "tests/metrics"],
    ),
}  # fmt: skip
LIBRARIES = (
    "numpy", "scipy.optimize", "scipy.stats", "scipy.interpolate", "scipy.signal", "scipy.linalg",
    "scipy.integrate", "cv2", "pydantic", "pinocchio", "coal", "pybullet", "typer",
    "rich", "jinja2", "dqrobotics",
)  # fmt: skip
WHOLE = "the rest"  # the tests of all rooms
LONGEST = 120.0  # [s] for a fault, in which the tests of any room are done several times
LONGEST_LOOK = 1800.0  # [s] to see once what each test calls
LARGEST = 8_000_000_000  # bytes of address space; some faults never stop taking more
COMPARED: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
COMPUTED: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult,
    ast.FloorDiv: ast.Div, ast.Mod: ast.FloorDiv, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip
RENAMED = {
    "min": "max", "max": "min", "minimum": "maximum", "maximum": "minimum", "sin": "cos",
    "cos": "sin", "any": "all", "all": "any", "floor": "ceil", "ceil": "floor", "sqrt": "abs",
    "argmin": "argmax", "argmax": "argmin", "first": "last", "left": "right",
}  # fmt: skip
LEFT_ALONE = (ast.Raise, ast.Assert, ast.JoinedStr, ast.Import, ast.ImportFrom)


class Mutant(NamedTuple):
    """A fault: `old` of a file from `start` to `end` becomes `new`."""

    subject: str
    file: str
    line: int
    function: str
    start: int
    end: int
    old: str
    new: str

    def planted(self, text: str) -> str:
        """The text with the fault."""
        return text[: self.start] + self.new + text[self.end :]


class Planter:
    """All faults that can be planted in a file.

    Args:
        subject: that the file is of.
        file: its path below the repository.
    """

    def __init__(self, subject: str, file: str) -> None:
        self.subject, self.file = subject, file
        self.text = (ROOT / file).read_text("utf-8")
        self._bytes = [line.encode() for line in self.text.splitlines(keepends=True)]
        self._starts = [0]
        for line in self.text.splitlines(keepends=True):
            self._starts.append(self._starts[-1] + len(line))
        self.found: list[Mutant] = []
        self._visit(ast.parse(self.text), "")

    def _at(self, line: int, column: int) -> int:
        return self._starts[line - 1] + len(self._bytes[line - 1][:column].decode())

    def _add(self, node: ast.AST, new: str, function: str) -> None:
        start = self._at(node.lineno, node.col_offset)  # type: ignore[attr-defined]
        end = self._at(node.end_lineno, node.end_col_offset)  # type: ignore[attr-defined]
        old = self.text[start:end]
        self.found.append(
            Mutant(self.subject, self.file, node.lineno, function, start, end, old, new)
        )  # type: ignore[attr-defined]

    def _visit(self, node: ast.AST, function: str) -> None:
        if isinstance(node, LEFT_ALONE) or _types_only(node):
            return
        inside = function
        if isinstance(node, ast.FunctionDef):
            lines = [node.lineno, *(one.lineno for one in node.decorator_list)]
            inside = f"{node.name}:{min(lines)}"
        for new in _changed(node):
            text = new if isinstance(new, str) else f"({ast.unparse(new)})"
            self._add(node, text, function)
        for name, value in ast.iter_fields(node):
            if name in ("annotation", "returns", "decorator_list"):
                continue
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    self._visit(child, inside)


def _types_only(node: ast.AST) -> bool:
    """Whether a statement is a docstring, a type, a list of names, or for a type checker."""
    if isinstance(node, ast.Expr):
        return isinstance(node.value, ast.Constant)
    if isinstance(node, ast.If):
        return isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
    if isinstance(node, ast.Assign):
        text = ast.unparse(node.value)
        return "Literal[" in text or "Annotated[" in text or "Callable[" in text or (
            isinstance(node.targets[0], ast.Name) and node.targets[0].id == "__all__"
        )  # fmt: skip
    return isinstance(node, ast.keyword) and node.arg in ("strict", "stacklevel", "slots", "frozen")


def _changed(node: ast.AST) -> Iterator[ast.AST | str]:
    """What could stand for a node."""
    new: Any = copy.deepcopy(node)
    if isinstance(node, ast.Compare) and type(node.ops[0]) in COMPARED:
        new.ops[0] = COMPARED[type(node.ops[0])]()
        yield new
    elif isinstance(node, ast.BinOp) and type(node.op) in COMPUTED:
        new.op = COMPUTED[type(node.op)]()
        yield new
    elif isinstance(node, ast.BoolOp):
        new.op = ast.Or() if isinstance(node.op, ast.And) else ast.And()
        yield new
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield new.operand
    elif isinstance(node, ast.Constant) and type(node.value) in (int, float):
        new.value = node.value + 1 if isinstance(node.value, int) else 2 * node.value + 0.125
        yield new
    elif isinstance(node, ast.Constant) and isinstance(node.value, bool):
        new.value = not node.value
        yield new
    elif isinstance(node, ast.IfExp):
        new.body, new.orelse = new.orelse, new.body
        yield new
    elif isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Load):
        field = "id" if isinstance(node, ast.Name) else "attr"
        if getattr(node, field) in RENAMED:
            setattr(new, field, RENAMED[getattr(node, field)])
            yield ast.unparse(new)
    elif isinstance(node, ast.Slice):
        for part in ("lower", "upper"):
            if getattr(node, part) is not None:
                less = copy.deepcopy(node)
                setattr(less, part, None)
                yield ast.unparse(less)
    elif _is_left_out(node):
        yield "pass"
    elif isinstance(node, ast.Return) and not (
        node.value is None or (isinstance(node.value, ast.Constant) and not node.value.value)
    ):
        yield "return None"


def _is_left_out(node: ast.AST) -> bool:
    """Whether a statement is one that is tried without."""
    if isinstance(node, ast.Assign):
        return isinstance(node.targets[0], ast.Subscript)
    call = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
    return call or isinstance(node, ast.AugAssign | ast.Break | ast.Continue)


def mutants(count: int, seed: int) -> list[Mutant]:
    """A sample of all faults, the same for the same seed; each subject by its share."""
    chance = random.Random(seed)
    found: dict[str, list[Mutant]] = {}
    for subject, (places, _) in SUBJECTS.items():
        files = [
            file.relative_to(ROOT).as_posix()
            for place in map(ROOT.joinpath, places)
            for file in ([place] if place.is_file() else sorted(place.rglob("*.py")))
        ]
        found[subject] = [one for file in files for one in Planter(subject, file).found]
    total = sum(map(len, found.values()))
    taken = []
    for subject, all_of_it in found.items():
        share = max(round(count * len(all_of_it) / total), min(40, count // len(found)))
        chance.shuffle(all_of_it)
        taken += list(islice(filter(is_program, all_of_it), share))
        print(f"{subject}: {len(all_of_it)} possible, {share} planted", file=sys.stderr)
    chance.shuffle(taken)
    return taken[:count]


def is_program(mutant: Mutant) -> bool:
    """Whether Python takes it."""
    try:
        ast.parse(mutant.planted((ROOT / mutant.file).read_text("utf-8")))
    except SyntaxError:
        return False
    return True


class Seen:
    """A plugin of pytest: which functions of the package each test calls, and how long it takes."""

    def __init__(self) -> None:
        self.tests: dict[str, tuple[float, list[str]]] = {}

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        here: set[str] = set()
        names: dict[Any, str] = {}

        def called(frame: Any, _event: str, _arg: object) -> None:
            code = frame.f_code
            if code not in names:
                file = code.co_filename.partition("/dqpaint/")
                names[code] = (
                    f"dqpaint/{file[2]}:{code.co_name}:{code.co_firstlineno}" if file[1] else ""
                )
            here.add(names[code])

        begin = time.monotonic()
        sys.settrace(called)
        yield
        sys.settrace(None)
        self.tests[item.nodeid] = (time.monotonic() - begin, sorted(here - {""}))


class Only:
    """A plugin of pytest: some tests in an order of their own."""

    def __init__(self, names: list[str]) -> None:
        self.rank = {name: k for k, name in enumerate(names)}

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        items[:] = sorted(
            (item for item in items if item.nodeid in self.rank),
            key=lambda item: self.rank[item.nodeid],
        )


def in_a_fork(copy_of: Path, words: list[str], plugins: list[Any], told: Path | None = None) -> str:
    """What pytest comes to in a process of its own: `passed`, `no test`, `found` or `time`."""
    child = os.fork()
    if not child:
        os.setsid()
        resource.setrlimit(resource.RLIMIT_AS, (LARGEST, LARGEST))
        quiet = os.open(copy_of / "said", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(quiet, 1)
        os.dup2(quiet, 2)
        os.chdir(copy_of)
        for name in [name for name in sys.modules if name.partition(".")[0] == "tests"]:
            del sys.modules[name]
        sys.path[:] = [
            str(copy_of),
            *(one for one in sys.path if Path(one or ".").resolve() != ROOT),
        ]
        sys.dont_write_bytecode = True
        code = 99
        try:
            options = [
                *(["-x"] if told is None else []),
                "-q",
                "-p",
                "no:cacheprovider",
                "-m",
                "not slow",
                "--tb=line",
            ]
            code = pytest.main([*options, *words], plugins=plugins)
            if told is not None:
                told.write_text(json.dumps(plugins[0].tests))
        except BaseException:
            traceback.print_exc()
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)
    end = time.monotonic() + (LONGEST_LOOK if told else LONGEST)
    while time.monotonic() < end:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return {0: "passed", 5 << 8: "no test"}.get(status, "found")
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return "time"


class Trial:
    """A copy of the repository, with what its tests call."""

    def __init__(self, root: Path) -> None:
        self.copy = root / "copy"
        leave = shutil.ignore_patterns(
            ".git", "__pycache__", ".venv", "*.tiff", ".hypothesis", "out"
        )
        shutil.copytree(ROOT, self.copy, ignore=leave)
        os.environ.update(OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1", PYTHONPATH=str(self.copy))
        for library in LIBRARIES:
            with contextlib.suppress(ImportError):
                importlib.import_module(library)
        assert not any(name.partition(".")[0] == "dqpaint" for name in sys.modules)
        self.calls: dict[str, dict[str, tuple[float, list[str]]]] = {}

    def tests(self, subject: str) -> dict[str, tuple[float, list[str]]]:
        """The tests of a subject: their time, and the functions they call."""
        if subject not in self.calls:
            told = self.copy / "tests-seen.json"
            places = SUBJECTS[subject][1] if subject in SUBJECTS else ["tests"]
            end = in_a_fork(self.copy, places, [Seen()], told)
            assert told.exists(), (self.copy / "said").read_text()[-3000:]
            if end != "passed":  # of all tests some may mind that they are looked at
                print((self.copy / "said").read_text()[-1000:], file=sys.stderr)
                assert subject not in SUBJECTS
            self.calls[subject] = json.loads(told.read_text())
        return self.calls[subject]

    def run(self, mutant: Mutant) -> str:
        """What finds a mutant: `found`, `time`, or `survived`."""
        room = self.near(mutant, mutant.subject)
        place = self.copy / mutant.file
        text, facts = place.read_text("utf-8"), place.stat()
        place.write_text(mutant.planted(text), "utf-8")
        try:
            end = self._only(room)
            if end == "passed" and mutant.function:
                end = in_a_fork(self.copy, SUBJECTS[mutant.subject][1], [])
        finally:
            place.write_text(text, "utf-8")
        if end != "passed":
            return end
        others = [name for name in self.near(mutant, WHOLE) if name not in room]
        place.write_text(mutant.planted(text), "utf-8")
        try:
            return "survived" if self._only(others) == "passed" else "elsewhere"
        finally:
            place.write_text(text, "utf-8")
            os.utime(place, ns=(facts.st_atime_ns, facts.st_mtime_ns))

    def near(self, mutant: Mutant, subject: str) -> list[str]:
        """The tests of a subject that call the function with the fault, the quick ones first."""
        tests = self.tests(subject)
        whole = f"{mutant.file}:{mutant.function}"
        found = [
            name for name, (_, called) in tests.items()
            if whole in called or (not mutant.function and subject != WHOLE)
        ]  # fmt: skip
        return sorted(found, key=lambda name: tests[name][0])

    def _only(self, names: list[str]) -> str:
        if not names:
            return "passed"
        files = sorted({name.partition("::")[0] for name in names})
        return in_a_fork(self.copy, files, [Only(names)])


def table(results: list[dict[str, Any]]) -> None:
    """Print a row a subject."""
    print("| subject | planted | found by the room | by time | by other rooms | survived |\n"
          "|---|---|---|---|---|---|")  # fmt: skip
    for subject in [*SUBJECTS, "all"]:
        told = Counter(r["end"] for r in results if subject in (r["subject"], "all"))
        killed = told["found"] + told["time"]
        print(f"| {subject} | {told.total()} | {killed} | {told['time']} | {told['elsewhere']} | "
              f"{told['survived']} |")  # fmt: skip


def main(file: str, count: str = "500", seed: str = "1") -> int:
    """Plant, and print the table."""
    place = Path(file)
    done = [json.loads(line) for line in place.read_text().splitlines()] if place.exists() else []
    again = count == "again"
    if again:
        todo = [Mutant(**one["mutant"]) for one in done if one["end"] == "survived"]
        todo = [one for one in map(moved, todo) if one is not None]
        done = [one for one in done if one["end"] != "survived"]
        place = place.with_suffix(".again")
        place.unlink(missing_ok=True)
    else:
        known = [one["mutant"] for one in done]
        todo = [one for one in mutants(int(count), int(seed)) if one._asdict() not in known]
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(Path(folder))
        for number, mutant in enumerate(todo):
            end = trial.run(mutant)
            done.append({"end": end, "subject": mutant.subject, "mutant": mutant._asdict()})
            with place.open("a") as out:
                out.write(json.dumps(done[-1]) + "\n")
            if end not in ("found", "elsewhere"):
                old = " ".join(mutant.old.split())[:70]
                print(f"{number + 1}: {end} {mutant.file}:{mutant.line} `{old}` -> "
                      f"`{mutant.new[:70]}`", flush=True)  # fmt: skip
    table(done)
    return 0


def moved(mutant: Mutant) -> Mutant | None:
    """The same fault in the file as it is now; None if it is not there any more."""
    found = [
        one for one in Planter(mutant.subject, mutant.file).found
        if (one.old, one.new, one.function.partition(":")[0])
        == (mutant.old, mutant.new, mutant.function.partition(":")[0])
    ]  # fmt: skip
    return min(found, key=lambda one: abs(one.line - mutant.line), default=None)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
