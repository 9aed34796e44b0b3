"""Every reader of files of others, tried with inputs that were never sound -> what did harm.

    python -m tests.tools.fuzz [all|READER|READER...] [COUNT SEED]
    python -m tests.tools.fuzz guided [all|READER|READER...] [RUNS SEED [FOLDER]]

The first changes sound files and crooked ones at random (COUNT inputs a reader, 100,000 if not
said, a tenth where a try takes above a millisecond). The second has atheris watch which lines an
input reaches, and goes on from those that reach new ones; it keeps them in FOLDER, from which it
goes on another time. Each reader is tried in a process of its own, for some are C++: one that dies
costs one input, and the next goes on. An input that did harm is kept in `fuzz-found/`; what was
mended belongs into `tests/corpus/`, which the tests read.
"""

import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import warnings
from collections import Counter
from pathlib import Path
from random import Random

from tests.support.changed_bytes import changed

FOUND = Path("fuzz-found")
LONGEST = 10  # [s] of the processor for one input
STUCK = 600.0  # [s] after which a process that tells nothing is ended
LARGEST = 6_000_000_000  # bytes of address space
SLOW = 1e-3  # [s] a try; of what takes longer a tenth is tried


class SlowError(BaseException):
    """An input took longer than LONGEST."""


def _late(*_: object) -> None:
    raise SlowError(f"longer than {LONGEST} s")


def prepared() -> None:
    """Limits of this process; warnings are faults."""
    resource.setrlimit(resource.RLIMIT_AS, (LARGEST, LARGEST))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    signal.signal(signal.SIGPROF, _late)
    warnings.simplefilter("error")
    warnings.filterwarnings("ignore", message="builtin type .*", category=DeprecationWarning)


def work(name: str, count: int, seed: int, begin: int, state: Path) -> None:
    """Try inputs `begin` to `count` of a reader; `state` has the one at work, and what was told."""
    from tests.support.readers import READERS, attempt, corpus

    prepared()
    reader, seeds = READERS[name], corpus(name)
    path = state / f"input{reader.ending}"
    told: Counter[str] = Counter()
    for data in seeds if not begin else []:
        told["taken" if attempt(reader, data, path) else "refused"] += 1
    recent = list(seeds)
    number, since = begin, time.process_time()
    while number < count:
        chance = Random(f"{seed} {number}")
        data = reader.mended(changed(chance.choice(recent), seeds, reader.words, chance))
        signal.setitimer(signal.ITIMER_PROF, LONGEST)
        try:
            taken = attempt(reader, data, path)
            told["taken" if taken else "refused"] += 1
            if taken and len(recent) < 200 and chance.random() < 0.05:
                recent.append(data)
        except (Exception, SlowError) as fault:
            signal.setitimer(signal.ITIMER_PROF, 0)
            told[kept(name, data, f"{type(fault).__name__}: {fault}"[:200], fault)] += 1
        number += 1
        if number - begin == 300 and (time.process_time() - since) / 300 > SLOW:
            count = max(count // 10, 1)
        if number % 100 == 0 or number == count:
            signal.setitimer(signal.ITIMER_PROF, 0)
            facts = {"next": number, "count": count, "told": told,
                     "s": time.process_time() - since}  # fmt: skip
            (state / "told.part").write_text(json.dumps(facts))
            os.replace(state / "told.part", state / "told")
    signal.setitimer(signal.ITIMER_PROF, 0)


def kept(name: str, data: bytes, what: str, fault: BaseException | None = None) -> str:
    """Keep an input that did harm, once for each place in the package; returns the complaint."""
    place = ""
    trace = fault.__traceback__ if fault else None
    while trace:
        code = trace.tb_frame.f_code
        if "/dqpaint/" in code.co_filename:
            place = f"{code.co_filename.rpartition('/dqpaint/')[2]}:{trace.tb_lineno}"
        trace = trace.tb_next
    FOUND.mkdir(exist_ok=True)
    stem = re.sub(r"\W+", "-", f"{name} {place or what[:60]}".lower())
    if not (FOUND / stem).exists():
        (FOUND / stem).write_bytes(data)
    return f"FAULT {re.sub('[0-9]+', 'N', what)} at {place}"


def tried(name: str, count: int, seed: int) -> dict[str, object]:
    """Try a reader in processes of its own; what was told of all inputs."""
    total: Counter[str] = Counter()
    begin, seconds = 0, 0.0
    with tempfile.TemporaryDirectory(
        dir="/dev/shm" if Path("/dev/shm").is_dir() else None
    ) as folder:
        state = Path(folder)
        while begin < count:
            words = [sys.executable, "-m", "tests.tools.fuzz", "--work", name, str(count),
                     str(seed), str(begin), folder]  # fmt: skip
            with (state / "said").open("wb") as said:
                process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=said)
                ended, stuck = watched(process, state / "told")
            facts = {"next": begin, "count": count, "told": {}, "s": 0.0}
            if (state / "told").exists():
                facts = json.loads((state / "told").read_text())
                (state / "told").unlink()
            total.update(facts["told"])  # type: ignore[arg-type]
            seconds += float(facts["s"])  # type: ignore[arg-type]
            begin, count = int(facts["next"]), int(facts["count"])  # type: ignore[call-overload]
            if ended == 0:
                break
            last = (state / "said").read_text(errors="replace").strip().splitlines()[-1:]
            what = "STUCK" if stuck else f"DIED {ended} {last}"
            data = next(state.glob("input*"), Path("/dev/null")).read_bytes()
            total[kept(name, data, what)] += 1
            begin += 100  # those that were told, and the batch in which it died
    return {"reader": name, "inputs": sum(total.values()), "s": seconds, **total}


def watched(process: "subprocess.Popen[bytes]", told: Path) -> tuple[int, bool]:
    """Wait for a process; end it if it tells nothing for long."""
    last, changed_at = 0, time.monotonic()
    while process.poll() is None:
        time.sleep(0.2)
        now = told.stat().st_mtime_ns if told.exists() else 0
        if now != last:
            last, changed_at = now, time.monotonic()
        elif time.monotonic() - changed_at > STUCK:
            process.kill()
            return process.wait(), True
    return process.returncode, False


def guided(name: str, runs: int, seed: int, folder: str) -> None:
    """Coverage-guided, in this process, which it ends."""
    import atheris

    with atheris.instrument_imports(include=["dqpaint"]):
        from tests.support.readers import READERS, attempt, corpus
    prepared()
    reader = READERS[name]
    place = Path(folder) / re.sub(r"\W+", "-", name.lower())
    place.mkdir(parents=True, exist_ok=True)
    for k, data in enumerate(corpus(name)):
        (place / f"seed{k}").write_bytes(data[:4096] if name != "film" else data)
    path = Path(tempfile.mkdtemp(dir="/dev/shm")) / f"input{reader.ending}"
    faults: Counter[str] = Counter()

    def one(data: bytes) -> None:
        try:
            attempt(reader, reader.mended(data), path)
        except Exception as fault:
            what = kept(name, data, f"{type(fault).__name__}: {fault}"[:200], fault)
            faults[what] += 1
            if faults[what] == 1:
                print(what, flush=True)

    words = ["fuzz", f"-runs={runs}", f"-seed={seed}", "-max_len=8192", "-timeout=20",
             "-rss_limit_mb=3000", f"-artifact_prefix={place}/harm-", "-print_final_stats=1",
             "-verbosity=0", str(place)]  # fmt: skip
    atheris.Setup(words, one)
    atheris.Fuzz()


def by_coverage(name: str, runs: int, seed: int, folder: str) -> str:
    """A row of the table for a reader that was fuzzed under a watch."""
    words = [
        sys.executable,
        "-m",
        "tests.tools.fuzz",
        "--guided",
        name,
        str(runs),
        str(seed),
        folder,
    ]
    begin = time.monotonic()
    done = subprocess.run(words, capture_output=True, text=True, check=False, errors="replace")
    said = done.stdout + done.stderr
    inputs = re.search(r"number_of_executed_units:\s*(\d+)", said)
    faults = sorted(set(re.findall(r"FAULT .*", said)))
    harm = faults if done.returncode == 0 else [*faults, f"DIED {done.returncode}: {said[-300:]}"]
    place = Path(folder) / re.sub(r"\W+", "-", name.lower())
    for line in harm:
        print(f"  {name}: {line}", file=sys.stderr)
    return (f"| {name} | {int(inputs[1]) if inputs else 0:,} | {len(list(place.iterdir()))} | "
            f"{len(harm)} | {time.monotonic() - begin:.0f} |")  # fmt: skip


def main(words: list[str]) -> int:
    """Try what is asked for, and print a row a reader."""
    if words[:1] == ["--work"]:
        work(words[1], int(words[2]), int(words[3]), int(words[4]), Path(words[5]))
        return 0
    if words[:1] == ["--guided"]:
        guided(words[1], int(words[2]), int(words[3]), words[4])
    from tests.support.readers import READERS

    watching = words[:1] == ["guided"]
    name, count, seed, folder = [*words[watching:], *("all", "", "1", "")[len(words) - watching :]]
    names = list(READERS) if name == "all" else name.split("|")
    wrong = 0
    if watching:
        print("| reader | inputs | kept for new lines | faults | s |\n|---|---|---|---|---|")
        with tempfile.TemporaryDirectory() as own:
            for one in names:
                print(by_coverage(one, int(count or 20_000), int(seed), folder or own), flush=True)
        return 0
    print("| reader | inputs | taken | faults | us each |\n|---|---|---|---|---|")
    for one in names:
        told = tried(one, int(count or 100_000), int(seed))
        inputs, faults = int(str(told["inputs"])), {k: v for k, v in told.items() if "FAULT" in k}
        each = 1e6 * float(str(told["s"])) / max(inputs, 1)
        harm = sum(int(str(v)) for v in faults.values())
        print(
            f"| {one} | {inputs:,} | {told.get('taken', 0):,} | {harm} | {each:.0f} |", flush=True
        )
        for what, times in faults.items():
            print(f"  {one}: {times} times {what}", file=sys.stderr)
        wrong += harm
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
