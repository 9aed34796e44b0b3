"""The summary of a run, or a law -> BibTeX of dqpaint and of what the run used.

An entry has what the sources of dqpaint print and no more: where they name authors and year alone,
it says that the title is to be looked up.
"""

import json
import re
from pathlib import Path
from typing import Any

from dqpaint import __version__
from dqpaint.core import read_regular
from dqpaint.errors import DqpaintError
from dqpaint.settings import READABLE

LARGEST = 10_000_000  # bytes of a summary
PEREIRA = "Trajectory Control of Anthropomorphic Compliant Manipulator with Dual Quaternion Based "
NO_TITLE = "dqpaint has no title of it: to be looked up"
ENGINES = {"pybullet": "PyBullet", "mujoco": "MuJoCo"}
SPECIAL = str.maketrans({
    **{sign: f"\\{sign}" for sign in "&%$#_"},
    "{": "(", "}": ")",  # BibTeX counts braces, also escaped ones
    "\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
})  # fmt: skip

PAPERS: dict[str, tuple[str, dict[str, str]]] = {
    "Pereira 2016": ("misc", {
        "author": "Pereira, Marcos da Silva", "title": PEREIRA + "Kinematic Controllers",
        "howpublished": "Trabalho de Graduação, Universidade de Brasília", "year": "2016",
    }),
    "Pham 2010": ("inproceedings", {
        "author": "Pham, H.-L. and Perdereau, V. and Adorno, B. V. and Fraisse, P.",
        "title": "Position and orientation control of robot manipulators using dual quaternion "
        "feedback",
        "booktitle": "IEEE/RSJ International Conference on Intelligent Robots and Systems",
        "year": "2010",
    }),
    "Ozgur & Mezouar 2016": ("article", {
        "author": "Özgür, E. and Mezouar, Y.",
        "title": "Kinematic modeling and control of a robot arm using unit dual quaternions",
        "journal": "Robotics and Autonomous Systems", "year": "2016",
    }),
    "Chandra 2020": ("inproceedings", {
        "author": "Chandra, R. and others",
        "title": "Resolved-acceleration control of serial robotic manipulators using unit dual "
        "quaternions",
        "booktitle": "IFAC World Congress", "year": "2020",
    }),
    "Kussaba 2017": ("misc", {
        "author": "Kussaba and others",
        "title": "Hybrid kinematic control for rigid body pose stabilization using dual "
        "quaternions",
        "year": "2017",
    }),
    "Mayhew 2011": ("misc", {
        "author": "Mayhew and Sanfelice and Teel",
        "title": "Quaternion-based hybrid control for robust global attitude tracking",
        "year": "2011",
    }),
    "Caccavale 1998": ("misc", {"author": "Caccavale and others", "year": "1998"}),
    "Bullo & Murray 1995": ("misc", {"author": "Bullo and Murray", "year": "1995"}),
    "Lee, Leok & McClamroch 2010": ("misc", {
        "author": "Lee and Leok and McClamroch", "year": "2010",
    }),
    "Sjoberg & Egeland": ("misc", {"author": "Sjoberg and Egeland"}),
    "Marinho & Adorno 2022": ("misc", {"author": "Marinho and Adorno", "year": "2022"}),
    "Fonseca, Adorno & Fraisse 2021": ("misc", {
        "author": "Fonseca and Adorno and Fraisse", "year": "2021",
    }),
    "Levant 1993": ("misc", {"author": "Levant", "year": "1993"}),
}  # fmt: skip
"""Kinds and fields of entries by what the source of a law calls them."""


def of_law(name: str) -> str:
    """BibTeX of dqpaint and of a law's papers.

    Args:
        name: of a law, or `FILE.py[:NAME]`.

    Raises:
        DqpaintError: there is no such law.
    """
    from dqpaint.controllers import find_controller

    law = find_controller(name)
    source = law.source if law.sha256 is None else Path(law.source).name
    return "\n\n".join([_dqpaint(__version__), *_law(law.name, source, law.sha256)])


def of_run(path: str) -> str:
    """BibTeX of dqpaint, the law, the arm and the libraries that a run used, as its summary says.

    Args:
        path: of the summary that `draw` writes.

    Raises:
        DqpaintError: it cannot be read, or is no summary of a run.
    """
    found = _read(path)
    law = found["law"]
    version = found["versions"]["dqpaint"]
    arm = {
        "title": found["robot"],
        "note": f"the simulated arm, as dqpaint {version} describes it; plant: {found['plant']}",
    }
    return "\n\n".join([
        _dqpaint(version), *_law(found["controller"], law["source"], law.get("sha256")),
        _entry("misc", f"arm-{found['robot']}", arm), *_libraries(found),
    ])  # fmt: skip


def _read(path: str) -> dict[str, Any]:
    """The summary of a run, with the parts that are cited."""
    name = Path(path).name
    try:
        found = json.loads(read_regular(path, LARGEST))
    except (OSError, ValueError, RecursionError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else str(problem)
        if isinstance(problem, RecursionError):
            reason = "it is nested too deep"
        what = "cannot be read" if isinstance(problem, OSError) else "is no JSON"
        raise DqpaintError(f"'{name[:60]}' {what}: {reason}") from None
    if not (isinstance(found, dict) and found.get("schema") in READABLE):
        raise DqpaintError(f"{name} is not the summary of a run: draw --save json makes one")
    law, versions = found.get("law"), found.get("versions")
    if not isinstance(law, dict) or not isinstance(versions, dict):
        raise DqpaintError(f"{name} is damaged: a summary has law and versions")
    texts = {
        "robot": found.get("robot"), "plant": found.get("plant"),
        "controller": found.get("controller"), "law.source": law.get("source"),
        "versions.dqpaint": versions.get("dqpaint"),
    }  # fmt: skip
    for key, value in texts.items():
        if not isinstance(value, str):
            raise DqpaintError(f"{name} is damaged: {key} should be a text")
    return found


def _dqpaint(version: str) -> str:
    """The entry of dqpaint itself, as CITATION.cff has it."""
    about = {
        "author": "{The dqpaint developers}", "title": "dqpaint", "version": version,
        "note": "Apache-2.0",
    }  # fmt: skip
    return _entry("software", "dqpaint", about)


def _law(name: str, source: str, sha256: object) -> list[str]:
    """The papers that a law's source names; of a law without any, a comment with the source."""
    if sha256 is not None:
        note = f"a control law of one's own, SHA-256 {sha256}"
        return [_entry("misc", f"law-{name}", {"title": source, "note": note})]
    said = f"{_line(name)}: {_line(source)}".replace("@", "(at)")  # BibTeX reads on at an @
    head = f"% the law {said}"
    papers = [key for key in PAPERS if key in source]
    if not papers:
        return [f"{head}; it has no paper here"]
    return [head, *(_entry(PAPERS[key][0], key, _completed(PAPERS[key][1])) for key in papers)]


def _completed(about: dict[str, str]) -> dict[str, str]:
    return about if "title" in about else {**about, "note": NO_TITLE}


def _libraries(found: dict[str, Any]) -> list[str]:
    """The physics engine and the kinematics of a run, with their versions."""
    used = []
    engine, settings = found.get("engine"), found.get("settings")
    if isinstance(engine, str):
        used.append((engine, ENGINES.get(engine, engine), "the physics engine of the run"))
    if isinstance(settings, dict) and settings.get("kinematics") == "pinocchio":
        used.append(("pin", "Pinocchio", "the kinematics of the run; the package pin"))
    versions = found["versions"]
    return [
        _entry("software", key, {
            "title": title, "version": str(versions.get(key, "not recorded")), "note": note,
        })
        for key, title, note in used
    ]  # fmt: skip


def _entry(kind: str, name: str, about: dict[str, str]) -> str:
    """An entry; one without an author is sorted by its key."""
    key = re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
    fields = about if "author" in about else {"key": key, **about}
    lines = [f"  {field} = {{{_value(field, text)}}}," for field, text in fields.items()]
    return "\n".join([f"@{kind}{{{key},", *lines, "}"])


def _value(field: str, text: str) -> str:
    """A value with LaTeX's signs escaped; authors are ours, and their braces are meant."""
    return text if field == "author" else _line(text).translate(SPECIAL)


def _line(text: str) -> str:
    return " ".join(text.split())
