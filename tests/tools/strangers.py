"""Drawings and arms that others made -> each is read, or refused with a reason; all in a table.

    npm pack @twemoji/svg simple-icons @fortawesome/fontawesome-free bootstrap-icons
    python -m tests.tools.strangers svg TOLD FILE.tgz|FOLDER ...   # a row of JSON a drawing to TOLD
    python -m tests.tools.strangers urdf TOLD FOLDER ...           # the same of arms
    python -m tests.tools.strangers table TOLD                     # times, memory, reasons
    python -m tests.tools.strangers compare OLD NEW                # what changed between commits
    python -m tests.tools.strangers chromium COUNT FILE.tgz|FOLDER ...

TOLD is added to: what stands in it is not read again. The last compares the strokes of COUNT
drawings with those of a browser (`getPointAtLength`, `getScreenCTM`) and, closer, of svgelements.
"""

import json
import os
import random
import re
import resource
import statistics
import sys
import tarfile
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

LONGEST = 60  # [s] of the processor for one file
LARGEST = 6_000_000_000  # bytes of address space
TRIED = 8  # places along a shape
AGREES, PLACED, CLOSED = 5e-4, 1e-5, 1e-6  # of the size: along a shape; its transform; svgelements
DRAWING = 'period 20 ms\nprofile constant\nsvg "f.svg" height 100 mm\n'


def drawings(places: list[str]) -> Iterator[tuple[str, bytes]]:
    """Names and bytes of the SVG files of packed sets and folders."""
    for place in places:
        if place.endswith((".tgz", ".tar.gz")):
            with tarfile.open(place) as packed:
                for member in packed:
                    if member.isfile() and member.name.endswith(".svg"):
                        file = packed.extractfile(member)
                        assert file is not None
                        yield f"{Path(place).name}/{member.name}", file.read()
        else:
            for path in sorted(Path(place).rglob("*.svg")):
                yield str(path), path.read_bytes()


def svg_outcome(data: bytes, folder: Path) -> dict[str, Any]:
    """What comes of a drawing: its strokes and their length, or why not."""
    from dqpaint.language import ScriptError, parse
    from dqpaint.language.imports.svg import reader
    from dqpaint.motion import survey

    (folder / "f.svg").write_bytes(data)
    reader._read.cache_clear()
    begin = time.process_time()
    try:
        program = parse(DRAWING, "a.traj", folder / "a.traj")
    except ScriptError as refusal:
        one = refusal.diagnostics[0]
        return {"end": one.code, "why": re.sub(r"\d+", "N", one.message)[:160],
                "ms": 1e3 * (time.process_time() - begin)}  # fmt: skip
    read = time.process_time() - begin
    found = survey(program)
    return {
        "end": "read", "segments": len(program.segments), "ms": 1e3 * read,
        "warnings": sorted({one.code for one in (*program.notes, *found.notes)}),
        "seconds": found.seconds, "samples": found.samples, "length_m": found.length,
        "all_ms": 1e3 * (time.process_time() - begin),
    }  # fmt: skip


def urdf_outcome(path: Path) -> dict[str, Any]:
    """What comes of an arm: its card, its kinematics and its shapes, or why not."""
    from dqpaint.errors import DqpaintError
    from dqpaint.robots.kinematics.collisions import CollisionShapes
    from dqpaint.robots.kinematics.kinematics import Kinematics
    from dqpaint.robots.loading.lookup import find_card

    begin = time.process_time()
    try:
        name = str(path)
        try:
            card = find_card(name)
        except DqpaintError as refusal:  # of several arms the first one it tells of
            several = re.search(r"for example [^:]+\.urdf:(\S+)$", str(refusal))
            if several is None:
                raise
            card = find_card(f"{name}:{several[1]}")
        shapes = CollisionShapes(Kinematics(card))
        assert not np.isnan(shapes.nearest(card.home[None]).distance[0])
    except DqpaintError as refusal:
        why = str(refusal).replace(path.name, "FILE")
        return {"end": "refused", "why": re.sub(r"'[^']*'|\d+", "N", why)[:160],
                "ms": 1e3 * (time.process_time() - begin)}  # fmt: skip
    return {"end": "read", "joints": card.joints, "left_out": len(shapes.notes),
            "home": [round(x, 6) for x in card.home.tolist()],
            "ms": 1e3 * (time.process_time() - begin)}  # fmt: skip


def in_a_fork(call: Any, *values: Any) -> dict[str, Any]:
    """The outcome in a process of its own, which may die of it, with its memory."""
    reader, writer = os.pipe()
    child = os.fork()
    if not child:
        resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST))
        resource.setrlimit(resource.RLIMIT_AS, (LARGEST, LARGEST))
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, 1)
        os.dup2(nothing, 2)
        try:
            told = call(*values)
        except BaseException as fault:
            told = {"end": "FAULT", "why": f"{type(fault).__name__}: {fault}"[:200]}
        told["mb"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
        os.write(writer, json.dumps(told).encode())
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as pipe:
        said = pipe.read()
    _, status = os.waitpid(child, 0)
    return json.loads(said) if said else {"end": "DIED", "why": f"status {status}"}


def gone_through(told: Path, files: Iterator[tuple[str, Any]], kind: str) -> None:
    """Read what has not been read, a line each."""
    known = {one["file"] for one in lines(told)} if told.exists() else set()
    import dqpaint.robots.kinematics.collisions
    import dqpaint.robots.loading.lookup  # noqa: F401  each child has them from here

    with tempfile.TemporaryDirectory() as folder, told.open("a") as out:
        svg_outcome(
            b"<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0H9' stroke='red'/></svg>",
            Path(folder),
        )  # what is loaded at the first time
        for name, data in files:
            if name not in known:
                what = in_a_fork(svg_outcome, data, Path(folder)) if kind == "svg" else in_a_fork(
                    urdf_outcome, data)  # fmt: skip
                out.write(json.dumps({"file": name, **what}) + "\n")
                out.flush()


def lines(told: Path) -> list[dict[str, Any]]:
    """The rows of a file."""
    return [json.loads(line) for line in told.read_text().splitlines()]


def table(told: Path) -> int:
    """Print times, memory and reasons, a row a set; how many died or did harm."""
    rows = lines(told)
    sets: dict[str, list[dict[str, Any]]] = {}
    for row in rows:
        sets.setdefault(row["file"].split("/")[0] or row["file"].split("/")[2], []).append(row)
    print("| set | files | read | refused | faults | ms each, median and most | MB at most |")
    print("|---|---|---|---|---|---|---|")
    harm = 0
    for name, found in sets.items():
        ends = Counter(row["end"] for row in found)
        bad = ends["FAULT"] + ends["DIED"]
        harm += bad
        ms = [row.get("ms", 0.0) for row in found]
        print(f"| {name} | {len(found):,} | {ends['read']:,} | {len(found) - ends['read'] - bad:,} "
              f"| {bad} | {statistics.median(ms):.1f}, {max(ms):.0f} | "
              f"{max(row.get('mb', 0.0) for row in found):.0f} |")  # fmt: skip
    print("\n| reason | files |\n|---|---|")
    for why, count in Counter(row["why"] for row in rows if "why" in row).most_common(30):
        print(f"| {why} | {count} |")
    warned = Counter(code for row in rows for code in row.get("warnings", ()))
    print("\nwarnings: " + ", ".join(f"{code} {count}" for code, count in sorted(warned.items())))
    return harm


def compare(old: Path, new: Path) -> int:
    """Print each file of which something else came, times and memory apart."""
    before = {row["file"]: row for row in lines(old)}
    differences = 0
    for row in lines(new):
        other = before.get(row["file"])
        if other is None:
            continue
        for key in sorted({*row, *other} - {"ms", "all_ms", "mb", "file"}):
            a, b = other.get(key), row.get(key)
            near = isinstance(a, float) and isinstance(b, float) and abs(a - b) <= 1e-9 * abs(a)
            if a != b and not near:
                differences += 1
                print(f"{row['file']}: {key} was {a}, is {b}")
    print(f"{differences} differences in {len(before)} files")
    return differences


# Against a browser.

SKIPPED = re.compile(rb"<(use|defs|clipPath|mask|symbol|style|pattern|linearGradient|radialGradient"
                     rb"|text|image|filter|marker|switch|foreignObject|\w+:)|display|visibility|"
                     rb"transform-origin|<svg[^>]*<svg", re.IGNORECASE)  # fmt: skip
SCRIPT = """[...document.querySelectorAll('.one > svg')].map(svg =>
  [...svg.querySelectorAll('path,line,polyline,polygon,rect,circle,ellipse')].map(shape => {
    const m = shape.getScreenCTM(), whole = shape.getTotalLength(), places = [];
    for (let k = 0; k < TRIED; k++) {
      const p = shape.getPointAtLength(whole * (k + 0.37) / TRIED); places.push([p.x, p.y]); }
    return [whole, [m.a, m.b, m.c, m.d, m.e, m.f], places]; }))"""


def with_size(data: bytes) -> bytes | None:
    """A drawing whose root says its size in pixels, as a page needs; None without a view box."""
    head = re.search(rb"<svg\b[^>]*>", data)
    box = re.search(rb"viewBox=[\"']\s*([-\d.]+)[\s,]+([-\d.]+)[\s,]+([\d.]+)[\s,]+([\d.]+)",
                    head[0] if head else b"")  # fmt: skip
    if head is None or box is None:
        return None
    bare = re.sub(rb"\s(width|height)=(\"[^\"]*\"|'[^']*')", b"", head[0])
    sized = bare.replace(b"<svg", b'<svg width="%s" height="%s"' % (box[3], box[4]), 1)
    return data[head.start() : head.start()] + sized + data[head.end() :]


def own_shapes(data: bytes) -> list[tuple[list[float], list[Any]]]:
    """Of each shape: its transform, and its lines in its own units."""
    from dqpaint.language.imports.svg import nested_svg, reader
    from dqpaint.language.imports.svg.paths import Pieces
    from tests.support.svg import tree

    root = tree(data.decode())
    found = []
    for node, state in reader._shapes(root, nested_svg.paper(root)):
        pieces = Pieces()
        pieces.begin()
        reader._draw(pieces, node, reader._measured(node, state.view))
        drawn = [curve for _, curve in pieces.lines(np.eye(3)[None], np.zeros((1, 3)))]
        found.append((list(state.matrix), drawn))
    return found


def along(drawn: list[Any], shares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places along some lines one after the other (N, 2), and those at shares of their length."""
    from dqpaint.program import piecewise

    g = np.linspace(0.0, 1.0, 400)
    places, lengths, whole = [], [], 0.0
    for curve in drawn:
        n = len(curve.cubic)
        at = piecewise.derivatives(curve, np.repeat(np.arange(n), len(g)), np.tile(g, n))[0][:, :2]
        steps = np.linalg.norm(np.diff(at, axis=0), axis=1)
        places.append(at)
        lengths.append(whole + np.concatenate([[0.0], np.cumsum(steps)]))
        whole = lengths[-1][-1]
    at, length = np.concatenate(places), np.concatenate(lengths)
    wanted = np.interp(shares * whole, length, np.arange(len(length)))
    return at, np.stack([np.interp(wanted, np.arange(len(at)), at[:, k]) for k in (0, 1)], axis=1)


def nearest(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """How far points (N, 2) are from a line through places (M, 2)."""
    begin, way = line[:-1], np.diff(line, axis=0)
    square = np.maximum((way * way).sum(axis=1), 1e-300)
    out = []
    for point in points:
        share = np.clip(((point - begin) * way).sum(axis=1) / square, 0.0, 1.0)
        out.append(np.linalg.norm(begin + share[:, None] * way - point, axis=1).min())
    return np.array(out)


def chromium(count: int, places: list[str]) -> int:
    """Compare, and print how far apart the worst are."""
    from tests.support.browser import opened

    plain = [
        (name, sized) for name, data in drawings(places)
        if not SKIPPED.search(data) and len(data) < 50_000 and (sized := with_size(data))
    ]  # fmt: skip
    chance = random.Random(1)
    sample = chance.sample(plain, min(count, len(plain)))
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "page.html"
        bodies = "".join(
            f'<div class="one" style="position:absolute;left:0;top:0">'
            f'{re.sub(r"<[?!][^>]*>", "", data.decode())}</div>' for _, data in sample
        )  # fmt: skip
        script = SCRIPT.replace("TRIED", str(TRIED))
        page.write_text(
            f'<!doctype html>{bodies}<pre id="said"></pre><script>document.getElementById("said")'
            f".textContent = JSON.stringify({script})</script>", "utf-8",
        )  # fmt: skip
        said = re.search(r'<pre id="said">(.*?)</pre>', opened(page)[0], re.DOTALL)
    assert said, "the browser says nothing"
    shares = (np.arange(TRIED) + 0.37) / TRIED
    worst = {"beside a stroke": (0.0, ""), "transform": (0.0, "")}
    shapes = different = further = 0
    for (name, data), theirs in zip(sample, json.loads(said[1]), strict=True):
        ours = own_shapes(data)
        if len(ours) != len(theirs):
            print(f"{name}: {len(ours)} shapes, the browser has {len(theirs)}")
            different += 1
            continue
        for (matrix, drawn), (length, other, points) in zip(ours, theirs, strict=True):
            if not drawn:
                different += length > 0
                continue
            shapes += 1
            line, own = along(drawn, shares)
            size = max(np.ptp(line, axis=0).max(), 1e-9)
            found = {
                "beside a stroke": float(nearest(np.array(points), line).max() / size),
                "transform": float(np.abs(np.subtract(matrix, other)).max()
                                   / max(1.0, np.abs(other).max())),
            }  # fmt: skip
            further += np.linalg.norm(own - np.array(points), axis=1).max() > AGREES * size
            for what, value in found.items():
                worst[what] = max(worst[what], (value, name))
            if found["beside a stroke"] > AGREES or found["transform"] > PLACED:
                different += 1
                print(f"{name}: {found}")
    print(
        f"{len(sample)} drawings, {shapes} shapes, {different} differ; of {further} the browser "
        f"has places on the stroke, but above {AGREES:g} further along: it measures by chords"
    )
    for what, (value, name) in worst.items():
        print(f"  {what}: at most {value:.2g} ({name})")
    return different + closed_forms(sample)


def closed_forms(sample: list[tuple[str, bytes]]) -> int:
    """Compare with the segments of svgelements, at the same parameters."""
    import io

    import svgelements

    from tests.support.svg import by_library, outline

    worst, named, shapes, different = 0.0, "", 0, 0
    for name, data in sample:
        root = svgelements.SVG.parse(io.BytesIO(data), reify=False, ppi=96.0)
        theirs = [one for one in root.select(lambda one: isinstance(one, svgelements.Shape))]
        ours = own_shapes(data)
        if len(theirs) != len(ours):
            different += 1
            print(f"{name}: {len(ours)} shapes, svgelements has {len(theirs)}")
            continue
        for shape, (_, drawn) in zip(theirs, ours, strict=True):
            wanted = pieces_of(by_library(shape))
            own = pieces_of([outline(line) for line in drawn])
            shapes += 1
            if len(wanted) != len(own):
                different += 1
                print(f"{name}: {len(own)} pieces, svgelements has {len(wanted)}")
            elif len(own):
                size = np.ptp(wanted.reshape(-1, 2), axis=0).max()
                worst, named = max((worst, named), (float(np.abs(own - wanted).max() / size), name))
    print(f"{shapes} shapes against svgelements: at most {worst:.2g} ({named}), {different} differ")
    return different + (worst > CLOSED)


def pieces_of(lines_of: list[Any]) -> np.ndarray:
    """The places (N, 9, 2) on all pieces of some lines that are longer than rounding makes one."""
    pieces = np.concatenate(lines_of).reshape(-1, 9, 2) if lines_of else np.zeros((0, 9, 2))
    size = np.ptp(pieces.reshape(-1, 2), axis=0).max(initial=0.0) if len(pieces) else 0.0
    return pieces[np.ptp(pieces, axis=1).max(axis=1) > 1e-9 * size]


def main(words: list[str]) -> int:
    """Do what is asked for."""
    what, *rest = words
    if what == "svg":
        every = list(drawings(rest[1:]))
        random.Random(1).shuffle(every)  # so that a run that is ended early has seen some of each
        gone_through(Path(rest[0]), iter(every), "svg")
        return table(Path(rest[0])) > 0
    if what == "urdf":
        files = [
            (str(path), path) for place in rest[1:] for path in sorted(Path(place).rglob("*.urdf"))
        ]
        random.Random(1).shuffle(files)
        gone_through(Path(rest[0]), iter(files), "urdf")
        return table(Path(rest[0])) > 0
    if what == "table":
        return table(Path(rest[0])) > 0
    if what == "compare":
        return compare(Path(rest[0]), Path(rest[1])) > 0
    return chromium(int(rest[0]), rest[1:]) > 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
